// Loops over the bodies of chains in joint coordinates, and over their runs, as many at a time as a vector has lanes: which ones, and the
// loops of an instruction set. What these do is in joint_chains.hpp, joint_steps.hpp and embedded_steps.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "dca/host_space.hpp"
#include "dca/simd/side_by_side.hpp"
#include "integrate/embedded_steps.hpp"

namespace catena {

/// For the bodies at first[i], first[i] + 1, ... that fill a vector, i in [begin, end). With or without positions, as JointChains says.
struct JointLoops {
    void (*set_relative)(JointChains const&, std::int64_t const* first, std::int64_t begin, std::int64_t end);
    /// JointScan::follow of the runs of items [begin, end), whose wholes it shows.
    void (*follow)(JointScan const&, dca::RunsInLanes const* items, std::int64_t begin, std::int64_t end);
    void (*set_motion)(JointChains const&, std::int64_t const* first, std::int64_t begin, std::int64_t end);
    void (*set_rates)(JointChains const&, RatesView const&, std::int64_t const* first, std::int64_t begin, std::int64_t end);
    void (*runge_kutta)(JointSteps const&, RungeKuttaStage const&, std::int64_t const* first, std::int64_t begin, std::int64_t end);
    void (*embedded_stage)(EmbeddedSteps const&, EmbeddedStage const&, std::int64_t const* first, std::int64_t begin, std::int64_t end);
};
/// Precondition: simd_levels() has them.
JointLoops avx2_joint_loops(bool positions);
JointLoops avx512_joint_loops(bool positions);

class JointLanes {
  public:
    /// `springs`: whether joints have any. The group must outlive it.
    JointLanes(ChainGroup const&, bool springs, SimdLevel);
    // A copy's tree would be of the original's runs.
    JointLanes(JointLanes&&) = default;
    JointLanes& operator=(JointLanes&&) = default;

    /// Whether any bodies go side by side. Precondition of all that follows.
    bool any() const { return !first_.empty(); }
    /// some(loops, first, begin, end) for those, one(k) for the others.
    template <class Space, class Some, class One>
    void each(Space const& space, bool positions, Some const& some, One const& one) const {
        JointLoops const& loops = loops_[positions ? 1 : 0];
        space.over_ranges(std::ssize(first_), 2, [&](std::int64_t begin, std::int64_t end) { some(loops, first_.data(), begin, end); });
        space.over(typename Space::template List<std::int64_t>(others_), [&one](std::int64_t k) CATENA_WHOLE { one(k); });
    }

    /// JointScan::follow of the runs that go side by side; tree() has the others, and what is above all of them.
    template <class Space>
    void follow(Space const& space, bool positions, JointScan const& scan) const {
        JointLoops const& loops = loops_[positions ? 1 : 0];
        space.over_ranges(std::ssize(runs_.items), 2 * static_cast<int>(dca::longest_run),
                          [&](std::int64_t begin, std::int64_t end) { loops.follow(scan, runs_.items.data(), begin, end); });
    }
    HostSpace::ScanTree const& tree() const { return *tree_; }

  private:
    JointLoops loops_[2]{};
    dca::RunsDealtOut runs_;
    std::optional<HostSpace::ScanTree> tree_;
    std::vector<std::int64_t> first_, others_;
};

}  // namespace catena
