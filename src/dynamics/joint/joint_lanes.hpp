// Loops over bodies, and over runs of bodies, in vector lanes: the choice of bodies and runs to
// place side by side, and the loops of an instruction set. The arithmetic is that of
// joint_chains.hpp, joint_steps.hpp and embedded_steps.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "dca/host_space.hpp"
#include "dca/simd/side_by_side.hpp"
#include "dynamics/joint/embedded_steps.hpp"

namespace catena {

/// Groups of consecutive bodies: first[i], first[i] + 1, ... fill a vector. `prefetches`: prefetch,
/// as dca::prefetches() advises.
struct BodyLanes {
    std::int64_t const* first;
    bool prefetches;
};
/// Groups of runs, one run per lane.
struct RunsAbreast {
    dca::RunsInLanes const* items;
    bool prefetches;
};
/// Loops of one instruction set over groups [begin, end) that compute the motion of bodies. There
/// is one table with and one without positions.
struct KinematicLoops {
    void (*set_relative)(JointChains const&, BodyLanes const&, std::int64_t begin,
                         std::int64_t end);
    /// Runs JointScan::follow on runs, and stores the motion across each run (JointScan::whole).
    void (*follow)(JointScan const&, RunsAbreast const&, std::int64_t begin, std::int64_t end);
    /// Runs the same scan for revolute joints directly from their coordinates. It stores rotations
    /// and torques of the joints, motions across runs, and relative motions of the runs' first
    /// bodies only. Relative motions of chains' first bodies must be known. `constants`:
    /// revolute_constants of every body, laid out as RunWork::constants.
    void (*follow_revolutes)(JointLoads const&, RunsAbreast const&, double const* constants,
                             std::int64_t begin, std::int64_t end);
    /// Computes angular velocities of the runs' first bodies, after the scan.
    void (*begin_runs)(JointScan const&, RunsAbreast const&, std::int64_t begin, std::int64_t end);
    void (*set_motion)(JointChains const&, BodyLanes const&, std::int64_t begin, std::int64_t end);
};
/// Loops of one instruction set over groups [begin, end) that advance the state of bodies.
struct StepLoops {
    void (*set_rates)(JointChains const&, RatesView const&, BodyLanes const&, std::int64_t begin,
                      std::int64_t end);
    void (*accumulate)(JointSteps const&, WeightedStage const&, BodyLanes const&,
                       std::int64_t begin, std::int64_t end);
    void (*embedded_stage)(EmbeddedSteps const&, EmbeddedStage const&, BodyLanes const&,
                           std::int64_t begin, std::int64_t end);
};
/// All loops of one instruction set.
struct JointLoops : KinematicLoops, StepLoops {};
/// Numbers per body: the axis of the revolute joint, and the rotation of its meeting frame.
inline constexpr int revolute_constants = 7;
/// Loops of an instruction set. Precondition: simd_levels() includes it.
KinematicLoops avx2_kinematic_loops(bool positions);
KinematicLoops avx512_kinematic_loops(bool positions);
StepLoops avx2_step_loops(bool positions);
StepLoops avx512_step_loops(bool positions);

/// Decides which bodies and runs of a group are placed side by side, and executes their loops.
class JointLanes {
  public:
    /// `springs`: some joint has one. `revolutes`: the solver eliminates_revolute_joints() with
    /// runs side by side. The group must outlive this object.
    JointLanes(ChainGroup const&, bool springs, bool revolutes, SimdLevel);
    // Moves only: the tree of a copy would refer to the original's runs.
    JointLanes(JointLanes&&) = default;
    JointLanes& operator=(JointLanes&&) = default;

    /// True if any bodies or runs are side by side. Precondition of all other members.
    bool any() const { return !bodies_.first.empty() || !runs_.items.empty(); }
    /// Calls some(loops, bodies, begin, end) for groups of bodies and one(k) for the other bodies.
    template <class Space, class Some, class One>
    void each(Space const& space, bool positions, Some const& some, One const& one) const {
        JointLoops const& loops = loops_[positions ? 1 : 0];
        space.over_ranges(std::ssize(bodies_.first), 2, [&](std::int64_t begin, std::int64_t end) {
            some(loops, BodyLanes{bodies_.first.data(), asks_ahead_}, begin, end);
        });
        space.over(std::span(bodies_.others), [&one](std::int64_t k) CATENA_WHOLE { one(k); });
    }

    /// Runs JointScan::follow on the runs that are side by side. tree() contains the other runs and
    /// all levels above.
    template <class Space>
    void follow(Space const& space, bool positions, JointScan const& scan) const {
        JointLoops const& loops = loops_[positions ? 1 : 0];
        over_runs(space, [&](RunsAbreast const& runs, std::int64_t begin, std::int64_t end) {
            loops.follow(scan, runs, begin, end);
        });
    }
    HostSpace::ScanTree const& tree() const { return *tree_; }

    // Members for chains whose solver eliminates_revolute_joints() and whose positions are not
    // requested. Precondition: `revolutes`.

    /// Runs that are not side by side.
    std::span<dca::Run const> other_runs() const { return runs_.others; }
    /// Bodies that begin a chain, in runs that are side by side.
    std::span<std::int64_t const> chains_begin() const { return chains_begin_; }
    /// Runs KinematicLoops::follow_revolutes. Precondition: set_relative() of chains_begin().
    template <class Space>
    void follow_revolutes(Space const& space, JointLoads const& loads) const {
        over_runs(space, [&](RunsAbreast const& runs, std::int64_t begin, std::int64_t end) {
            loops_[0].follow_revolutes(loads, runs, constants_.data(), begin, end);
        });
    }
    /// Runs KinematicLoops::begin_runs, after the scan.
    template <class Space>
    void begin_runs(Space const& space, JointScan const& scan) const {
        over_runs(space, [&](RunsAbreast const& runs, std::int64_t begin, std::int64_t end) {
            loops_[0].begin_runs(scan, runs, begin, end);
        });
    }

  private:
    struct Bodies {
        // First bodies of groups that fill a vector; all bodies outside such groups.
        std::vector<std::int64_t> first, others;
    };
    template <class Space, class Action>
    void over_runs(Space const& space, Action const& action) const {
        space.over_ranges(std::ssize(runs_.items), 2 * static_cast<int>(dca::longest_run),
                          [&](std::int64_t begin, std::int64_t end) {
                              action({runs_.items.data(), asks_ahead_}, begin, end);
                          });
    }
    /// Loops without and with positions.
    JointLoops loops_[2]{};
    bool asks_ahead_ = false;
    dca::RunsDealtOut runs_;
    std::optional<HostSpace::ScanTree> tree_;
    Bodies bodies_;
    std::vector<std::int64_t> chains_begin_;
    dca::AlignedNumbers constants_;
};

}  // namespace catena
