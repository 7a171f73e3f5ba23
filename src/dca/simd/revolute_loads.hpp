// Loads on the bodies of runs on revolute joints side by side, one run per lane.
#pragma once

#include "dca/simd/revolute_records.hpp"

namespace catena::dca {

/// Loads and velocity terms of bodies whose data are in a tile. They are those that RunWithLoads
/// and the leaf compute for one run.
template <class Real, class Leaf>
struct LoadsInLanes {
    static constexpr int K = Leaf::K, lanes = Real::lanes, count = static_cast<int>(longest_run);
    using Vector3 = Vector<Real, 3>;
    using Matrix3 = Matrix<Real, 3, 3>;
    RunWork<Leaf> const& work;
    Resting<Leaf> const& bodies;
    BodiesInTile<Real, Leaf> const& in_tile;

    /// State of the recursion that computes joint forces in the outward pass
    /// (RunWithLoads::PassedOn).
    struct PassedOn {
        Vector<Real, K> force;
        Matrix3 e1, from_ground;
        Real torque;  // Torque about the revolute joint between the two bodies, within the run.
    };
    Vector3 omega_at(Column<Real> const& here) const {
        return bodies.loads.omega.origin ? read(bodies.loads.omega, here) : Vector3::zero();
    }
    bool has_wrenches() const { return bodies.loads.revolutes.torque.origin; }
    /// Returns the rotation matrix from W to the first bodies' axes.
    Matrix3 first_from_ground(RunsInLanes const& runs) const {
        return transpose(
            to_matrix(as_quaternion(pick<Real>(work.loads.revolutes.orientation, runs.body))));
    }
    /// Returns the torque of the joint inboard of body i, which is inside the run.
    Real torque_about(int i) const {
        return in_tile.revolute_torque.origin
                   ? read(in_tile.revolute_torque, Column<Real>{i % part_length})[0]
                   : Real(0);
    }
    /// Adds the external loads on the bodies `here`. `from_ground` is the rotation matrix from W to
    /// the axes of `torque` and `force`.
    void add_wrench(Column<Real> const& here, Matrix3 const& from_ground, Vector3& torque,
                    Vector3& force) const {
        if (!has_wrenches()) return;
        torque = torque + from_ground * read(bodies.loads.revolutes.torque, here);
        force = force + from_ground * read(bodies.loads.revolutes.force, here);
    }
    /// Adds the loads on body i if joint loads are given: external loads, and the torques of the
    /// joints at the runs' ends.
    void push(RunsInLanes const& runs, int i, Matrix3 const& from_ground,
              ArticulatedBody<Real>& body) const {
        add_wrench({i % part_length}, from_ground, body.torque, body.force);
        if (!in_tile.revolute_torque.origin) return;
        ConstView<3> const& of_joints = work.loads.revolutes.joint_torque;
        if (i == 0) body.torque = body.torque + body.e1 * pick<Real>(of_joints, runs.body);
        if (i < count - 1) return;
        alignas(64) double next[lanes];
        for (int j = 0; j < lanes; ++j) {
            std::int64_t const last = runs.column[j] + count - 1;
            next[j] = work.group.is_last[last]
                          ? 0.0
                          : of_joints.at(last + 1, RevoluteLoads::about_revolute);
        }
        body.torque = body.torque - Real::load(next) * body.e2.column(2);
    }
    /// Returns the force at the joint inboard of body i from that at the next joint. Called for the
    /// bodies from the last to the first.
    Vector<Real, K> pass_on(RunsInLanes const& runs, int i, KeptRevolutes<Real, Leaf> const& kept,
                            Vector3 const& omega, RevoluteFrame<Real> const& frame,
                            BodyAcceleration<Real> const& a, PassedOn& passed) const {
        auto body = bodies.leaf.revolute_at_rest(bodies.loads, Column<Real>{i % part_length});
        bodies.leaf.add_gyroscopic(bodies.loads, omega, body);
        if (has_wrenches())
            passed.from_ground = i == count - 1 ? kept.orientation()
                                                : transposed_times(passed.e1 * transpose(frame.e2),
                                                                   passed.from_ground);
        push(runs, i, passed.from_ground, body);
        // The torque of the outboard revolute joint is along none of the force's directions, so
        // that `passed.force` lacks it.
        body.torque = body.torque - passed.torque * body.e2.column(2);
        passed.force = inboard_force(body, a, passed.force);
        passed.e1 = frame.e1;
        passed.torque = torque_about(i);
        return passed.force;
    }
    /// Sets the velocity terms of body i from its angular velocity.
    void set_moving(RunsInLanes const& runs, int i, Vector3 const& omega,
                    RevoluteFrame<Real>& frame) const {
        bodies.leaf.set_moving(bodies.loads, Column<Real>{i % part_length}, omega, frame);
        if (i == 0) take_first_biases(runs, frame);
    }

  private:
    /// Sets the velocity terms of the first joint in lanes whose runs begin a chain.
    void take_first_biases(RunsInLanes const& runs, RevoluteFrame<Real>& body) const {
        if (!bodies.loads.revolute_rate.origin) return;
        alignas(64) double bias[K * lanes];
        store_vectors<Real>(bias, body.bias);
        for (int j = 0; j < lanes; ++j)
            if (work.group.is_first[runs.body[j]])
                for (int n = 0; n < K; ++n)
                    bias[n * lanes + j] =
                        work.loads.bias.origin[n * work.loads.bias.pitch + runs.body[j]];
        load_vectors<Real>(bias, body.bias);
    }
};

/// Supplies the bodies of the runs as BodiesOfRun does, if joint loads are given
/// (RevoluteLoads). Velocities are computed along the run, in its axes.
template <class Real, class Leaf, class Read>
class FollowedInLanes {
    static constexpr int count = static_cast<int>(longest_run);
    using Vector3 = Vector<Real, 3>;
    using Matrix3 = Matrix<Real, 3, 3>;
    using Loads = LoadsInLanes<Real, Leaf>;
    using Kept = KeptRevolutes<Real, Leaf>;

  public:
    /// read(i) reads body i into the tile. `by_all`: results of every body are wanted.
    FollowedInLanes(Loads const& loads, RunsInLanes const& runs, Kept const& kept, bool by_all,
                    Read const& read)
        : loads_(loads), runs_(runs), kept_(kept), by_all_(by_all), read_(read) {}
    /// Reads the first bodies and starts the recursion of the velocities.
    ArticulatedBody<Real> first() {
        read_(0);
        auto body = leaf().revolute_at_rest(loads_.bodies.loads, Column<Real>{0});
        Vector3 const omega = pick<Real>(loads_.work.loads.omega, runs_.body);
        if (loads_.has_wrenches()) from_ground_ = loads_.first_from_ground(runs_);
        loads_.set_moving(runs_, 0, omega, body);
        leaf().add_gyroscopic(loads_.bodies.loads, omega, body);
        loads_.push(runs_, 0, from_ground_, body);
        state = {Quaternion<Real>{Real(1), Real(0), Real(0), Real(0)}, omega, body.inward2};
        return body;
    }
    /// Returns body i in the run's axes with its velocity terms and external loads.
    LoadedBodyInRun<Real> next(int i) {
        read_(i);
        Column<Real> const here{i % part_length};
        BodyOnRevolute<Real> const on_revolute = leaf().on_revolute(loads_.bodies.loads, here);
        state.rotation = state.rotation * on_revolute.rotation;
        rotation_ = to_matrix_of_unit(state.rotation);
        LoadedBodyInRun<Real> body = state.go_on(follow(on_revolute, rotation_, state.omega));
        loads_.add_wrench(here, from_ground_, body.torque, body.force);
        if (i >= count - 2 || by_all_) keep_omega(i);
        return body;
    }
    /// Returns the last body in its own axes, with its velocity terms and all loads.
    ArticulatedBody<Real> last(int i) {
        read_(i);
        Column<Real> const here{i % part_length};
        auto body = leaf().revolute_at_rest(loads_.bodies.loads, here);
        Matrix3 const rotation = axes_ * transpose(body.e1);
        Vector3 const omega = transposed_times(rotation, state.omega) +
                              read(loads_.bodies.loads.revolute_rate, here)[0] * body.e1.column(2);
        loads_.set_moving(runs_, i, omega, body);
        leaf().add_gyroscopic(loads_.bodies.loads, omega, body);
        Matrix3 from_ground;
        if (loads_.has_wrenches()) {
            from_ground = transposed_times(rotation, from_ground_);
            kept_.put_orientation(from_ground);
        }
        loads_.push(runs_, i, from_ground, body);
        kept_.put_omega(i, omega);
        return body;
    }
    /// Returns the outboard handle of the last body but one.
    OutboardHandle<Real> before_last() {
        axes_ = rotation_ *
                axes_of(read(leaf().group().axes2, Column<Real>{(count - 2) % part_length}));
        return {axes_, state.inward};
    }
    using State = FollowedState<Real>;
    State state;

  private:
    static_assert((count - 2) / part_length == (count - 1) / part_length);
    Leaf const& leaf() const { return loads_.bodies.leaf; }
    /// Stores the angular velocity of the current body in the body's axes.
    void keep_omega(int i) {
        Vector3 omega = transposed_times(rotation_, state.omega);
        if (runs_.begins[i] != 0) choose<Real>(runs_.begins[i], first_omega(), omega);
        kept_.put_omega(i, omega);
    }
    Vector3 first_omega() const { return pick<Real>(loads_.work.loads.omega, runs_.body); }
    Loads loads_;
    RunsInLanes const& runs_;
    Kept kept_;
    bool by_all_;
    Read const& read_;
    // Rotation matrix from the current body to the run's axes, axes of the last revolute joint
    // in the run's axes, and rotation matrix from W to the run's axes.
    Matrix3 rotation_, axes_, from_ground_;
};

}  // namespace catena::dca
