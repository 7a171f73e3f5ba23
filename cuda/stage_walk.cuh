// Which launches a sweep takes over a tree's stages, whoever makes them.
#pragma once

#include <cstddef>

#include "cuda/stage_kernels.cuh"

namespace catena::cuda {

/// `Launches`: stages() and runs_apart() of a tree (StagePlan), takes_runs(i), whether stage i does; climb(i, sweep), descend(i, sweep) and
/// turn(i, sweep) of stage i, turn_together(sweep) of the last two where together(sweep); climb_runs(sweep) and descend_runs(sweep).
template <class Launches>
class StageWalk {
  public:
    explicit StageWalk(Launches const& launches) : launches_(launches) {}
    template <class Sweep>
    void climb(Sweep const& sweep) const {
        climb_runs(sweep);
        climb_stages(launches_.stages(), sweep);
    }
    template <class Sweep>
    void descend(Sweep const& sweep) const {
        descend_stages(launches_.stages(), sweep);
        descend_runs(sweep);
    }
    /// Precondition: there are stages.
    template <class Sweep>
    void climb_and_descend(Sweep const& sweep) const {
        climb_runs(sweep);
        turn_stages(sweep);
        descend_runs(sweep);
    }

  private:
    // Where merges go by teams, a stage with runs is for the sweep's two sweeps one after the other: a thread finds no registers for runs'
    // segments and biases at once.
    template <class Sweep>
    void turn_stages(Sweep const& sweep) const {
        bool const together = launches_.together(sweep);
        std::size_t const apart = launches_.stages() - (together ? 2 : 1);
        if constexpr (kernels::merges_by_teams<Sweep>)
            if (launches_.takes_runs(apart)) {
                climb_stages(launches_.stages(), sweep.matrices());
                return turn_stages(sweep.biases());
            }
        climb_stages(apart, sweep);
        if (together)
            launches_.turn_together(sweep);
        else
            launches_.turn(apart, sweep);
        descend_stages(apart, sweep);
    }
    /// Of the first `stages` stages.
    template <class Sweep>
    void climb_stages(std::size_t stages, Sweep const& sweep) const {
        for (std::size_t i = 0; i < stages; ++i) climb_stage(i, sweep);
    }
    template <class Sweep>
    void climb_stage(std::size_t i, Sweep const& sweep) const {
        if constexpr (kernels::merges_by_teams<Sweep>)
            if (launches_.takes_runs(i)) {
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
            if (launches_.takes_runs(i)) return launches_.descend(i, sweep.biases());
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
