// Velocities of bodies in a run on revolute joints (RevoluteLoads), computed along the inward pass,
// in the run's axes. Host and device.
#pragma once

#include "dca/body_leaf.hpp"
#include "tree/tree.hpp"

namespace catena::dca {

/// A body and its velocity terms, in the run's axes. `difference.a` still lacks the centripetal
/// acceleration of the handle inboard of the body.
template <class Real>
struct FollowedBody {
    LoadedBodyInRun<Real> in_run;
    Vector<Real, 3> omega, inward2;
};
/// Computes a body's velocity terms from the angular velocity of the body before. `rotation` is the
/// rotation matrix from the body's axes to the run's. External loads are not included yet.
template <class Real>
CATENA_HD_IN_PLACE FollowedBody<Real> follow(BodyOnRevolute<Real> const& body,
                                             Matrix<Real, 3, 3> const& rotation,
                                             Vector<Real, 3> const& omega_before) {
    using Vector3 = Vector<Real, 3>;
    Vector3 const axis = rotation * body.axis, r1 = rotation * body.r1, r2 = rotation * body.r2;
    Vector3 const angular = body.rate * cross(omega_before, axis),
                  omega = plus_scaled(omega_before, body.rate, axis);
    // The expression for omega x (omega x r) needs fewer operations.
    Real const square = dot(omega, omega);
    auto const inward = [&](Vector3 const& r) {
        return plus_scaled(dot(omega, r) * omega, -square, r);
    };
    Symmetric<Real, 3> const inertia = turned(rotation, body.inertia);
    return {{{axis, r2 - r1},
             {angular, -inward(r1)},
             -r2,
             body.mass,
             inertia,
             cross(inertia * omega, omega),
             Vector3::zero()},
            omega,
            inward(r2)};
}
/// State of the recursion at the current body.
template <class Real>
struct FollowedState {
    Quaternion<Real> rotation;  // Rotation from the body's axes to the run's.
    // Angular velocity, and omega x (omega x r) at the body's handle 2, in the run's axes.
    Vector<Real, 3> omega, inward;

    /// Advances the state to `body` and returns it with `difference` completed.
    CATENA_HD_IN_PLACE LoadedBodyInRun<Real> go_on(FollowedBody<Real> const& body) {
        LoadedBodyInRun<Real> next = body.in_run;
        next.difference.a = inward + next.difference.a;
        omega = body.omega;
        inward = body.inward2;
        return next;
    }
};

/// A run of two bodies or more whose joint loads are given as RevoluteLoads.
template <class Leaf>
class RunWithLoads {
    using Real = double;

  public:
    CATENA_HD RunWithLoads(Leaf const& leaf, LoadsView const& loads, Run const& run)
        : leaf_(leaf), loads_(loads), run_(run) {}
    CATENA_HD int count() const { return static_cast<int>(run_.count); }
    CATENA_HD bool has_wrenches() const { return loads_.revolutes.torque.origin; }
    CATENA_HD Vec3 first_omega() const { return loads_.omega.load(run_.body); }
    /// Returns omega x (omega x r) at the first body's handle 2.
    CATENA_HD Vec3 first_inward() const {
        Vec3 const omega = first_omega();
        return cross(omega, cross(omega, leaf_.frame_at_rest(run_.body).r2));
    }
    CATENA_HD Mat3 axes2(int i) const { return axes_of(leaf_.axes2(run_.body + i)); }
    CATENA_HD BodyOnRevolute<Real> on_revolute(int i) const {
        return leaf_.on_revolute(loads_, run_.body + i, ReadLast{});
    }
    /// Returns the torque of the joint inboard of body i, which is inside the run.
    CATENA_HD double torque_about(int i) const {
        return joint_torque().origin
                   ? joint_torque().at(run_.body + i, RevoluteLoads::about_revolute)
                   : 0.0;
    }
    /// Adds the external loads on body i, in the run's axes.
    CATENA_HD void add_wrench(int i, LoadedBodyInRun<Real>& body) const {
        if (has_wrenches()) add_wrench(i, first_from_ground(), body.torque, body.force);
    }
    /// Returns the first body with its loads and velocity terms, in its own axes.
    CATENA_HD ArticulatedBody<Real> first() const {
        ArticulatedBody<Real> body = at_rest(0);
        set_moving(0, first_omega(), body);
        push(0, has_wrenches() ? first_from_ground() : Mat3::identity(), body);
        return body;
    }
    /// Returns the last body with its loads and velocity terms, in its own axes. `axes` are those
    /// of its revolute joint and `omega` is the angular velocity of the body before, both in the
    /// run's axes. `kept` gets put_omega(i, the body's own angular velocity in its axes). With
    /// external loads it also gets put_orientation(rotation matrix from W to the body's axes).
    template <class Kept>
    CATENA_HD ArticulatedBody<Real> last(Mat3 const& axes, Vec3 const& omega, Kept&& kept) const {
        int const i = count() - 1;
        ArticulatedBody<Real> body = at_rest(i);
        Mat3 const rotation = axes * transpose(body.e1);
        Vec3 const own = omega_beyond(rotation, omega, body);
        set_moving(i, own, body);
        kept.put_omega(i, own);
        Mat3 from_ground = Mat3::identity();
        if (has_wrenches()) {
            from_ground = transposed_times(rotation, first_from_ground());
            kept.put_orientation(from_ground);
        }
        push(i, from_ground, body);
        return body;
    }
    /// Returns the kinematics of body i for the outward pass. `kept` supplies omega(i).
    template <class Kept>
    CATENA_HD RevoluteFrame<Real> frame(int i, Kept const& kept) const {
        RevoluteFrame<Real> f = leaf_.frame_at_rest(run_.body + i);
        leaf_.set_moving(loads_, run_.body + i, omega(i, f, kept), f);
        return f;
    }
    /// State of the recursion that computes joint forces in the outward pass.
    struct PassedOn {
        // Force at the joint inboard of the body passed last, along its directions.
        Vector<Real, 5> force;
        // Inboard axes of that body, and the rotation matrix from W to its axes.
        Mat3 e1 = Mat3::identity(), from_ground = Mat3::identity();
        // Torque about the revolute joint between the two bodies, within the run.
        double torque = 0;
    };
    /// Returns the force at the joint inboard of body i from that at the next joint. Called for the
    /// bodies from the last to the first. `kept` supplies omega(i) and orientation().
    template <class Kept>
    CATENA_HD Vector<Real, 5> pass_on(int i, RevoluteFrame<Real> const& frame,
                                      BodyAcceleration<Real> const& a, Kept const& kept,
                                      PassedOn& passed) const {
        ArticulatedBody<Real> body = at_rest(i);
        set_moving(i, omega(i, frame, kept), body);
        if (has_wrenches()) {
            if (i < count() - 1)
                passed.from_ground =
                    transposed_times(passed.e1 * transpose(frame.e2), passed.from_ground);
            else
                passed.from_ground =
                    i > 1 ? kept.orientation()
                          : transposed_times(turn_of_two(frame), first_from_ground());
        }
        push(i, passed.from_ground, body);
        // The torque of the outboard revolute joint is along none of the force's directions, so
        // that `passed.force` lacks it.
        body.torque = body.torque - passed.torque * body.e2.column(2);
        passed.force = inboard_force(body, a, passed.force);
        passed.e1 = frame.e1;
        passed.torque = torque_about(i);
        return passed.force;
    }

  private:
    CATENA_HD ConstView<3> const& joint_torque() const { return loads_.revolutes.joint_torque; }
    // Returns the rotation matrix from W to the first body's axes.
    CATENA_HD Mat3 first_from_ground() const {
        return transpose(to_matrix(as_quaternion(loads_.revolutes.orientation.load(run_.body))));
    }
    CATENA_HD ArticulatedBody<Real> at_rest(int i) const {
        return leaf_.revolute_at_rest(LoadsView{}, run_.body + i);
    }
    CATENA_HD void set_moving(int i, Vec3 const& omega, ArticulatedBody<Real>& body) const {
        leaf_.set_moving(loads_, run_.body + i, omega, body);
        body.torque = body.torque - cross(omega, body.inertia * omega);
    }
    /// Returns the last body's angular velocity in its own axes, from that of the body before in
    /// the run's axes.
    CATENA_HD Vec3 omega_beyond(Mat3 const& rotation, Vec3 const& omega,
                                RevoluteFrame<Real> const& last) const {
        return transposed_times(rotation, omega) +
               loads_.revolute_rate.at(run_.body + count() - 1, 0) * last.e1.column(2);
    }
    /// Returns the rotation matrix from the second of two bodies to the first.
    CATENA_HD Mat3 turn_of_two(RevoluteFrame<Real> const& last) const {
        return axes2(0) * transpose(last.e1);
    }
    template <class Kept>
    CATENA_HD Vec3 omega(int i, RevoluteFrame<Real> const& frame, Kept const& kept) const {
        if (i == 0) return first_omega();
        return count() > 2 ? kept.omega(i) : omega_beyond(turn_of_two(frame), first_omega(), frame);
    }
    CATENA_HD void add_wrench(int i, Mat3 const& from_ground, Vec3& torque, Vec3& force) const {
        torque = torque + from_ground * loads_.revolutes.torque.load(run_.body + i);
        force = force + from_ground * loads_.revolutes.force.load(run_.body + i);
    }
    /// Adds the loads on the first or the last body: external loads and the torque of the joint at
    /// the run's end. On other bodies, only external loads act.
    CATENA_HD void push(int i, Mat3 const& from_ground, ArticulatedBody<Real>& body) const {
        if (has_wrenches()) add_wrench(i, from_ground, body.torque, body.force);
        if (!joint_torque().origin) return;
        std::int64_t const k = run_.body + i;
        if (i == 0) body.torque = body.torque + body.e1 * joint_torque().load(k);
        if (i == count() - 1 && !ends_chain(leaf_.group(), k))
            body.torque = body.torque - joint_torque().at(k + 1, RevoluteLoads::about_revolute) *
                                            body.e2.column(2);
    }

    Leaf const& leaf_;
    LoadsView const& loads_;
    Run const& run_;
};

/// Supplies the bodies of a run as BodiesOfRun does. `all`: the outward pass needs every body's
/// kinematics. `kept` has the interface that RunWithLoads::last() needs.
template <class Leaf, class Kept>
class FollowedBodies {
  public:
    CATENA_HD FollowedBodies(RunWithLoads<Leaf> const& run, bool all, Kept& kept)
        : run_(run), all_(all), kept_(kept) {}
    CATENA_HD_IN_PLACE ArticulatedBody<double> first() {
        ArticulatedBody<double> const body = run_.first();
        state = {Quat::identity(), run_.first_omega(), body.inward2};
        return body;
    }
    CATENA_HD_IN_PLACE LoadedBodyInRun<double> next(int i) {
        BodyOnRevolute<double> const here = run_.on_revolute(i);
        state.rotation = state.rotation * here.rotation;
        Mat3 const rotation = to_matrix_of_unit(state.rotation);
        LoadedBodyInRun<double> body = state.go_on(follow(here, rotation, state.omega));
        run_.add_wrench(i, body);
        if (all_ || i == run_.count() - 2)
            kept_.put_omega(i, transposed_times(rotation, state.omega));
        return body;
    }
    /// Returns the last body. Precondition: before_last() was called.
    CATENA_HD_IN_PLACE ArticulatedBody<double> last(int) {
        return run_.last(axes_, state.omega, kept_);
    }
    CATENA_HD_IN_PLACE OutboardHandle<double> before_last() {
        axes_ = to_matrix_of_unit(state.rotation) * run_.axes2(run_.count() - 2);
        return {axes_, state.inward};
    }
    FollowedState<double> state;

  private:
    RunWithLoads<Leaf> const& run_;
    bool all_;
    Kept& kept_;
    Mat3 axes_;  // Axes of the last revolute joint, in the run's axes.
};

}  // namespace catena::dca
