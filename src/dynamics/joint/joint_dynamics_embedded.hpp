// Members of JointDynamicsIn for steps of an embedded Runge-Kutta pair. Included by
// joint_dynamics_in.hpp.
#pragma once

#include "dynamics/joint/joint_dynamics_in.hpp"

namespace catena {

template <class Space>
void JointDynamicsIn<Space>::apply(EmbeddedStage const& stage) {
    if (!pair_) pair_.emplace(group_);
    needs_positions_ ? embedded_stage<true>(stage) : embedded_stage<false>(stage);
    time_ = stage.time;
}
template <class Space>
template <bool positions>
void JointDynamicsIn<Space>::embedded_stage(EmbeddedStage const& stage) {
    EmbeddedSteps const s = embedded();
    each_body<positions>(
        [&](JointLoops const& loops, auto... bodies) { loops.embedded_stage(s, stage, bodies...); },
        [s, stage] CATENA_LAMBDA(std::int64_t k) { s.template advance<positions>(k, stage); });
    relative_ = !s.steps.chains.left.motions;
}

template <class Space>
double JointDynamicsIn<Space>::stage_divergence(double length) {
    return space_.largest(group_.size,
                          [s = embedded(), length] CATENA_LAMBDA(std::int64_t k) -> double {
                              return s.stage_divergence(k, length);
                          });
}

template <class Space>
Speeds JointDynamicsIn<Space>::fastest() {
    auto const of = [&](bool angular) {
        return space_.largest(group_.size,
                              [s = embedded(), angular] CATENA_LAMBDA(std::int64_t k) -> double {
                                  return s.speed(k, angular);
                              });
    };
    return {of(true), of(false)};
}

template <class Space>
double JointDynamicsIn<Space>::embedded_error(EmbeddedDifference const& d,
                                              AllowedErrors const& allowed) {
    return space_.largest(group_.size,
                          [s = embedded(), d, allowed] CATENA_LAMBDA(std::int64_t k) -> double {
                              return s.error(k, d, allowed);
                          });
}

}  // namespace catena
