// Implicit springs and dampers of joints in joint coordinates, in any Space.
#pragma once

#include "dynamics/body_loads.hpp"
#include "dynamics/joint/moved_bodies.hpp"

namespace catena {

/// Springs K and dampers C that act implicitly within a step of length h. With B = c h^2 K + h C /
/// 2 (c: rotor_of_spring()), the joint obeys P^T phi = tau - B u'. The joint's force then is
/// unknown along every direction, and its two sides accelerate relative to each other by u' = B^-1
/// (tau - P^T phi).
struct ImplicitJoints {
    /// B / K = c h^2, and B / C = h / 2.
    double of_stiffness = 0, of_damping = 0;
    /// True for joint k if it is implicit; null if no joint is.
    std::uint8_t const* joint = nullptr;
    /// Compliance P B^-1 P^T along the last three directions of the joint's handles.
    View<6> compliance;
    /// Acceleration P B^-1 tau, along the same directions.
    View<3> yielding;
    /// Velocities at the step's start, on which dampers act; B covers what the step adds to them.
    View<3> start;

    /// True if joint k is implicit.
    CATENA_HD bool has(std::int64_t k) const { return joint && joint[k] != 0; }
    /// False for several bodies side by side, because implicit joints are never placed there.
    template <dca::SeveralBodies Place>
    CATENA_HD bool has(Place const&) const {
        return false;
    }

    /// Inertia B along coordinate i of joint k.
    CATENA_HD double inertia(BodyLoadsView const& given, std::int64_t k, int i) const {
        double const stiffness = given.springs ? given.stiffness.at(k, i) : 0,
                     damping = given.dampers ? given.damping.at(k, i) : 0;
        return fused(of_stiffness, stiffness, of_damping * damping);
    }
    /// Sets compliance and acceleration of implicit joint k from the torque along its coordinates.
    CATENA_HD void set(MovedBodies const& moved, BodyLoadsView const& given, std::int64_t k,
                       Vec3 const& torque_along) const {
        Mat3 motions;
        int const count = moved.free_motions(k, motions);
        Vec3 along = torque_along, b = Vec3::zero();
        for (int i = 0; i < count; ++i) b[i] = inertia(given, k, i);
        // The springs' part of B is the inertia of a rotor in the axes of the outboard body, which
        // has a gyroscopic torque.
        if (is_ball(moved.joints().joint[k]) && given.springs) {
            Vec3 const qd = moved.scan.state.qd.load(k), stiffness = given.stiffness.load(k);
            Vec3 momentum;
            for (int i = 0; i < 3; ++i) momentum[i] = of_stiffness * stiffness[i] * qd[i];
            along = along - cross(qd, momentum);
        }
        auto yields_by = Symmetric<double, 3>::zero();
        Vec3 acceleration = Vec3::zero();
        for (int i = 0; i < count; ++i) {
            Vec3 const p = motions.column(i);
            double const yields = 1 / b[i];
            acceleration = plus_scaled(acceleration, yields * along[i], p);
            for (int r = 0; r < 3; ++r)
                for (int c = 0; c <= r; ++c)
                    yields_by(r, c) = fused(yields * p[r], p[c], yields_by(r, c));
        }
        Vector<double, 6> numbers;
        for (int i = 0; i < 6; ++i) numbers[i] = yields_by.data[i];
        compliance.store(k, numbers);
        yielding.store(k, acceleration);
    }
};
/// Adds an acceleration of an implicit joint to the numbers along its directions, of which it has
/// the last three.
CATENA_HD void add_yielding(Vector<double, 6>& b, Vec3 const& yielding) {
    for (int i = 0; i < 3; ++i) b[3 + i] += yielding[i];
}

}  // namespace catena
