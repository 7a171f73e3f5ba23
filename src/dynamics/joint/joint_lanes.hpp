// Loops over the bodies of chains in joint coordinates, and over their runs, as many at a time as a
// vector has lanes: which ones, and the loops of an instruction set. What these do is in
// joint_chains.hpp, joint_steps.hpp and embedded_steps.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "dca/host_space.hpp"
#include "dca/simd/side_by_side.hpp"
#include "dynamics/joint/embedded_steps.hpp"

namespace catena {

/// Those at first[i], first[i] + 1, ... fill a vector. `asks_ahead`: as dca::asks_ahead().
struct BodiesAbreast {
    std::int64_t const* first;
    bool asks_ahead;
};
struct RunsAbreast {
    dca::RunsInLanes const* items;
    bool asks_ahead;
};
/// For i in [begin, end) of these. With or without positions, as JointChains says.
struct JointLoops {
    void (*set_relative)(JointChains const&, BodiesAbreast const&, std::int64_t begin,
                         std::int64_t end);
    /// JointScan::follow of the runs of items [begin, end), whose wholes it shows.
    void (*follow)(JointScan const&, RunsAbreast const&, std::int64_t begin, std::int64_t end);
    /// The same of runs on revolute joints from their coordinates: turns and torques of their
    /// joints, wholes, and motions against the bodies inboard of them of first bodies alone. Of
    /// chains' first bodies all but the wholes is known. `constants`: revolute_constants of every
    /// body, as RunWork::constants.
    void (*follow_revolutes)(JointLoads const&, RunsAbreast const&, double const* constants,
                             std::int64_t begin, std::int64_t end);
    /// After the scan, angular velocities of these runs' first bodies.
    void (*begin_runs)(JointScan const&, RunsAbreast const&, std::int64_t begin, std::int64_t end);
    void (*set_motion)(JointChains const&, BodiesAbreast const&, std::int64_t begin,
                       std::int64_t end);
    void (*set_rates)(JointChains const&, RatesView const&, BodiesAbreast const&,
                      std::int64_t begin, std::int64_t end);
    void (*runge_kutta)(JointSteps const&, RungeKuttaStage const&, BodiesAbreast const&,
                        std::int64_t begin, std::int64_t end);
    void (*embedded_stage)(EmbeddedSteps const&, EmbeddedStage const&, BodiesAbreast const&,
                           std::int64_t begin, std::int64_t end);
};
/// The revolute joint's axis, and the rotation of its meeting frame.
inline constexpr int revolute_constants = 7;
/// Precondition: simd_levels() has them.
JointLoops avx2_joint_loops(bool positions);
JointLoops avx512_joint_loops(bool positions);

class JointLanes {
  public:
    /// `springs`: whether joints have any. `revolute joints`: whether the solver
    /// goes_by_revolutes(), side by side. The group must outlive it.
    JointLanes(ChainGroup const&, bool springs, bool revolutes, SimdLevel);
    // A copy's tree would be of the original's runs.
    JointLanes(JointLanes&&) = default;
    JointLanes& operator=(JointLanes&&) = default;

    /// Whether any bodies or runs go side by side. Precondition of all that follows.
    bool any() const { return !bodies_.first.empty() || !runs_.items.empty(); }
    /// some(loops, bodies, begin, end) for those, one(k) for the others.
    template <class Space, class Some, class One>
    void each(Space const& space, bool positions, Some const& some, One const& one) const {
        JointLoops const& loops = loops_[positions ? 1 : 0];
        space.over_ranges(std::ssize(bodies_.first), 2, [&](std::int64_t begin, std::int64_t end) {
            some(loops, BodiesAbreast{bodies_.first.data(), asks_ahead_}, begin, end);
        });
        space.over(std::span(bodies_.others), [&one](std::int64_t k) CATENA_WHOLE { one(k); });
    }

    /// JointScan::follow of the runs that go side by side; tree() has the others, and what is above
    /// all of them.
    template <class Space>
    void follow(Space const& space, bool positions, JointScan const& scan) const {
        JointLoops const& loops = loops_[positions ? 1 : 0];
        over_runs(space, [&](RunsAbreast const& runs, std::int64_t begin, std::int64_t end) {
            loops.follow(scan, runs, begin, end);
        });
    }
    HostSpace::ScanTree const& tree() const { return *tree_; }

    // Chains whose solver goes_by_revolutes(), none of whose positions is asked for. Precondition:
    // `revolute joints`.

    /// Runs that do not go side by side; bodies of the others that begin a chain.
    std::span<dca::Run const> other_runs() const { return runs_.others; }
    std::span<std::int64_t const> chains_begin() const { return chains_begin_; }
    /// After set_relative() of those.
    template <class Space>
    void follow_revolutes(Space const& space, JointLoads const& loads) const {
        over_runs(space, [&](RunsAbreast const& runs, std::int64_t begin, std::int64_t end) {
            loops_[0].follow_revolutes(loads, runs, constants_.data(), begin, end);
        });
    }
    template <class Space>
    void begin_runs(Space const& space, JointScan const& scan) const {
        over_runs(space, [&](RunsAbreast const& runs, std::int64_t begin, std::int64_t end) {
            loops_[0].begin_runs(scan, runs, begin, end);
        });
    }

  private:
    struct Bodies {
        std::vector<std::int64_t> first, others;  // of those that fill a vector; all that do not
    };
    template <class Space, class Action>
    void over_runs(Space const& space, Action const& action) const {
        space.over_ranges(std::ssize(runs_.items), 2 * static_cast<int>(dca::longest_run),
                          [&](std::int64_t begin, std::int64_t end) {
                              action({runs_.items.data(), asks_ahead_}, begin, end);
                          });
    }
    JointLoops loops_[2]{};
    bool asks_ahead_ = false;
    dca::RunsDealtOut runs_;
    std::optional<HostSpace::ScanTree> tree_;
    Bodies bodies_;
    std::vector<std::int64_t> chains_begin_;
    dca::AlignedNumbers constants_;
};

}  // namespace catena
