// Members of JointDynamicsIn for the operators of a step. Included by joint_dynamics_in.hpp.
#pragma once

#include "dynamics/joint/joint_dynamics_in.hpp"

namespace catena {

template <class Space>
void JointDynamicsIn<Space>::apply(JointOperation const& op, double h) {
    double const duration = h / op.divisor;
    switch (op.what) {
        case JointOperator::evaluate:
        case JointOperator::evaluate_again:
            throw std::logic_error("evaluations are not operators of JointDynamics");
        case JointOperator::save:
            return set_rates(saved());
        case JointOperator::kick:
        case JointOperator::kick_saved:
            return kick(duration, op.what == JointOperator::kick_saved);
        case JointOperator::kick_mean:
            return kick_mean(duration);
        case JointOperator::drift:
            needs_positions_ ? drift<true>(duration) : drift<false>(duration);
            time_ += duration;
            return;
        case JointOperator::drift_saved:
            needs_positions_ ? drift_saved<true>(duration) : drift_saved<false>(duration);
            time_ += duration;
            return;
        case JointOperator::noise:
            return thermalise(op.thermostat, op.number);
        case JointOperator::accumulate: {
            if (op.first) start_time_ = time_;
            double const next = h / op.next;
            WeightedStage const s{op.first, op.last, duration, next, start_time_ + next};
            needs_positions_ ? accumulate<true>(s) : accumulate<false>(s);
            time_ = s.time;
        }
    }
}

}  // namespace catena
