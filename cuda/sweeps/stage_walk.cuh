// Order of the launches of a sweep over a tree's stages, independent of how a launch is made.
// DeviceTree makes them on a GPU; tests make them on the host.
#pragma once

#include <cstddef>

#include "cuda/sweeps/frontier_launch.hpp"
#include "cuda/sweeps/group_lanes.cuh"
#include "cuda/sweeps/stage_kernels.cuh"

namespace catena::cuda {

/// Performs the passes of a sweep by calls of `Launches`, which has these members.
/// - stages(), runs_apart(): number of stages, and whether runs precede them in launches of their
///   own (dca::StagePlan).
/// - gathers(): true if the last stage only gathers segments for other ranks.
/// - blocks(i), takes_runs(i): blocks of stage i, and whether its items are runs.
/// - climb(i, sweep), descend(i, sweep): inward and outward pass of stage i.
/// - both_passes(i, sweep), both_passes(i, sweep, exchange, top): both passes of stage i and the
/// stage above it,
///   if any. The call requires can_turn() with the same arguments; for the last stage alone it is
///   always true.
/// - climb_runs(sweep), descend_runs(sweep): passes of the runs.
/// - climb_groups(sweep), descend_groups(sweep): passes of the runs and of the levels within groups
///   of runs (run_groups.hpp), if can_turn_groups<Sweep>().
/// - turn_groups(sweep): both passes of everything above the groups, if can_turn_groups<Sweep>().
template <class Launches>
class StageWalk {
  public:
    explicit StageWalk(Launches const& launches) : launches_(launches) {}
    /// Performs the inward pass of all runs and stages.
    template <class Sweep>
    void climb(Sweep const& sweep) const {
        climb_runs(sweep);
        climb_stages(working_stages(), sweep);
    }
    /// Performs the outward pass of all stages and runs.
    template <class Sweep>
    void descend(Sweep const& sweep) const {
        descend_stages(working_stages(), sweep);
        descend_runs(sweep);
    }
    /// Performs both passes with as few launches as possible. Precondition: there are stages.
    template <class Sweep>
    void climb_and_descend(Sweep const& sweep) const {
        if constexpr (kernels::turns_groups<Sweep>)
            if (launches_.template can_turn_groups<Sweep>()) {
                launches_.climb_groups(sweep);
                launches_.turn_groups(sweep);
                return launches_.descend_groups(sweep);
            }
        climb_runs(sweep);
        turn_stages(sweep);
        descend_runs(sweep);
    }
    /// Performs both passes with an exchange between ranks and the `top` tree that they share. One
    /// launch must contain the last stages, the exchange and the top; otherwise the call does
    /// nothing and returns false.
    template <class Sweep, class Exchange>
    bool shared_passes(Sweep const& sweep, Exchange const& exchange, Launches const& top) const {
        if (!turns_in_a_block(launches_, top)) return false;
        std::size_t const stages = launches_.stages();
        for (std::size_t const turned : {std::size_t{2}, std::size_t{1}})
            if (stages >= turned && !goes_apart<Sweep>(stages - turned) &&
                launches_.can_turn(stages - turned, sweep, exchange, top)) {
                climb_runs(sweep);
                turn_from(stages - turned, sweep, exchange, top);
                descend_runs(sweep);
                return true;
            }
        return false;
    }

  private:
    /// Number of stages that work in launches of their own; a stage that only gathers is not one of
    /// them.
    std::size_t working_stages() const {
        return launches_.stages() - (launches_.gathers() ? 1 : 0);
    }
    /// True if the stage's matrices and biases need launches of their own. That is so for stages
    /// with runs if teams merge segments. A thread then lacks registers for the runs' matrices and
    /// biases together.
    template <class Sweep>
    bool goes_apart(std::size_t stage) const {
        return kernels::merges_by_teams<Sweep> && launches_.takes_runs(stage);
    }
    /// Performs both passes of all stages.
    template <class Sweep>
    void turn_stages(Sweep const& sweep) const {
        std::size_t const stages = launches_.stages(),
                          first = stages >= 2 && launches_.can_turn(stages - 2, sweep) ? stages - 2
                                                                                       : stages - 1;
        if constexpr (kernels::merges_by_teams<Sweep>)
            if (goes_apart<Sweep>(first)) {
                climb_stages(stages, sweep.matrices());
                return turn_stages(sweep.biases());
            }
        turn_from(first, sweep);
    }
    /// Performs both passes of all stages, those from `first` on in one launch.
    template <class Sweep, class... Shared>
    void turn_from(std::size_t first, Sweep const& sweep, Shared const&... exchange_and_top) const {
        climb_stages(first, sweep);
        launches_.both_passes(first, sweep, exchange_and_top...);
        descend_stages(first, sweep);
    }
    /// Performs the inward pass of the first `stages` stages.
    template <class Sweep>
    void climb_stages(std::size_t stages, Sweep const& sweep) const {
        for (std::size_t i = 0; i < stages; ++i) climb_stage(i, sweep);
    }
    template <class Sweep>
    void climb_stage(std::size_t i, Sweep const& sweep) const {
        if constexpr (kernels::merges_by_teams<Sweep>)
            if (goes_apart<Sweep>(i)) {
                launches_.climb(i, sweep.matrices());
                return launches_.climb(i, sweep.biases());
            }
        launches_.climb(i, sweep);
    }
    /// Performs the outward pass of the first `stages` stages.
    template <class Sweep>
    void descend_stages(std::size_t stages, Sweep const& sweep) const {
        for (std::size_t i = stages; i-- > 0;) descend_stage(i, sweep);
    }
    template <class Sweep>
    void descend_stage(std::size_t i, Sweep const& sweep) const {
        if constexpr (kernels::merges_by_teams<Sweep>)
            if (goes_apart<Sweep>(i)) return launches_.descend(i, sweep.biases());
        launches_.descend(i, sweep);
    }
    template <class Sweep>
    void climb_runs(Sweep const& sweep) const {
        if (launches_.runs_apart()) launches_.climb_runs(sweep);
    }
    template <class Sweep>
    void descend_runs(Sweep const& sweep) const {
        if (launches_.runs_apart()) launches_.descend_runs(sweep);
    }

    Launches launches_;
};

}  // namespace catena::cuda
