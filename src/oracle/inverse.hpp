// Recursive Newton-Euler inverse dynamics in ground axes (Featherstone 2008, section 5.3). Internal
// to the oracles.
#pragma once

#include <algorithm>

#include "joints/joint_models.hpp"
#include "oracle/joint.hpp"

namespace catena::oracle {

/// Moment or force balance: the sum of its terms and the largest norm among them.
template <class S>
struct Balance {
    V3<S> sum = V3<S>::zero();
    S largest = S(0);
    void add(V3<S> const& term) {
        sum = sum + term;
        largest = std::max(largest, norm(term));
    }
};

/// Motion of a body and balances at its inboard joint, in W.
template <class S>
struct InverseBody {
    /// Angular velocity and acceleration, and acceleration of the centre of mass.
    V3<S> omega, alpha, com_acceleration;
    /// Vectors from the body's origin to its centre of mass, and from the inboard body's origin to
    /// its own.
    V3<S> to_com, from_inboard;
    /// Balances of the force and torque through the inboard joint, about the joint's centre.
    Balance<S> force, torque;
};

/// Inverse dynamics of a chain at a given state.
template <class S>
class Inverse {
  public:
    Inverse(std::vector<Link<S>> const& links, V3<S> const& gravity)
        : links_(links), attitude_(attitudes(links)), gravity_(gravity) {}

    /// Returns the joint wrenches required by the accelerations. `qdd` and `base_acceleration` are
    /// as in OracleResult.
    std::vector<InverseBody<S>> operator()(std::vector<V3<S>> const& qdd,
                                           V3<S> const& base_acceleration) const {
        std::vector<InverseBody<S>> bodies(links_.size());
        forward(qdd, base_acceleration, bodies);
        for (std::size_t k = links_.size(); k-- > 0;) backward(k, bodies);
        return bodies;
    }

    /// Sets wrenches at the centres of mass of the last and the first body, in addition to their
    /// loads, W. They represent a jointed tip.
    void push_ends(SpatialForce<S> const& last, SpatialForce<S> const& first) {
        pushed_ = last;
        pushed_first_ = first;
    }

    /// Returns the components in body k's axes of a vector given in W.
    V3<S> in_body(std::size_t k, V3<S> const& v) const {
        return transposed_times(attitude_[k].orientation, v);
    }
    /// Efforts along the coordinates of joint k that the accelerations require.
    V3<S> needed(std::size_t k, InverseBody<S> const& b) const {
        return efforts(links_[k],
                       SpatialForce<S>{in_body(k, b.torque.sum), in_body(k, b.force.sum)});
    }

  private:
    /// Outward recursion: velocities and accelerations.
    void forward(std::vector<V3<S>> const& qdd, V3<S> const& base_acceleration,
                 std::vector<InverseBody<S>>& bodies) const {
        // Accelerations of the bodies' origins.
        std::vector<V3<S>> of_origin(links_.size());
        for (std::size_t k = 0; k < links_.size(); ++k) {
            Link<S> const& link = links_[k];
            InverseBody<S>& b = bodies[k];
            M3<S> const& r = attitude_[k].orientation;
            // Motion of the inboard body.
            M3<S> inboard = M3<S>::identity();
            V3<S> omega = V3<S>::zero(), alpha = omega, linear = omega;
            if (!link.on_ground()) {
                inboard = attitude_[link.before()].orientation;
                omega = bodies[link.before()].omega;
                alpha = bodies[link.before()].alpha;
                linear = of_origin[link.before()];
            }
            b.from_inboard = inboard * link.translation;  // includes the joint's displacement
            linear =
                linear + cross(alpha, b.from_inboard) + cross(omega, cross(omega, b.from_inboard));
            if (floats(link.type)) linear = base_acceleration;
            Motion<S> const relative = along(link, qdd[k]);
            if (!floats(link.type))
                linear = linear + S(2) * cross(omega, r * link.slide) + r * relative.linear;
            alpha = alpha + r * (relative.angular + link.drift) + cross(omega, r * link.rate);
            omega = r * attitude_[k].omega;
            of_origin[k] = linear;
            b.omega = omega;
            b.alpha = alpha;
            b.to_com = r * link.com;
            b.com_acceleration =
                linear + cross(alpha, b.to_com) + cross(omega, cross(omega, b.to_com));
        }
    }

    /// Inward recursion: balances of body k and everything outboard of it.
    void backward(std::size_t k, std::vector<InverseBody<S>>& bodies) const {
        InverseBody<S>& b = bodies[k];
        Link<S> const& link = links_[k];
        M3<S> const& r = attitude_[k].orientation;
        V3<S> const inertial = link.mass * b.com_acceleration, weight = link.mass * gravity_;
        b.force.add(inertial);
        b.force.add(-weight);
        b.force.add(-link.applied_force);
        b.torque.add(r * (link.inertia * in_body(k, b.alpha)));
        b.torque.add(cross(b.omega, r * (link.inertia * in_body(k, b.omega))));
        b.torque.add(cross(b.to_com, inertial));
        b.torque.add(-cross(b.to_com, weight + link.applied_force));
        b.torque.add(-link.applied_torque);
        if (k == 0) add_push(b, pushed_first_);
        if (k + 1 == bodies.size()) add_push(b, pushed_);
        if (!link.on_ground()) hand_inboard(b, bodies[link.before()]);
    }

    /// Adds the reaction to the wrench through a body's inboard joint to the inboard body.
    static void hand_inboard(InverseBody<S> const& b, InverseBody<S>& inboard) {
        inboard.force.add(b.force.sum);
        inboard.torque.add(b.torque.sum);
        inboard.torque.add(cross(b.from_inboard, b.force.sum));
    }

    /// Subtracts a wrench at the centre of mass from the balances.
    static void add_push(InverseBody<S>& b, SpatialForce<S> const& wrench) {
        b.force.add(-wrench.force);
        b.torque.add(-wrench.torque - cross(b.to_com, wrench.force));
    }

    std::vector<Link<S>> const& links_;
    std::vector<Attitude<S>> attitude_;
    V3<S> gravity_;
    /// Wrenches of push_ends() on the last and the first body.
    SpatialForce<S> pushed_, pushed_first_;
};

}  // namespace catena::oracle
