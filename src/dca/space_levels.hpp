// Part of the tree's levels in any Space, computed level by level as in the chapter: one loop per
// level, on a GPU one kernel per level.
#pragma once

#include <algorithm>

#include "dca/host_space.hpp"
#include "dca/level_solver.hpp"
#include "dca/sweep_store.hpp"
#include "dca/tree_sweeps.hpp"

namespace catena::dca {

namespace loops {

/// Inward pass of one item: a run, a merge or a root.
template <class Sweep>
struct Climb {
    Sweep sweep;
    CATENA_HD void operator()(Run const& run) const { climb_run(sweep, run); }
    CATENA_HD void operator()(Merge const& m) const { climb_merge(sweep, m); }
    CATENA_HD void operator()(Root const& root) const { close_root(sweep, root); }
};
/// Outward pass of one item: a run or a merge.
template <class Sweep>
struct Descend {
    Sweep sweep;
    CATENA_HD void operator()(Run const& run) const { descend_run(sweep, run); }
    CATENA_HD void operator()(Merge const& m) const {
        descend_merge(sweep, m, sweep.node(m.joint));
    }
};
/// Copies the records at `places` into a contiguous array.
template <class T, Order order>
struct Pack {
    RecordsView<T, order> items;
    std::int64_t const* places;
    T* packed;
    CATENA_HD void operator()(std::int64_t i) const { packed[i] = items.load(places[i]); }
};
/// Copies a contiguous array into the records at `places`.
template <class T, Order order>
struct Unpack {
    T const* packed;
    std::int64_t const* places;
    RecordsView<T, order> items;
    CATENA_HD void operator()(std::int64_t i) const { items.store(places[i], packed[i]); }
};

}  // namespace loops

/// Transfers of views and numbers between the host and the host's own space. The data are already
/// there.
class HostCrossing {
  public:
    explicit HostCrossing(ChainGroup const&, HostSpace const&) {}
    /// Returns views in the space with the values of the host's views.
    ConfigurationView take(ConfigurationView const& host) const { return host; }
    LoadsView take(LoadsView const& host) const { return host; }
    /// Returns views in the space for results; fetch() copies them to the host's views.
    AccelerationsView wanted(AccelerationsView const& host) const { return host; }
    void fetch(AccelerationsView const&) const {}
    /// Copies to.size() numbers from the space to the host.
    void download(std::vector<double> const& from, std::vector<double>& to) const {
        std::copy_n(from.begin(), to.size(), to.begin());
    }
    /// Copies all numbers from the host to the space.
    void upload(std::vector<double> const& from, std::vector<double>& to) const {
        std::copy(from.begin(), from.end(), to.begin());
    }
};

/// LevelPart in a Space. `Crossing` transfers data between the host and that space and has the
/// interface of HostCrossing.
template <class Leaf, class Space, class Crossing>
class SpaceLevels final : public LevelPart {
    static constexpr int K = Leaf::K;
    using Sweeps = typename SweepsOf<Leaf>::Sweeps;
    using OfMatrices = typename SweepsOf<Leaf>::OfMatrices;
    using OfBiases = typename SweepsOf<Leaf>::OfBiases;
    template <class T>
    using List = typename Space::template List<T>;
    template <class T>
    using Array = typename Space::template Array<T>;

  public:
    /// Allocates the arrays for all slots and joints of the schedule, of which the part uses its
    /// own.
    SpaceLevels(ChainGroup const& group, LevelWork const& work, Space const& space)
        : schedule_(group.schedule),
          work_(work),
          space_(space),
          crossing_(group, space),
          store_(group, space, typename Space::Model(group)),
          leaves_up_(work.leaves_up ? schedule_.runs : none_.runs),
          leaves_down_(work.leaves_down ? schedule_.runs : none_.runs),
          up_(lists(schedule_.levels, work.first_up, work.end_up)),
          down_(lists(schedule_.levels, work.first_down, work.end_down)),
          top_(lists(schedule_.top_levels, 0, work.top ? schedule_.top_levels.size() : 0)),
          roots_(work.top ? schedule_.roots : none_.roots),
          top_roots_(work.top ? schedule_.top_roots : none_.roots) {}

    void set(ConfigurationView const& host) override {
        if (work_.leaves()) store_.sweeps().leaf.set(crossing_.take(host));
        space_.wait();
    }
    void set(LoadsView const& loads, AccelerationsView const& out) override {
        if (work_.leaves()) loads_ = crossing_.take(loads);
        host_out_ = out;
        out_ = crossing_.wanted(out);
        space_.wait();
    }
    void assemble_matrices() override {
        space_.over(leaves_up_, loops::Climb<OfMatrices>{{store_.sweeps()}});
        climb(up_, loops::Climb<OfMatrices>{{store_.sweeps()}});
        space_.wait();
    }
    void close_matrices() override {
        loops::Climb<OfMatrices> const loop{{store_.sweeps()}};
        climb(top_, loop);
        space_.over(roots_, loop);
        space_.over(top_roots_, loop);
        space_.wait();
    }
    void assemble_biases() override {
        space_.over(leaves_up_, loops::Climb<OfBiases>{biases()});
        climb(up_, loops::Climb<OfBiases>{biases()});
        space_.wait();
    }
    void close_biases() override {
        loops::Climb<OfBiases> const loop{biases()};
        climb(top_, loop);
        space_.over(roots_, loop);
        space_.over(top_roots_, loop);
        descend(top_);
        space_.wait();
    }
    void disassemble() override {
        descend(down_);
        space_.over(leaves_down_, loops::Descend<OfBiases>{biases()});
        space_.wait();
    }
    void fetch() override {
        if (work_.leaves_down) crossing_.fetch(host_out_);
        // The force of the joint after this rank's last body is known to the top only.
        if (work_.top && out_.joint_force)
            host_out_.joint_force.template store<K>(
                schedule_.bodies, force_of(store_.sweeps().forces.load(schedule_.halo)));
    }
    std::int64_t first_indefinite() override {
        PivotFailure const found = store_.take_failure(space_);
        return found.none() ? schedule_.joints : static_cast<std::int64_t>(found.joint);
    }

    int choose(std::vector<std::int64_t> const& places) override {
        places_.push_back(std::make_unique<Places>(places));
        return static_cast<int>(std::ssize(places_)) - 1;
    }
    void get(Items items, int list, std::vector<double>& numbers) override {
        with(items, [&](auto records) {
            get(records, *places_[static_cast<std::size_t>(list)], numbers);
        });
    }
    void put(Items items, int list, std::vector<double> const& numbers) override {
        with(items, [&](auto records) {
            put(records, *places_[static_cast<std::size_t>(list)], numbers);
        });
    }
    std::int64_t memory_bytes() const override { return Sweeps::bytes(schedule_); }
    int threads() const override { return space_.threads(); }

  private:
    // Lists of a part that has no leaves or no roots.
    struct Empty {
        std::vector<Run> runs;
        std::vector<Root> roots;
    };
    // Slots or joints chosen by choose(), on the host and in the space.
    struct Places {
        explicit Places(std::vector<std::int64_t> const& places_in) : host(places_in), list(host) {}
        std::vector<std::int64_t> host;
        List<std::int64_t> list;
    };

    /// Returns the bias sweep with the current loads and results.
    OfBiases biases() const { return {store_.sweeps(), loads_, out_}; }
    /// Returns the merges of the levels [first, end) as lists of the space.
    static std::vector<List<Merge>> lists(std::vector<std::vector<Merge>> const& levels,
                                          std::size_t first, std::size_t end) {
        std::vector<List<Merge>> all;
        for (std::size_t l = first; l < end; ++l) all.emplace_back(levels[l]);
        return all;
    }
    /// Inward pass over levels of merges.
    template <class Action>
    void climb(std::vector<List<Merge>> const& levels, Action const& action) const {
        for (List<Merge> const& level : levels) space_.over(level, action);
    }
    /// Outward pass over levels of merges.
    void descend(std::vector<List<Merge>> const& levels) const {
        for (std::size_t l = levels.size(); l-- > 0;)
            space_.over(levels[l], loops::Descend<OfBiases>{biases()});
    }

    /// Calls use(view) with the records of the given kind.
    template <class Use>
    void with(Items items, Use const& use) {
        Sweeps const& sweeps = store_.sweeps();
        switch (items) {
            case Items::matrices:
                return use(sweeps.matrices);
            case Items::biases:
                return use(sweeps.biases);
            case Items::joints:
                return use(sweeps.joints);
            case Items::offsets:
                return use(sweeps.offsets);
            case Items::forces:
                return use(sweeps.forces);
        }
    }
    /// Returns memory for the numbers of `count` items during a transfer.
    template <class T>
    T* parcel(std::size_t count) {
        static_assert(sizeof(T) % sizeof(double) == 0);
        std::size_t const numbers = count * (sizeof(T) / sizeof(double));
        if (parcel_.size() < numbers) parcel_ = Array<double>(numbers);
        return reinterpret_cast<T*>(parcel_.data());
    }
    /// Copies the chosen records to `numbers` on the host.
    template <class T, Order order>
    void get(RecordsView<T, order> items, Places const& places, std::vector<double>& numbers) {
        numbers.resize(places.host.size() * (sizeof(T) / sizeof(double)));
        if (numbers.empty()) return;
        space_.for_each(
            std::ssize(places.host),
            loops::Pack<T, order>{items, places.list.data(), parcel<T>(places.host.size())});
        crossing_.download(parcel_, numbers);
    }
    /// Copies `numbers` from the host to the chosen records.
    template <class T, Order order>
    void put(RecordsView<T, order> items, Places const& places,
             std::vector<double> const& numbers) {
        if (numbers.empty()) return;
        T* const packed = parcel<T>(places.host.size());
        crossing_.upload(numbers, parcel_);
        space_.for_each(std::ssize(places.host),
                        loops::Unpack<T, order>{packed, places.list.data(), items});
        space_.wait();
    }

    // Group's schedule, which must outlive the part, and the part's share of it.
    Schedule const& schedule_;
    LevelWork work_;
    Space space_;
    Crossing crossing_;
    SweepStore<Leaf, Space> store_;
    Empty none_;
    // Lists of the part's runs, merges and roots.
    List<Run> leaves_up_, leaves_down_;
    std::vector<List<Merge>> up_, down_, top_;
    List<Root> roots_, top_roots_;
    // Contiguous buffer for transfers.
    Array<double> parcel_;
    std::vector<std::unique_ptr<Places>> places_;
    // Loads and results in the space, and the host's views of the results.
    LoadsView loads_;
    AccelerationsView out_, host_out_;
};

}  // namespace catena::dca
