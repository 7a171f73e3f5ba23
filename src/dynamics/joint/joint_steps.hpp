// Integration steps and corrections of the coordinates of one body, in any Space. A body on a free
// base updates its base as well.
#pragma once

#include "dynamics/joint/joint_chains.hpp"

namespace catena {

/// One of the four stages: the sum grows by `weight` times the rates. The state becomes the start
/// plus `next` times the rates, or in the last stage the sum.
struct WeightedStage {
    bool first = false, last = false;
    /// Weights in ps, and the time of the resulting state.
    double weight = 0, next = 0, time = 0;
};

/// State arrays of a step, with the operations on one body.
struct JointSteps {
    JointChains chains;
    StateView start, sum;
    /// Accelerations that JointOperator::save has kept.
    RatesView saved;

    /// Time derivative of a unit quaternion q at angular velocity omega (body axes).
    template <class Real>
    CATENA_HD static Vector<Real, 4> rate_of_quaternion(Quaternion<Real> const& q,
                                                        Vector<Real, 3> const& omega) {
        Quaternion<Real> const r = q * Quaternion<Real>{Real(0), omega[0], omega[1], omega[2]};
        Real const half(0.5);
        return {{half * r.w, half * r.x, half * r.y, half * r.z}};
    }

    /// Stage with a weighted sum of rates, for body k.
    template <bool positions, class Place>
    CATENA_HD void accumulate(Place k, WeightedStage const& s) const {
        using Real = RealAt<Place>;
        using Coordinates = Vector<Real, 4>;
        StateView const& state = chains.moved.scan.state;
        JointsView const& joints = chains.moved.joints();
        Real const weight(s.weight), next(s.next);
        Vec3At<Place> const qdd = chains.rate(k), qd = read(state.qd, k);
        Coordinates const q = read(state.q, k);
        Coordinates const rate = joints.has_quaternion(k)
                                     ? rate_of_quaternion(as_quaternion(q), qd)
                                     : Coordinates{{qd[0], qd[1], qd[2], Real(0)}};
        Coordinates total = plus_scaled(s.first ? q : read(sum.q, k), weight, rate);
        Vec3At<Place> const total_rate = plus_scaled(s.first ? qd : read(sum.qd, k), weight, qdd);
        if (s.last) {
            if (joints.has_quaternion(k)) total = as_vector(normalized(as_quaternion(total)));
            write(state.q, k, total);
            write(state.qd, k, total_rate);
        } else {
            write(sum.q, k, total);
            write(sum.qd, k, total_rate);
            write(state.q, k, plus_scaled(s.first ? q : read(start.q, k), next, rate));
            write(state.qd, k, plus_scaled(s.first ? qd : read(start.qd, k), next, qdd));
            if (s.first) {
                write(start.q, k, q);
                write(start.qd, k, qd);
            }
        }
        if constexpr (is_one_body<Place>) {
            if (chains.on_free_base(k)) accumulate_base(joints.piece_of(k), chains.base_rate(k), s);
            joints.follow_course(state, k, s.time);
        }
        if (!chains.left.motions) chains.template set_relative<positions>(k);
    }
    /// Version for the free base of a piece.
    CATENA_HD void accumulate_base(std::int64_t piece, Vec3 const& acceleration,
                                   WeightedStage const& s) const {
        StateView const& state = chains.moved.scan.state;
        Vec3 const x = state.base_position.load(piece), v = state.base_velocity.load(piece);
        Vec3 const total = plus_scaled(s.first ? x : sum.base_position.load(piece), s.weight, v);
        Vec3 const total_rate =
            plus_scaled(s.first ? v : sum.base_velocity.load(piece), s.weight, acceleration);
        if (s.last) {
            state.base_position.store(piece, total);
            state.base_velocity.store(piece, total_rate);
            return;
        }
        sum.base_position.store(piece, total);
        sum.base_velocity.store(piece, total_rate);
        state.base_position.store(
            piece, plus_scaled(s.first ? x : start.base_position.load(piece), s.next, v));
        state.base_velocity.store(piece, plus_scaled(s.first ? v : start.base_velocity.load(piece),
                                                     s.next, acceleration));
        if (s.first) {
            start.base_position.store(piece, x);
            start.base_velocity.store(piece, v);
        }
    }

    /// Drift with the saved accelerations: coordinates after h, and a first guess of velocities.
    /// Prescribed motions are set to `time`.
    template <bool positions>
    CATENA_HD void drift_saved(std::int64_t k, double h, double time) const {
        StateView const& state = chains.moved.scan.state;
        Vec3 const qd = state.qd.load(k), qdd = saved.qdd.load(k);
        turn_by(k, plus_scaled(h * qd, 0.5 * h * h, qdd), true);
        start.qd.store(k, qd);
        state.qd.store(k, plus_scaled(qd, h, qdd));
        if (chains.on_free_base(k)) {
            std::int64_t const p = chains.moved.joints().piece_of(k);
            Vec3 const v = state.base_velocity.load(p), a = saved.base_acceleration.load(p);
            state.base_position.store(
                p, state.base_position.load(p) + plus_scaled(h * v, 0.5 * h * h, a));
            start.base_velocity.store(p, v);
            state.base_velocity.store(p, plus_scaled(v, h, a));
        }
        chains.moved.joints().follow_course(state, k, time);
        if (!chains.left.motions) chains.set_relative<positions>(k);
    }
    /// Kick by the mean of the saved accelerations and those at the current state, which it saves.
    CATENA_HD void kick_mean(std::int64_t k, double h) const {
        StateView const& state = chains.moved.scan.state;
        Vec3 const qdd = chains.rate(k);  // Computed with the guess of qd.
        state.qd.store(k, plus_scaled(plus_scaled(start.qd.load(k), 0.5 * h, saved.qdd.load(k)),
                                      0.5 * h, qdd));
        saved.qdd.store(k, qdd);
        if (chains.on_free_base(k)) {
            std::int64_t const p = chains.moved.joints().piece_of(k);
            Vec3 const a = chains.base_rate(k), before = saved.base_acceleration.load(p);
            state.base_velocity.store(
                p,
                plus_scaled(plus_scaled(start.base_velocity.load(p), 0.5 * h, before), 0.5 * h, a));
            saved.base_acceleration.store(p, a);
        }
        chains.moved.joints().follow_course(state, k, chains.moved.time);
    }

    /// Drift: advances coordinates by h at the current velocities, which are kept. Prescribed
    /// motions are set to `time`.
    template <bool positions>
    CATENA_HD void drift(std::int64_t k, double h, double time) const {
        StateView const& state = chains.moved.scan.state;
        Vec3 const qd = state.qd.load(k);
        turn_by(k, h * qd, true);
        start.qd.store(k, qd);
        if (chains.on_free_base(k)) {
            std::int64_t const p = chains.moved.joints().piece_of(k);
            Vec3 const v = state.base_velocity.load(p);
            state.base_position.store(p, plus_scaled(state.base_position.load(p), h, v));
            start.base_velocity.store(p, v);
        }
        chains.moved.joints().follow_course(state, k, time);
        chains.set_relative<positions>(k);
    }
    /// Kick: the velocities kept by drift() plus h times the last solved rates; or, if
    /// `by_saved`, the current velocities plus h times the saved rates.
    CATENA_HD void kick(std::int64_t k, double h, bool by_saved) const {
        StateView const& state = chains.moved.scan.state;
        StateView const& from = by_saved ? state : start;
        state.qd.store(
            k, plus_scaled(from.qd.load(k), h, by_saved ? saved.qdd.load(k) : chains.rate(k)));
        if (chains.on_free_base(k)) {
            std::int64_t const p = chains.moved.joints().piece_of(k);
            Vec3 const a = by_saved ? saved.base_acceleration.load(p) : chains.base_rate(k);
            state.base_velocity.store(p, plus_scaled(from.base_velocity.load(p), h, a));
        }
        chains.moved.joints().follow_course(state, k, chains.moved.time);
    }
    /// Thermostat: mixes velocities with the solver's response to random loads. `chains` must have
    /// zero velocities and gravity, while `state` is the real state.
    CATENA_HD void mix(std::int64_t k, StateView const& state, double keep, double spread) const {
        JointsView const& joints = chains.moved.joints();
        if (!(joints.drives > 0 && joints.drive_of(k)))
            state.qd.store(k, plus_scaled(keep * state.qd.load(k), spread, chains.rate(k)));
        if (!chains.on_free_base(k)) return;
        std::int64_t const p = joints.piece_of(k);
        state.base_velocity.store(
            p, plus_scaled(keep * state.base_velocity.load(p), spread, chains.base_rate(k)));
    }

    /// Correction that closes tips: adds the solver's response to the coordinates or, if
    /// `velocities`, to the velocities. `chains` must have zero velocities and gravity.
    CATENA_HD void correct(std::int64_t k, StateView const& state, bool velocities) const {
        JointsView const& joints = chains.moved.joints();
        Vec3 const by = joints.drives > 0 && joints.drive_of(k) ? Vec3::zero() : chains.rate(k);
        if (velocities)
            state.qd.store(k, state.qd.load(k) + by);
        else
            turn_by(k, by, false);
        if (!chains.on_free_base(k)) return;
        std::int64_t const p = joints.piece_of(k);
        View<3> const& base = velocities ? state.base_velocity : state.base_position;
        base.store(p, base.load(p) + chains.base_rate(k));
    }
    /// Adds an increment to the coordinates of body k. `alone`: the component of q that is no
    /// coordinate becomes 0.
    CATENA_HD void turn_by(std::int64_t k, Vec3 const& by, bool alone) const {
        View<4> const& to = chains.moved.scan.state.q;
        Vector<double, 4> const q = to.load(k);
        if (chains.moved.joints().has_quaternion(k))
            to.store(k, as_vector(normalized(as_quaternion(q) * from_rotation_vector(by))));
        else
            to.store(k, Vector<double, 4>{
                            {q[0] + by[0], q[1] + by[1], q[2] + by[2], alone ? 0.0 : q[3]}});
    }
    /// Returns 0, or NaN if the state of body k is not finite.
    CATENA_HD double trouble(std::int64_t k) const {
        StateView const& state = chains.moved.scan.state;
        return 0.0 *
               (dot(state.q.load(k), state.q.load(k)) + dot(state.qd.load(k), state.qd.load(k)));
    }
};

}  // namespace catena
