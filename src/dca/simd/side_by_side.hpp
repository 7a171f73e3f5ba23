// A group's runs that go side by side: which ones, in what order, and the kernels of an instruction set for them.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "chain/chain_group.hpp"
#include "dca/simd/runs.hpp"

namespace catena::dca {

/// Runs in whole vectors, and those that are left over.
struct RunsDealtOut {
    std::vector<RunsInLanes> items;
    std::vector<Run> others;
};
/// A run goes side by side with others if it is as long as runs are, within its chain, and all its own joints carry what handles do: so
/// this is a property of the tree, not of who holds the run.
RunsDealtOut deal_out_runs(ChainGroup const&, int lanes);

template <class Leaf>
RunKernels<Leaf> kernels_of(SimdLevel level) {
    return level == SimdLevel::avx512 ? avx512_kernels<Leaf>() : avx2_kernels<Leaf>();
}

/// That start where a vector may.
class AlignedNumbers {
  public:
    AlignedNumbers() = default;
    explicit AlignedNumbers(std::int64_t count) : storage_(static_cast<std::size_t>(count) + most_lanes) {}
    double* data() {
        void* place = storage_.data();
        std::size_t bytes = storage_.size() * sizeof(double);
        return static_cast<double*>(std::align(most_lanes * sizeof(double), sizeof(double), place, bytes));
    }
    std::int64_t bytes() const { return static_cast<std::int64_t>(storage_.size() * sizeof(double)); }

  private:
    LongArray<double> storage_;
};

template <class Leaf>
class SideBySide {
  public:
    SideBySide(ChainGroup const& group, SimdLevel level) {
        if (level == SimdLevel::off) return;
        kernels_ = kernels_of<Leaf>(level);
        runs_ = deal_out_runs(group, lanes_of(level));
        nodes_ = AlignedNumbers(items() * node_numbers<Leaf::K> * lanes_of(level));
    }
    std::int64_t items() const { return std::ssize(runs_.items); }
    std::vector<Run> const& others() const { return runs_.others; }
    std::int64_t bytes() const { return nodes_.bytes() + items() * static_cast<std::int64_t>(sizeof(RunsInLanes)); }

    template <class Space>
    void climb(Space const& space, RunWork<Leaf>& work) {
        work.runs = runs_.items.data();
        work.nodes = nodes_.data();
        space.over_ranges(items(), [&](std::int64_t begin, std::int64_t end) { kernels_.climb(work, begin, end); });
    }
    template <class Space>
    void descend(Space const& space, RunWork<Leaf> const& work) {
        space.over_ranges(items(), [&](std::int64_t begin, std::int64_t end) { kernels_.descend(work, begin, end); });
    }

  private:
    RunKernels<Leaf> kernels_{};
    RunsDealtOut runs_;
    AlignedNumbers nodes_;
};

}  // namespace catena::dca
