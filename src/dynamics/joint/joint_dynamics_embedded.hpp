// Members of JointDynamicsIn for steps of an embedded Runge-Kutta pair. Included by
// joint_dynamics_in.hpp.
#pragma once

#include "dynamics/joint/joint_dynamics_in.hpp"

namespace catena {

template <class Space>
void JointDynamicsIn<Space>::embedded_stage(int stage, InnerStep const& step) {
    if (!pair_) pair_.emplace(group_);
    if (stage == 0 && !step.again) start_time_ = time_;
    EmbeddedStage s{stage,
                    step.again && stage == 0,
                    {},
                    start_time_ + DormandPrince::time[stage] * step.length};
    if (DormandPrince::time[stage] == 1) s.time = step.end;
    for (int i = 0; i <= stage; ++i) s.weight[i] = DormandPrince::weight[stage][i] * step.length;
    needs_positions_ ? embedded_stage<true>(s) : embedded_stage<false>(s);
    time_ = s.time;
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
double JointDynamicsIn<Space>::embedded_error(double length, AllowedErrors const& allowed) {
    EmbeddedDifference d;
    for (int i = 0; i <= DormandPrince::stages; ++i)
        d.weight[i] = DormandPrince::difference[i] * length;
    return space_.largest(group_.size,
                          [s = embedded(), d, allowed] CATENA_LAMBDA(std::int64_t k) -> double {
                              return s.error(k, d, allowed);
                          });
}

}  // namespace catena
