// Which launches a sweep takes over a tree's stages, whoever makes them.
#pragma once

#include <cstddef>

#include "cuda/stage_kernels.cuh"

namespace catena::cuda {

/// `Launches`: stages(), runs_apart() and together() of a tree (StagePlan, StageSizes); climb(i, sweep), descend(i, sweep) and
/// turn(i, sweep) of stage i, with the next one where together(); climb_runs(sweep) and descend_runs(sweep).
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
    template <class Sweep>
    void turn_stages(Sweep const& sweep) const {
        if constexpr (kernels::goes_twice<Sweep>) {
            climb_stages(launches_.stages(), sweep.matrices());
            turn_stages(sweep.biases());
        } else {
            std::size_t const apart = launches_.stages() - (launches_.together() ? 2 : 1);
            climb_stages(apart, sweep);
            launches_.turn(apart, sweep);
            descend_stages(apart, sweep);
        }
    }
    /// Of the first `stages` stages.
    template <class Sweep>
    void climb_stages(std::size_t stages, Sweep const& sweep) const {
        if constexpr (kernels::goes_twice<Sweep>) {
            climb_stages(stages, sweep.matrices());
            climb_stages(stages, sweep.biases());
        } else {
            for (std::size_t i = 0; i < stages; ++i) launches_.climb(i, sweep);
        }
    }
    template <class Sweep>
    void descend_stages(std::size_t stages, Sweep const& sweep) const {
        if constexpr (kernels::goes_twice<Sweep>)
            descend_stages(stages, sweep.biases());
        else
            for (std::size_t i = stages; i-- > 0;) launches_.descend(i, sweep);
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
