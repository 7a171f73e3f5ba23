// A Space defines where arrays are stored and where loops over them run. Solvers and integrators
// are written once for any Space. HostSpace is the host; cuda::DeviceSpace is a GPU. Both have the
// same members, which are specified here.
#pragma once

#include <algorithm>
#include <chrono>
#include <span>
#include <utility>
#include <vector>

#include "dca/host_blocks.hpp"
#include "dca/host_trees.hpp"
#include "dca/solver.hpp"
#include "math/records.hpp"

/// Attribute of the function that a loop applies to one item: everything that it calls is inlined,
/// so that small vectors and matrices stay in registers. By default gcc stops inlining at a size
/// that these functions exceed, and they then take two to three times as long.
#if !defined(CATENA_WHOLE)  // Builds with sanitizers define it as empty.
#define CATENA_WHOLE __attribute__((flatten))
#endif

namespace catena {

/// Model of a group that sweeps and dynamics read.
class HostModel {
  public:
    explicit HostModel(ChainGroup const& group) : group_(group) {}
    GroupView view() const { return group_.view(); }
    std::uint8_t const* restricted() const { return group_.joints.restricted.data(); }
    /// Mass and inertia of bodies in joint coordinates, also where no sweep reads them.
    ConstView<1> mass() const { return group_.bodies.mass.view(); }
    ConstView<6> inertia() const { return group_.bodies.inertia.view(); }

  private:
    ChainGroup const& group_;
};

/// The Space of this rank's host: arrays in host memory, loops on an Executor.
class HostSpace : public HostAccess {
  public:
    /// True if calls return only when their work is complete.
    static constexpr bool answers_at_once = true;
    /// The executor must outlive the space.
    explicit HostSpace(Executor const& executor) : executor_(&executor) {}

    /// Memory of the space, initially zero.
    template <class T>
    using Array = std::vector<T>;
    /// Direct connection from this rank's memory to that of others which bypasses the host, where
    /// there is one. exchange() distributes numbers as FrontierExchange::bring() specifies. All
    /// ranks have one or none has.
    struct Direct {
        explicit operator bool() const { return false; }
    };
    Direct connect(dca::Schedule const&, int /*width*/, int /*beside*/) const { return {}; }
    template <class Numbers, class... Beside>
    void exchange(Direct const&, Numbers const&, Beside const&...) const {}
    /// Executes a sweep over a shared tree as FrontierExchange::both_passes() specifies. Returns
    /// false if the space cannot.
    template <class Numbers, class AnyTree, class Sweep, class... Beside>
    bool shared_passes(Direct const&, Numbers const&, AnyTree const&, AnyTree const& /*top*/,
                       Sweep const&, Beside const&...) const {
        return false;
    }
    using HostAccess::exchange;
    /// Memory shared by loops and the host: after wait(), each sees what the other wrote.
    template <class T>
    using HostArray = std::vector<T>;
    template <int D>
    using FieldOf = Field<D>;
    /// Storage of K numbers per body for `size` bodies, K known at run time.
    using Directions = DirectionsField;
    /// Read-only copy or view of a host array, which must outlive it.
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
    using Model = HostModel;
    /// Returns the model that the group's solver and its dynamics share. There is one as long as
    /// one of them holds it.
    Model model(ChainGroup const& group) const { return Model(group); }
    /// Storage of `count` records, initially zero.
    template <class T, dca::Order order>
    class Records {
      public:
        explicit Records(std::int64_t count) : records_(static_cast<std::size_t>(count)) {}
        dca::RecordsView<T, order> view() { return {reinterpret_cast<double*>(records_.data())}; }

      private:
        LongArray<T> records_;
    };
    /// Trees of sweeps and of scans.
    using Tree = HostTree;
    using ScanTree = HostScanTree;

    /// Blocks of the whole chains that the group has on this rank. A block has loops over its own
    /// bodies and tips, and sweeps over its own chains (host_blocks.hpp).
    using Blocks = HostBlocks;
    /// True if the space has blocks for handles with K directions.
    template <int K>
    static constexpr bool has_blocks = true;
    /// True if blocks are teams of threads (team_tree.hpp).
    template <int K>
    static constexpr bool has_teams = false;
    /// True if it is faster to let each block do its whole work alone.
    bool pays_by_blocks(ChainGroup const& group) const {
        return std::ssize(group.pieces) >= std::max(2, threads());
    }
    /// Calls action(block) for every block, possibly concurrently.
    template <class Action>
    void each_block(Blocks const& blocks, Action const& action) const {
        executor_->for_each(blocks.count(), [&](std::int64_t b) { action(HostBlock(blocks, b)); });
    }

    /// Calls action(i) for i < count, possibly concurrently.
    template <class Action>
    void for_each(std::int64_t count, Action const& action) const {
        executor_->for_each(count, [&](std::int64_t i) CATENA_WHOLE { action(i); });
    }
    /// Calls action(item) for every item, possibly concurrently.
    template <class T, class Action>
    void over(List<T> const& items, Action const& action) const {
        executor_->for_each(std::ssize(items),
                            [&](std::int64_t i) { action(items[static_cast<std::size_t>(i)]); });
    }
    /// Inward pass of a scan, from the runs to the roots.
    template <class Scan>
    void climb(ScanTree const& tree, Scan const& scan) const {
        over(tree.runs_, [&](dca::Run const& run) { scan.set_whole(run.slot, scan.of_run(run)); });
        for (std::vector<dca::Merge> const& level : tree.levels_)
            over(std::span(level), [&](dca::Merge const& m) {
                scan.set_whole(m.slot, scan.joined(scan.whole(m.inboard), scan.whole(m.outboard)));
            });
    }
    /// Outward pass of a scan, from the roots to the runs.
    template <class Scan>
    void descend(ScanTree const& tree, Scan const& scan) const {
        for (std::size_t l = tree.levels_.size(); l-- > 0;)
            over(std::span(tree.levels_[l]), [&](dca::Merge const& m) {
                auto const before = scan.before(m.slot);
                scan.set_before(m.inboard, before);
                scan.set_before(m.outboard, scan.joined(before, scan.whole(m.inboard)));
            });
    }
    /// Inward pass of a sweep (tree_sweeps.hpp), from the leaves to the roots.
    template <class Sweep>
    void climb(Tree const& tree, Sweep const& sweep) const {
        over(tree.runs_, [&](dca::Run const& run) CATENA_WHOLE { climb_run(sweep, run); });
        for (std::vector<dca::Merge> const& level : tree.levels_)
            over(std::span(level),
                 [&](dca::Merge const& m) CATENA_WHOLE { climb_merge(sweep, m); });
        over(tree.roots_, [&](dca::Root const& root) { close_root(sweep, root); });
    }
    /// Outward pass of a sweep, from the roots to the leaves.
    template <class Sweep>
    void descend(Tree const& tree, Sweep const& sweep) const {
        for (std::size_t l = tree.levels_.size(); l-- > 0;)
            over(std::span(tree.levels_[l]), [&](dca::Merge const& m) CATENA_WHOLE {
                descend_merge(sweep, m, sweep.node(m.joint));
            });
        over(tree.runs_, [&](dca::Run const& run) CATENA_WHOLE { descend_run(sweep, run); });
    }
    /// Inward pass, then outward pass.
    template <class AnyTree, class Sweep>
    void climb_and_descend(AnyTree const& tree, Sweep const& sweep) const {
        climb(tree, sweep);
        descend(tree, sweep);
    }
    /// True if loops over `items` items leave threads idle that loops over their bodies would use.
    static bool has_threads_to_spare(std::int64_t /*items*/) { return false; }
    /// Returns the largest of value(0), ..., value(count - 1), which must be >= 0. NaN counts as
    /// the largest value; an empty range gives 0.
    template <class Value>
    double largest(std::int64_t count, Value const& value) const {
        double worst = 0;
        for (std::int64_t i = 0; i < count; ++i)
            if (double const v = value(i); v > worst || v != v) worst = v;
        return worst;
    }

    /// Copies one item of an array to the host. get() and put() are complete when they return.
    template <class T>
    T get(T const* place) const {
        return *place;
    }
    template <class T>
    void put(T* place, T const& value) const {
        *place = value;
    }
    // Overloads for body k of a field, halo included.
    using HostAccess::get, HostAccess::put;
    /// Returns a whole field for the host to read.
    template <int D>
    Field<D> const& read(Field<D> const& field) const {
        return field;
    }
    Directions const& read(Directions const& directions) const { return directions; }
    void write(Directions& directions, DirectionsField const& host) const { directions = host; }
    /// Lets the host modify a field: calls change(view).
    template <int D, class Edit>
    void edit(Field<D>& field, Edit const& change) const {
        change(field.view());
    }
    /// Lets the host set all bodies of a field. The previous values, halo included, are not
    /// preserved.
    template <int D, class Set>
    void set(Field<D>& field, Set const& all) const {
        all(field.view());
    }
    /// Host copy of a field, where the host cannot read the field itself.
    template <int D>
    struct Mirror {};
    /// Returns a view for the host with the current values of a field; `mirror` may hold them.
    template <int D>
    View<D> pull(Field<D>& field, Mirror<D>&) const {
        return field.view();
    }
    /// Copies back what the host wrote to the view of pull(). The mirror must not change until the
    /// next pull.
    template <int D>
    void push(Field<D>&, Mirror<D> const&) const {}

    /// Returns `repeat` times in seconds, each the mean of `chained` consecutive calls of `action`.
    /// `asks_host`: the calls include work of the host.
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
    /// Waits until all submitted work is complete.
    void wait() const {}
    int threads() const { return executor_->threads(); }
    /// Executor for loops of the host over data that it has read or will write.
    Executor const& on_host() const { return *executor_; }
    SimdLevel simd() const { return executor_->simd(); }
    /// Calls action(begin, end) on ranges that together cover [0, count), possibly concurrently.
    template <class Action>
    void over_ranges(std::int64_t count, int cost, Action const& action) const {
        executor_->for_ranges(count, cost, action);
    }

  private:
    Executor const* executor_;
};

/// Copies a field of the host to a field of a space.
template <class Space, class FieldOfSpace, int D>
void fill(Space const& space, FieldOfSpace& field, Field<D> const& host) {
    space.edit(field, [&](View<D> view) {
        space.on_host().for_each(host.size(), [&](std::int64_t k) { view.store(k, host[k]); });
    });
}

}  // namespace catena
