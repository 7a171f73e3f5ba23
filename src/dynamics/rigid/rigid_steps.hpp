// Parts of a step of rigid bodies in absolute coordinates, and of an evaluation of their
// accelerations, in any Space. Ground axes are W, body axes are B.
#pragma once

#include <cmath>

#include "dynamics/constrained_step.hpp"
#include "dynamics/rigid/rigid_joints.hpp"
#include "math/philox.hpp"

namespace catena {

/// Parameters of one of the sweeps that close the joints at a drift's end.
struct DriftSweep {
    double time = 0;  // Duration of the drift.
    bool first = false, last = false;
};

/// Thermostat, and the streams of its noise for linear and angular velocities.
struct RigidNoise {
    Thermostat thermostat;
    std::uint64_t step = 0;
    NoiseStage linear = NoiseStage::start, angular = NoiseStage::start_angular;
    /// True in the middle of drifts. Elsewhere, at whole steps, rotors have half the variance
    /// (JointRotors::add_noise).
    bool between_drifts = false;
};

/// Arrays that the solver reads and writes in a bias sweep, with the operations of a step and of an
/// evaluation on one body.
struct RigidSteps {
    RigidJoints joints;
    ConstView<3> force, torque;  // RigidLoads::force and RigidLoads::torque.
    /// Velocities of the last observe().
    ConstView<3> observed_velocity, observed_omega;
    /// Linear (W) and angular momenta (B). For accelerations, `moment` is the torque less the
    /// gyroscopic torque.
    View<3> momentum, moment;
    /// Accelerations, or a sweep's corrections of velocities.
    View<3> acceleration, alpha;

    /// Computes the momenta after a kick of duration h, the right-hand side of a projection.
    CATENA_HD void set_momenta(std::int64_t k, double h) const {
        RigidModel const& model = joints.model;
        RigidState const& state = joints.state;
        momentum.store(k,
                       plus_scaled(model.mass.at(k, 0) * state.velocity.load(k), h, force.load(k)));
        moment.store(k, plus_scaled(as_symmetric(model.inertia.load(k)) * state.omega.load(k), h,
                                    torque.load(k)));
        if (joints.rotors.implicit) joints.rotors.set_kick(joints.bias, k, h);
    }
    /// Free flight from the drift's start, with the corrections of the previous sweep added to the
    /// velocities there. The last sweep stores the new pose.
    CATENA_HD void fly(std::int64_t k, DriftSweep const& sweep) const {
        RigidState const& state = joints.state;
        Vec3 v = state.velocity.load(k);
        RotorState turning{as_quaternion(state.orientation.load(k)), state.omega.load(k)};
        if (!sweep.first) {
            v = v + acceleration.load(k);
            turning.omega = turning.omega + alpha.load(k);
            state.velocity.store(k, v);
            if (!sweep.last) state.omega.store(k, turning.omega);
        }
        Vec3 const x = plus_scaled(state.position.load(k), sweep.time, v);
        if (!joints.model.is_bead(k))
            turning = free_rotor(joints.model.principal_frame(k), turning, sweep.time);
        if (!sweep.last) {
            if (joints.rotors.implicit)
                joints.rotors.flown.store(k, as_vector(turning.orientation));
            return joints.set_ends(k, x, to_matrix(turning.orientation));
        }
        state.position.store(k, x);
        state.orientation.store(k, as_vector(turning.orientation));
        state.omega.store(k, turning.omega);
    }
    /// Mixes the velocities of body k with the thermostat's noise.
    CATENA_HD void add_noise(std::int64_t k, RigidNoise const& n) const {
        RigidModel const& model = joints.model;
        RigidState const& state = joints.state;
        std::uint64_t const body = model.piece_of(k).body_of(k);
        Thermostat const& t = n.thermostat;
        Vec3 const noise = normal3(t.seed, n.step, body, n.linear);
        state.velocity.store(k,
                             plus_scaled(t.keep * state.velocity.load(k),
                                         t.spread * std::sqrt(model.inverse_mass.at(k, 0)), noise));
        joints.rotors.add_noise(k, t, n.step, body, n.between_drifts);
        if (model.is_bead(k)) return;
        Vec3 const moments = model.principal_moment.load(k);
        Vec3 turning = normal3(t.seed, n.step, body, n.angular);
        for (int i = 0; i < 3; ++i) turning[i] *= t.spread / std::sqrt(moments[i]);
        state.omega.store(k, t.keep * state.omega.load(k) +
                                 to_matrix(as_quaternion(model.principal_axes.load(k))) * turning);
    }

    // Evaluation of accelerations at the last observed velocities.

    /// Observed velocity of the point of body k at r (B) from its centre, W.
    CATENA_HD Vec3 velocity_of(std::int64_t k, Vec3 const& r) const {
        return observed_velocity.load(k) + joints.state.axes(k) * cross(observed_omega.load(k), r);
    }
    /// Sets the torque less the gyroscopic torque of body k; on links, also the velocities of its
    /// handles.
    CATENA_HD void set_moment(std::int64_t k) const {
        RigidModel const& model = joints.model;
        Vec3 const w = observed_omega.load(k);
        moment.store(k, torque.load(k) - cross(w, as_symmetric(model.inertia.load(k)) * w));
        if (!model.linked) return;
        joints.handles.inboard.store(k, velocity_of(k, model.r1.load(k)));
        joints.handles.outboard.store(k, velocity_of(k, model.r2.load(k)));
    }
};

}  // namespace catena
