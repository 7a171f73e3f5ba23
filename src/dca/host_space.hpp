// A Space: where arrays live and loops over them run. Solvers and integrators are written once for
// any Space; this one is the host, cuda::DeviceSpace a GPU. Both have the same members; what they
// promise is said here.
#pragma once

#include <algorithm>
#include <chrono>
#include <span>
#include <utility>
#include <vector>

#include "dca/host_blocks.hpp"
#include "dca/solver.hpp"
#include "math/records.hpp"

/// Of what a loop does with one item: all that it calls is inlined, small vectors and matrices then
/// stay in registers. By itself gcc stops at a size that these functions are beyond, and they take
/// two to three times as long.
#if !defined(CATENA_WHOLE)  // a build with sanitizers leaves it out
#define CATENA_WHOLE __attribute__((flatten))
#endif

namespace catena {

class HostSpace : public HostAccess {
  public:
    /// Whether what is asked for is done when the call returns.
    static constexpr bool answers_at_once = true;
    /// The executor must outlive the space.
    explicit HostSpace(Executor const& executor) : executor_(&executor) {}

    /// Memory of the space, zero at first.
    template <class T>
    using Array = std::vector<T>;
    /// A way from this rank's memory to others' that leaves out the host, where there is one:
    /// exchange() brings numbers as FrontierExchange::bring() says. The same on all ranks.
    struct Direct {
        explicit operator bool() const { return false; }
    };
    Direct connect(dca::Schedule const&, int /*width*/, int /*beside*/) const { return {}; }
    template <class Numbers, class... Beside>
    void exchange(Direct const&, Numbers const&, Beside const&...) const {}
    /// As FrontierExchange::turn() says.
    template <class Numbers, class AnyTree, class Sweep, class... Beside>
    bool turn_shared(Direct const&, Numbers const&, AnyTree const&, AnyTree const& /*top*/,
                     Sweep const&, Beside const&...) const {
        return false;
    }
    using HostAccess::exchange;
    /// Memory that loops and the host share: what one wrote the other finds after wait().
    template <class T>
    using HostArray = std::vector<T>;
    template <int D>
    using FieldOf = Field<D>;
    /// `size` bodies of K numbers, K known at run time.
    using Directions = DirectionsField;
    /// What does not change, from the host's own array, which must outlive it.
    template <class T>
    using List = std::span<T const>;
    template <int D>
    class Fixed {
      public:
        explicit Fixed(Field<D> const& host) : view_(host.view()) {}
        ConstView<D> view() const { return view_; }

      private:
        ConstView<D> view_;
    };
    /// The model that the sweeps read.
    class Model {
      public:
        explicit Model(ChainGroup const& group) : group_(group) {}
        GroupView view() const { return group_.view(); }
        std::uint8_t const* restricted() const { return group_.restricted_of_joint.data(); }

      private:
        ChainGroup const& group_;
    };
    /// `count` records, zero at first.
    template <class T, dca::Order order>
    class Records {
      public:
        explicit Records(std::int64_t count) : records_(static_cast<std::size_t>(count)) {}
        dca::RecordsView<T, order> view() { return {reinterpret_cast<double*>(records_.data())}; }

      private:
        LongArray<T> records_;
    };
    /// Runs, merges level by level and roots: those of a level are independent, the next level's
    /// need them.
    class Tree {
      public:
        Tree(std::vector<dca::Run> const& runs, std::vector<std::vector<dca::Merge>> const& levels,
             std::vector<dca::Root> const& roots, std::int64_t /*slots*/,
             std::span<std::uint8_t const> /*restricted*/, dca::StageRecords const& /*records*/)
            : runs_(runs), levels_(levels), roots_(roots) {}

      private:
        friend class HostSpace;
        std::span<dca::Run const> runs_;
        std::span<std::vector<dca::Merge> const> levels_;
        std::span<dca::Root const> roots_;
    };

    /// Of scans along the chains: of_run(run) is a run's value, joined(inboard, outboard) what two
    /// neighbours make. whole(), set_whole(), before(), set_before() are by slot. After climb()
    /// whole() is known of what is complete (roots, and what other ranks need) and stays as it is
    /// until descend(), which finds before() in these slots and leaves it in those of the runs, or
    /// of what the lowest level joins. Nothing else is promised of them.
    class ScanTree {
      public:
        ScanTree(std::vector<dca::Run> const& runs,
                 std::vector<std::vector<dca::Merge>> const& levels,
                 std::vector<dca::Root> const& /*roots*/, std::int64_t /*slots*/)
            : runs_(runs), levels_(levels) {}

      private:
        friend class HostSpace;
        std::span<dca::Run const> runs_;
        std::span<std::vector<dca::Merge> const> levels_;
    };

    /// Blocks of whole chains that the group has on this rank. A block has loops over its own
    /// bodies and tips, and sweeps over its own chains (host_blocks.hpp).
    using Blocks = HostBlocks;
    /// Whether there are any for a group whose handles carry K directions.
    template <int K>
    static constexpr bool has_blocks = true;
    /// Whether blocks are teams of threads (team_tree.hpp).
    template <int K>
    static constexpr bool has_teams = false;
    /// Whether it pays to let each block do its whole work alone.
    bool pays_by_blocks(ChainGroup const& group) const {
        return std::ssize(group.pieces) >= std::max(2, threads());
    }
    /// action(block) for every block; they may run side by side.
    template <class Action>
    void each_block(Blocks const& blocks, Action const& action) const {
        executor_->for_each(blocks.count(), [&](std::int64_t b) { action(HostBlock(blocks, b)); });
    }

    template <class Action>
    void for_each(std::int64_t count, Action const& action) const {
        executor_->for_each(count, [&](std::int64_t i) CATENA_WHOLE { action(i); });
    }
    template <class T, class Action>
    void over(List<T> const& items, Action const& action) const {
        executor_->for_each(std::ssize(items),
                            [&](std::int64_t i) { action(items[static_cast<std::size_t>(i)]); });
    }
    /// A scan from the runs to the roots, and from the roots to the runs.
    template <class Scan>
    void climb(ScanTree const& tree, Scan const& scan) const {
        over(tree.runs_, [&](dca::Run const& run) { scan.set_whole(run.slot, scan.of_run(run)); });
        for (std::vector<dca::Merge> const& level : tree.levels_)
            over(std::span(level), [&](dca::Merge const& m) {
                scan.set_whole(m.slot, scan.joined(scan.whole(m.inboard), scan.whole(m.outboard)));
            });
    }
    template <class Scan>
    void descend(ScanTree const& tree, Scan const& scan) const {
        for (std::size_t l = tree.levels_.size(); l-- > 0;)
            over(std::span(tree.levels_[l]), [&](dca::Merge const& m) {
                auto const before = scan.before(m.slot);
                scan.set_before(m.inboard, before);
                scan.set_before(m.outboard, scan.joined(before, scan.whole(m.inboard)));
            });
    }
    /// A sweep (tree_sweeps.hpp) from the leaves to the roots, and from the roots to the leaves.
    template <class Sweep>
    void climb(Tree const& tree, Sweep const& sweep) const {
        over(tree.runs_, [&](dca::Run const& run) CATENA_WHOLE { climb_run(sweep, run); });
        for (std::vector<dca::Merge> const& level : tree.levels_)
            over(std::span(level),
                 [&](dca::Merge const& m) CATENA_WHOLE { climb_merge(sweep, m); });
        over(tree.roots_, [&](dca::Root const& root) { close_root(sweep, root); });
    }
    template <class Sweep>
    void descend(Tree const& tree, Sweep const& sweep) const {
        for (std::size_t l = tree.levels_.size(); l-- > 0;)
            over(std::span(tree.levels_[l]), [&](dca::Merge const& m) CATENA_WHOLE {
                descend_merge(sweep, m, sweep.node(m.joint));
            });
        over(tree.runs_, [&](dca::Run const& run) CATENA_WHOLE { descend_run(sweep, run); });
    }
    /// Both.
    template <class AnyTree, class Sweep>
    void climb_and_descend(AnyTree const& tree, Sweep const& sweep) const {
        climb(tree, sweep);
        descend(tree, sweep);
    }
    /// And then action(k) for k < count.
    template <class Scan, class Action>
    void climb_and_descend(ScanTree const& tree, Scan const& scan, std::int64_t count,
                           Action const& action) const {
        climb_and_descend(tree, scan);
        for_each(count, action);
    }
    /// And then action(item) for each item.
    template <class Scan, class T, class Action>
    void climb_and_descend(ScanTree const& tree, Scan const& scan, std::span<T const> items,
                           Action const& action) const {
        climb_and_descend(tree, scan);
        over(items, action);
    }
    /// Whether scans by steps (RevoluteScan) of this tree that go over its items as well find these
    /// steps by a thread a body.
    static bool has_threads_for_bodies(ScanTree const& /*tree*/) { return false; }
    /// Whether loops over so many items leave threads without work that loops over the bodies in
    /// them would give them.
    static bool has_threads_to_spare(std::int64_t /*items*/) { return false; }
    /// The largest of value(0), ..., value(count - 1), which are 0 or more; a NaN counts as the
    /// largest. 0 of none.
    template <class Value>
    double largest(std::int64_t count, Value const& value) const {
        double worst = 0;
        for (std::int64_t i = 0; i < count; ++i)
            if (double const v = value(i); v > worst || v != v) worst = v;
        return worst;
    }

    /// One item of an array, from and to the host; get() and what the host gave to put() are done
    /// with when they return.
    template <class T>
    T get(T const* place) const {
        return *place;
    }
    template <class T>
    void put(T* place, T const& value) const {
        *place = value;
    }
    // Body k of a field, halo included.
    using HostAccess::get, HostAccess::put;
    /// A whole field for the host to read.
    template <int D>
    Field<D> const& read(Field<D> const& field) const {
        return field;
    }
    Directions const& read(Directions const& directions) const { return directions; }
    void write(Directions& directions, DirectionsField const& host) const { directions = host; }
    /// What the host does to a field.
    template <int D, class Edit>
    void edit(Field<D>& field, Edit const& change) const {
        change(field.view());
    }
    /// The same where it sets all bodies and nobody wants what was there, nor in the halo.
    template <int D, class Set>
    void set(Field<D>& field, Set const& all) const {
        all(field.view());
    }
    /// A view for the host of what a field holds now; `mirror` may hold it.
    template <int D>
    struct Mirror {};
    template <int D>
    View<D> pull(Field<D>& field, Mirror<D>&) const {
        return field.view();
    }
    /// What the host wrote there since. The mirror must stay as it is until the next pull.
    template <int D>
    void push(Field<D>&, Mirror<D> const&) const {}

    /// Seconds, `repeat` times the mean of `chained` calls one after the other. `asks_host`: what
    /// they do is not the space's alone.
    template <class Action>
    std::vector<double> time_chained(int chained, int repeat, bool /*asks_host*/,
                                     Action const& action) const {
        std::vector<double> seconds;
        for (int r = 0; r < repeat; ++r) {
            auto const start = std::chrono::steady_clock::now();
            for (int i = 0; i < chained; ++i) action();
            seconds.push_back(
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() /
                chained);
        }
        return seconds;
    }
    /// Until everything asked for so far is done.
    void wait() const {}
    int threads() const { return executor_->threads(); }
    /// What the host does besides: for loops over what it read or is to write.
    Executor const& on_host() const { return *executor_; }
    SimdLevel simd() const { return executor_->simd(); }
    /// action(begin, end) on ranges that together cover [0, count); they may run side by side.
    template <class Action>
    void over_ranges(std::int64_t count, int cost, Action const& action) const {
        executor_->for_ranges(count, cost, action);
    }

  private:
    Executor const* executor_;
};

/// Gives a field of a space the values of the host's.
template <class Space, class FieldOfSpace, int D>
void fill(Space const& space, FieldOfSpace& field, Field<D> const& host) {
    space.edit(field, [&](View<D> view) {
        space.on_host().for_each(host.size(), [&](std::int64_t k) { view.store(k, host[k]); });
    });
}

}  // namespace catena
