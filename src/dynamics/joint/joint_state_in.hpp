// State of a group's bodies in joint coordinates in any Space, with what steps keep of it.
#pragma once

#include <optional>

#include "dynamics/joint/embedded_steps.hpp"

namespace catena {

/// Second derivatives of coordinates in a Space.
template <class Space>
struct JointRatesIn {
    typename Space::template FieldOf<3> qdd, base_acceleration;

    explicit JointRatesIn(ChainGroup const& group)
        : qdd(group.size), base_acceleration(std::ssize(group.pieces)) {}
    RatesView view() { return {qdd.view(), base_acceleration.view()}; }
    JointRates read(Space const& space) const {
        return {space.read(qdd), space.read(base_acceleration)};
    }
    void set(Space const& space, JointRates const& rates) {
        fill(space, qdd, rates.qdd);
        fill(space, base_acceleration, rates.base_acceleration);
    }
};

/// The state, and what the operators of a step keep of it.
template <class Space>
struct JointStateIn {
    JointStateIn(ChainGroup const& group, JointClock& clock_of_group)
        : now(group), start(group), sum(group), rates(group), saved(group), clock(clock_of_group) {}

    JointState read(Space const& space) const {
        JointState s;
        s.q = space.read(now.q);
        s.qd = space.read(now.qd);
        s.base_position = space.read(now.base_position);
        s.base_velocity = space.read(now.base_velocity);
        return s;
    }
    void set(Space const& space, JointState const& s) {
        fill(space, now.q, s.q);
        fill(space, now.qd, s.qd);
        fill(space, now.base_position, s.base_position);
        fill(space, now.base_velocity, s.base_velocity);
    }

    /// State, state at the step's start, and weighted sum of its rates (accumulate).
    JointCoordinates<Space> now, start, sum;
    /// Rates that JointOperator::set_rates and JointOperator::save have computed.
    JointRatesIn<Space> rates, saved;
    /// Rates of the stages of an embedded pair; allocated if there is one.
    std::optional<EmbeddedRates<Space>> pair;
    JointClock& clock;
};

}  // namespace catena
