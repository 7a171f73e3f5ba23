// Which launches a sweep takes over a tree's stages, whoever makes them.
#pragma once

#include <cstddef>

#include "cuda/sweeps/frontier_launch.hpp"
#include "cuda/sweeps/group_lanes.cuh"
#include "cuda/sweeps/stage_kernels.cuh"

namespace catena::cuda {

/// `Launches`: stages() and runs_apart() of a tree (StagePlan), whether its last stage gathers(),
/// blocks(i) of stage i and whether it takes_runs(i); climb(i, sweep) and descend(i, sweep) of
/// stage i; turn(i, sweep) or turn(i, sweep, exchange, top) of stage i and the one after it, if
/// any, where can_turn() says so; climb_runs(sweep) and descend_runs(sweep). It can turn the last
/// stage alone. Groups of runs (run_groups.hpp): climb_groups(sweep) and descend_groups(sweep), in
/// the place of the runs' where there are stages_above_groups(); where it can_turn_groups<Sweep>(),
/// turn_groups(sweep) between these stands for all stages.
template <class Launches>
class StageWalk {
  public:
    explicit StageWalk(Launches const& launches) : launches_(launches) {}
    template <class Sweep>
    void climb(Sweep const& sweep) const {
        climb_runs(sweep);
        climb_stages(working_stages(), sweep);
    }
    template <class Sweep>
    void descend(Sweep const& sweep) const {
        descend_stages(working_stages(), sweep);
        descend_runs(sweep);
    }
    /// Precondition: there are stages.
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
    /// The same with what ranks show each other and the `top` that they share, if one launch turns
    /// it with the last stages; else nothing is done.
    template <class Sweep, class Exchange>
    bool turn_shared(Sweep const& sweep, Exchange const& exchange, Launches const& top) const {
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
    /// Without one that gathers, which has nothing to do alone.
    std::size_t working_stages() const {
        return launches_.stages() - (launches_.gathers() ? 1 : 0);
    }
    /// Where merges go by teams, a stage with runs is for the sweep's two sweeps one after the
    /// other: a thread finds no registers for runs' segments and biases at once.
    template <class Sweep>
    bool goes_apart(std::size_t stage) const {
        return kernels::merges_by_teams<Sweep> && launches_.takes_runs(stage);
    }
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
    template <class Sweep, class... Shared>
    void turn_from(std::size_t first, Sweep const& sweep, Shared const&... exchange_and_top) const {
        climb_stages(first, sweep);
        launches_.turn(first, sweep, exchange_and_top...);
        descend_stages(first, sweep);
    }
    /// Of the first `stages` stages.
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
        if constexpr (kernels::by_groups<Sweep>)
            if (launches_.stages_above_groups()) return launches_.climb_groups(sweep);
        if (launches_.runs_apart()) launches_.climb_runs(sweep);
    }
    template <class Sweep>
    void descend_runs(Sweep const& sweep) const {
        if constexpr (kernels::by_groups<Sweep>)
            if (launches_.stages_above_groups()) return launches_.descend_groups(sweep);
        if (launches_.runs_apart()) launches_.descend_runs(sweep);
    }

    Launches launches_;
};

}  // namespace catena::cuda
