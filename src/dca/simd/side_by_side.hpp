// Runs and merges of a group that are processed side by side: their selection, their order, and the
// kernels of an instruction set for them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "chain/chain_group.hpp"
#include "dca/simd/runs.hpp"

namespace catena::dca {

/// Runs in whole vectors, and those that are left over.
struct RunsDealtOut {
    std::vector<RunsInLanes> items;
    std::vector<Run> others;
};
/// True if the data of this rank's bodies exceed the caches, so that sweeps should prefetch.
bool prefetches(ChainGroup const&);

/// Selection of runs to be processed side by side.
struct RunsTaken {
    /// True if runs shorter than longest_run, but not shorter than a part, are included where this
    /// saves time.
    bool of_parts;
    /// True if the leaf reads neighbours; only runs inside their chains are then included.
    bool read_neighbours;
};
/// Distributes runs to lanes. A run is processed side by side with others if its length fits
/// `RunsTaken`, all its inner joints restrict K directions and its last body has no jointed tip.
/// The group must have three runs on all ranks together. The choice therefore depends on the scene
/// only, not on which rank holds the run.
RunsDealtOut deal_out_runs(ChainGroup const&, int lanes, RunsTaken const&);

/// Returns the kernels of an instruction set.
template <class Leaf>
RunKernels<Leaf> kernels_of(SimdLevel level) {
    return level == SimdLevel::avx512 ? avx512_kernels<Leaf>() : avx2_kernels<Leaf>();
}

/// Array of doubles whose beginning is aligned for vectors.
class AlignedNumbers {
  public:
    AlignedNumbers() = default;
    explicit AlignedNumbers(std::int64_t count)
        : storage_(static_cast<std::size_t>(count) + most_lanes) {}
    double* data() { return storage_.data() + unaligned(); }
    double const* data() const { return storage_.data() + unaligned(); }
    std::int64_t bytes() const {
        return static_cast<std::int64_t>(storage_.size() * sizeof(double));
    }

  private:
    std::size_t unaligned() const {
        std::size_t const at =
            reinterpret_cast<std::uintptr_t>(storage_.data()) / sizeof(double) % most_lanes;
        return (most_lanes - at) % most_lanes;
    }
    LongArray<double> storage_;
};

/// True if RunWork may keep the data of all bodies: as many doubles as fit into the second-level
/// cache of a core, and somewhat more.
constexpr bool may_keep_all(std::int64_t numbers) { return numbers <= 1 << 17; }

/// Returns RunWork::constants; body(k, place) writes the `numbers` constants of body k.
template <class Body>
AlignedNumbers constants_in_lanes(std::vector<RunsInLanes> const& items, int lanes, int numbers,
                                  Body const& body) {
    AlignedNumbers all(std::ssize(items) * longest_run * numbers * lanes);
    std::vector<double> of_one(static_cast<std::size_t>(numbers));
    double* part = all.data();
    for (RunsInLanes const& item : items)
        for (int p = 0; p < parts_of_run; ++p, part += part_length * numbers * lanes)
            for (int i = 0; i < part_length; ++i)
                for (int lane = 0; lane < lanes; ++lane) {
                    body(std::max(item.body[lane], item.column[lane] + p * part_length + i),
                         of_one.data());
                    for (int n = 0; n < numbers; ++n)
                        part[(n * part_length + i) * lanes + lane] =
                            of_one[static_cast<std::size_t>(n)];
                }
    return all;
}

/// Merges of one level in whole vectors, and the others as a list of one level. Only joints that
/// restrict K directions are in vectors. Free lanes of a vector repeat its last merge.
struct LevelDealtOut {
    std::vector<MergesInLanes> items;
    std::vector<std::vector<Merge>> others;
};
/// Distributes the merges of all levels to lanes.
std::vector<LevelDealtOut> deal_out_levels(ChainGroup const&, int lanes);

/// Runs and merges of a group that are processed side by side, with the storage and the kernels for
/// them.
template <class Leaf>
class SideBySide {
  public:
    /// Distributes the runs and merges. `view` is that of the group.
    SideBySide(ChainGroup const& group, GroupView view, SimdLevel level) {
        if (level == SimdLevel::off) return;
        lanes_ = lanes_of(level);
        kernels_ = kernels_of<Leaf>(level);
        asks_ahead_ = prefetches(group);
        runs_ = deal_out_runs(group, lanes_, {Leaf::by_inertia, Leaf::reads_neighbours});
        keeps_all_ = !Leaf::beads && !Leaf::by_inertia &&
                     may_keep_all(items() * lanes_ * kept_of_run<Leaf::K>(true));
        nodes_ = AlignedNumbers(items() * lanes_ * kept_of_run_of<Leaf>(keeps_all_));
        constants_ = constants_in_lanes(
            runs_.items, lanes_, constants_of<Leaf>, [&](std::int64_t k, double* place) {
                each_constant<Leaf>(view, [&place, k]<int D>(ConstView<D> const& field) {
                    auto const numbers = field.load(k);
                    place = std::copy_n(numbers.data, D, place);
                });
                if constexpr (frame_constants<Leaf> > 0)
                    std::copy_n(group.joints.rotation[k].data, frame_constants<Leaf>, place);
            });
        if (items() == 0) return;
        levels_ = deal_out_levels(group, lanes_);
        for (LevelDealtOut const& l : levels_)
            merge_nodes_.emplace_back(std::ssize(l.items) * node_numbers<Leaf::K> * lanes_);
    }
    /// Returns the number of vectors of runs.
    std::int64_t items() const { return std::ssize(runs_.items); }
    /// Returns the runs that are processed one by one.
    std::vector<Run> const& other_runs() const { return runs_.others; }
    std::vector<LevelDealtOut> const& levels() const { return levels_; }
    /// Returns the memory in bytes.
    std::int64_t bytes() const {
        std::int64_t all = nodes_.bytes() + constants_.bytes() +
                           items() * static_cast<std::int64_t>(sizeof(RunsInLanes));
        for (std::size_t l = 0; l < levels_.size(); ++l)
            all += merge_nodes_[l].bytes() +
                   std::ssize(levels_[l].items) * static_cast<std::int64_t>(sizeof(MergesInLanes));
        return all;
    }

    /// Inward pass of the runs; completes `work` for descend().
    template <class Space>
    void climb(Space const& space, RunWork<Leaf>& work) {
        work.runs = runs_.items.data();
        work.constants = constants_.data();
        work.nodes = nodes_.data();
        work.keeps_all = keeps_all_;
        work.prefetches = asks_ahead_;
        space.over_ranges(items(), lanes_, [&](std::int64_t begin, std::int64_t end) {
            kernels_.climb(work, begin, end);
        });
    }
    /// Outward pass of the runs.
    template <class Space>
    void descend(Space const& space, RunWork<Leaf> const& work) {
        space.over_ranges(items(), lanes_, [&](std::int64_t begin, std::int64_t end) {
            kernels_.descend(work, begin, end);
        });
    }
    /// Inward pass of the merges of level `l`.
    template <class Space>
    void climb_level(Space const& space, TreeSweeps<Leaf> const& sweeps, std::size_t l) {
        over_level(space, sweeps, l, kernels_.climb_merges);
    }
    /// Outward pass of the merges of level `l`.
    template <class Space>
    void descend_level(Space const& space, TreeSweeps<Leaf> const& sweeps, std::size_t l) {
        over_level(space, sweeps, l, kernels_.descend_merges);
    }

  private:
    template <class Space, class Kernel>
    void over_level(Space const& space, TreeSweeps<Leaf> const& sweeps, std::size_t l,
                    Kernel const& kernel) {
        MergeWork<Leaf> const work{sweeps, levels_[l].items.data(), merge_nodes_[l].data(),
                                   asks_ahead_};
        space.over_ranges(std::ssize(levels_[l].items), 2,
                          [&](std::int64_t begin, std::int64_t end) { kernel(work, begin, end); });
    }
    RunKernels<Leaf> kernels_{};
    int lanes_ = 1;
    bool keeps_all_ = false, asks_ahead_ = false;
    RunsDealtOut runs_;
    std::vector<LevelDealtOut> levels_;
    AlignedNumbers nodes_, constants_;
    std::vector<AlignedNumbers> merge_nodes_;
};

}  // namespace catena::dca
