// Runs on revolute joints side by side, one per lane, computed by articulated-body inertias
// (floating_run.hpp).
#pragma once

#include "dca/simd/runs_in_tile.hpp"

namespace catena::dca {

/// Kernel for runs on revolute joints; computes what FusedSweep::climb and descend do for one run.
template <class Real, class Leaf>
class RevoluteRunsSideBySide : RunsInTile<Real, Leaf> {
    static constexpr int K = Leaf::K, lanes = Real::lanes, count = static_cast<int>(longest_run);
    static constexpr int numbers_of_revolute = revolute_numbers * lanes;
    using Base = RunsInTile<Real, Leaf>;
    using Base::work_, Base::bodies_, Base::out_, Base::fill, Base::empty, Base::ask, Base::in_tile;
    static_assert(sizeof(ReleasedRevolute<Real>) == released_numbers * sizeof(Real) &&
                  sizeof(RunsEnd<Real>) == met_numbers * sizeof(Real) &&
                  sizeof(BodyInRun<Real>) == passed_body_numbers * sizeof(Real));
    using Vector3 = Vector<Real, 3>;
    using Matrix3 = Matrix<Real, 3, 3>;

  public:
    explicit RevoluteRunsSideBySide(RunWork<Leaf> const& work) : Base(work) {}

    /// Inward pass of the runs in the lanes of one item.
    void climb(std::int64_t item) {
        if (revolutes().given) {
            FollowedBodies bodies(*this, item);
            climb(item, bodies);
        } else {
            auto const body = [this, &runs = work_.runs[item]](int i) {
                if (i % part_length == 0) fill(runs, i / part_length, 1);
                ask(runs, i, 1);
                Column<Real> const here{i % part_length};
                auto b = bodies_.leaf.revolute_at_rest(bodies_.loads, here);
                Vector3 const omega = omega_at(here);
                set_moving(runs, i, omega, b);
                bodies_.leaf.add_gyroscopic(bodies_.loads, omega, b);
                return b;
            };
            climb(item, BodiesOfRun<Real, decltype(body)>(body));
        }
    }
    /// Outward pass of the runs in the lanes of one item.
    void descend(std::int64_t item) {
        RunsInLanes const& runs = work_.runs[item];
        Kept const kept{*this, runs, place_of(item)};
        Vector<Real, K> first, next;
        gather<Real>(work_.sweeps.forces, runs.body, first);
        gather<Real>(work_.sweeps.forces, runs.next, next);
        Vector3 omega;
        PassedOn passed{next, {}, {}, Real(0)};
        // Accelerations of the first bodies of shorter runs, kept until column 0 is reached.
        BodyAcceleration<Real> of_late;
        int part = parts_of_run;
        ask(runs, 0, -1);
        descend_revolutes<Real>(
            count, out_.by_all_bodies(),
            [&](int i) {
                if (i / part_length != part) fill(runs, part = i / part_length, -1);
                Column<Real> const here{i % part_length};
                omega = !revolutes().given ? omega_at(here)
                        : i == 0           ? pick<Real>(work_.loads.omega, runs.body)
                                           : kept.omega(i);
                auto frame = bodies_.leaf.frame_at_rest(here);
                set_moving(runs, i, omega, frame);
                return frame;
            },
            kept, first, next,
            [&](int i, RevoluteFrame<Real> const& frame, BodyAcceleration<Real> const& a) {
                Column<Real> const here{i % part_length};
                if (out_.acceleration.origin) {
                    write(out_.alpha, here, a.alpha);
                    write(out_.acceleration, here, a.a);
                }
                if (out_.joint_force) {
                    Vector<Real, K> force =
                        i == 0 ? first : pass_on(runs, i, kept, omega, frame, a, passed);
                    if (runs.begins[i] != 0) choose<Real>(runs.begins[i], first, force);
                    write_directions<K>(out_.joint_force, here, force);
                }
                if (!out_.revolute_acceleration.origin) {
                    if (i > 0) return;
                    empty(runs, 0);
                    scatter_accelerations(runs.body, 0, a,
                                          [&](int j) { return (runs.late >> j & 1) != 0; });
                } else if (i == 0) {
                    begin_at(runs, frame, a);
                } else if (i == count - 1) {
                    end_at(runs, frame, a);
                }
            },
            [&](int i, BodyAcceleration<Real>& a) {
                if (runs.late == 0 || runs.begins[i] == 0) return;
                i > 0 ? choose<Real>(runs.begins[i], a, of_late)
                      : choose<Real>(runs.late, of_late, a);
            },
            [&](int i, Real const& of_revolute) {
                ask(runs, i, -1);
                joint_acceleration(runs, i, of_revolute);
            });
    }

  private:
    // Storage of the data that the outward pass needs, with the interface that climb_revolutes()
    // and descend_revolutes() need.
    struct Kept {
        RevoluteRunsSideBySide const& all;
        RunsInLanes const& runs;
        double* place;

        /// Stores joint i and checks its pivot.
        void put(int i, ReleasedRevolute<Real> const& revolute) {
            double* const kept = of_revolute(i);
            int const further =
                ahead * numbers_of_revolute + (i + ahead < count ? 0 : numbers_of_end);
            if (prefetches()) prefetch_to_write<Real>(kept, further, numbers_of_revolute);
            if (prefetches() && i == count / 2) prefetch_to_write<Real>(place, 0, numbers_of_end);
            store_vectors<Real>(kept, revolute);
            watch(i, revolute.inverse.not_positive());
        }
        /// Stores joint i and the body outboard of it. The velocity bias is stored only if the
        /// outward pass reads it.
        void put(int i, ReleasedRevolute<Real> const& revolute, BodyInRun<Real> const& body,
                 BodyAcceleration<Real> const& velocity_bias) {
            put(i, revolute);
            store_vectors<Real>(of_revolute(i) + released_numbers * lanes, body);
            if (i == count - 2 || all.out_.by_all_bodies())
                store_vectors<Real>(of_revolute(i) + at_swing, velocity_bias);
        }
        /// Stores the angular velocity of the body outboard of joint i, in the body's axes.
        void put_omega(int i, Vector3 const& omega) {
            store_vectors<Real>(of_revolute(i) + at_omega, omega);
        }
        /// Stores the axes of the last revolute joint, in the run's axes.
        void put_axes(Matrix3 const& axes) {
            store_vectors<Real>(place + met_numbers * lanes, axes);
        }
        /// Stores the rotation matrix from W to the last body's axes.
        void put_orientation(Matrix3 const& from_ground) {
            store_vectors<Real>(place + at_orientation, from_ground);
        }
        Vector3 omega(int i) const { return load<Vector3>(of_revolute(i) + at_omega); }
        BodyAcceleration<Real> velocity_bias(int i) const {
            return load<BodyAcceleration<Real>>(of_revolute(i) + at_swing);
        }
        Matrix3 axes() const { return load<Matrix3>(place + met_numbers * lanes); }
        Matrix3 orientation() const { return load<Matrix3>(place + at_orientation); }
        /// Stores the end of the run and checks its pivots.
        void put(RunsEnd<Real> const& end) {
            store_vectors<Real>(place, end);
            for (int i = 0; i < 6; ++i) watch(count - 1, end.factor(i, i).not_positive());
        }
        /// Returns joint i; with prefetching, it also prefetches a joint that follows in the
        /// outward pass.
        ReleasedRevolute<Real> revolute(int i) const {
            double const* const kept = of_revolute(i);
            if (prefetches())
                prefetch<Real>(kept,
                               -ahead * numbers_of_revolute - (i > ahead ? 0 : numbers_of_end),
                               numbers_of_revolute);
            return load<ReleasedRevolute<Real>>(kept);
        }
        BodyInRun<Real> body(int i) const {
            return load<BodyInRun<Real>>(of_revolute(i) + released_numbers * lanes);
        }
        RunsEnd<Real> end() const {
            if (prefetches())
                prefetch<Real>(place, -kept_of_revolute_run * lanes, met_numbers * lanes);
            return load<RunsEnd<Real>>(place);
        }

      private:
        // Prefetch distance: `ahead` revolute joints, in the order of items. The end of the next
        // item lies between them.
        static constexpr int ahead = 4, numbers_of_end = end_numbers * lanes;
        static constexpr int at_omega = (released_numbers + passed_body_numbers) * lanes,
                             at_swing = at_omega + 3 * lanes,
                             at_orientation = (met_numbers + 9) * lanes;
        template <class Record>
        static Record load(double const* from) {
            Record record;
            load_vectors<Real>(from, record);
            return record;
        }
        bool prefetches() const { return all.work_.prefetches; }
        /// Returns the storage of joint i and the body outboard of it.
        double* of_revolute(int i) const {
            return place + end_numbers * lanes + (i - 1) * numbers_of_revolute;
        }
        /// Records pivot failures. Skipped columns and the first body of a lane's run have no joint
        /// within the run.
        void watch(int i, unsigned bad) const {
            for (int j = 0; bad != 0 && j < lanes; ++j)
                if (i <= runs.skipped[j]) bad &= ~(1U << j);
            note_lost<Real>(all.work_.sweeps, runs.column, i, bad);
        }
    };
    /// Supplies the bodies of the runs as BodiesOfRun does, if joint loads are given
    /// (RevoluteLoads). Velocities are computed along the run, in its axes.
    class FollowedBodies {
      public:
        FollowedBodies(RevoluteRunsSideBySide& all, std::int64_t item)
            : all_(all), runs_(all.work_.runs[item]), kept_{all, runs_, all.place_of(item)} {}
        /// Reads the first bodies and starts the recursion of the velocities.
        ArticulatedBody<Real> first() {
            all_.fill(runs_, 0, 1);
            all_.ask(runs_, 0, 1);
            auto body = leaf().revolute_at_rest(all_.bodies_.loads, Column<Real>{0});
            Vector3 const omega = pick<Real>(all_.work_.loads.omega, runs_.body);
            if (all_.has_wrenches()) from_ground_ = all_.first_from_ground(runs_);
            all_.set_moving(runs_, 0, omega, body);
            leaf().add_gyroscopic(all_.bodies_.loads, omega, body);
            all_.push(runs_, 0, from_ground_, body);
            state = {Quaternion<Real>{Real(1), Real(0), Real(0), Real(0)}, omega, body.inward2};
            return body;
        }
        /// Returns body i in the run's axes with its velocity terms and external loads.
        LoadedBodyInRun<Real> next(int i) {
            if (i % part_length == 0) all_.fill(runs_, i / part_length, 1);
            all_.ask(runs_, i, 1);
            Column<Real> const here{i % part_length};
            BodyOnRevolute<Real> const on_revolute = leaf().on_revolute(all_.bodies_.loads, here);
            state.rotation = state.rotation * on_revolute.rotation;
            rotation_ = to_matrix_of_unit(state.rotation);
            LoadedBodyInRun<Real> body = state.go_on(follow(on_revolute, rotation_, state.omega));
            all_.add_wrench(here, from_ground_, body.torque, body.force);
            if (i >= count - 2 || all_.out_.by_all_bodies()) keep_omega(i);
            return body;
        }
        /// Returns the last body in its own axes, with its velocity terms and all loads.
        ArticulatedBody<Real> last(int i) {
            all_.ask(runs_, i, 1);
            Column<Real> const here{i % part_length};
            auto body = leaf().revolute_at_rest(all_.bodies_.loads, here);
            Matrix3 const rotation = axes_ * transpose(body.e1);
            Vector3 const omega =
                transposed_times(rotation, state.omega) +
                read(all_.bodies_.loads.revolute_rate, here)[0] * body.e1.column(2);
            all_.set_moving(runs_, i, omega, body);
            leaf().add_gyroscopic(all_.bodies_.loads, omega, body);
            Matrix3 from_ground;
            if (all_.has_wrenches()) {
                from_ground = transposed_times(rotation, from_ground_);
                kept_.put_orientation(from_ground);
            }
            all_.push(runs_, i, from_ground, body);
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
        Leaf const& leaf() const { return all_.bodies_.leaf; }
        /// Stores the angular velocity of the current body in the body's axes.
        void keep_omega(int i) {
            Vector3 omega = transposed_times(rotation_, state.omega);
            if (runs_.begins[i] != 0) choose<Real>(runs_.begins[i], first_omega(), omega);
            kept_.put_omega(i, omega);
        }
        Vector3 first_omega() const { return pick<Real>(all_.work_.loads.omega, runs_.body); }
        RevoluteRunsSideBySide& all_;
        RunsInLanes const& runs_;
        Kept kept_;
        // Rotation matrix from the current body to the run's axes, axes of the last revolute joint
        // in the run's axes, and rotation matrix from W to the run's axes.
        Matrix3 rotation_, axes_, from_ground_;
    };
    /// Inward pass for any supplier of bodies. In the lanes of shorter runs, it restarts where
    /// their first bodies begin.
    template <class Bodies>
    void climb(std::int64_t item, Bodies&& bodies) {
        RunsInLanes const& runs = work_.runs[item];
        FloatingRun<Real> begun;
        typename std::remove_reference_t<Bodies>::State first;
        auto const segment = climb_revolutes<Real>(
            count, bodies, [&](int i) { return torque_about(i); },
            Kept{*this, runs, place_of(item)},
            [&](int i, FloatingRun<Real>& run, auto& all) {
                if (runs.late == 0 || runs.begins[i] == 0) return;
                if (i == 0) {
                    begun = run;
                    first = all.state;
                } else {
                    choose<Real>(runs.begins[i], begun, run);
                    choose<Real>(runs.begins[i], first, all.state);
                }
            });
        scatter<Real>(segment.matrix, work_.sweeps.matrices, runs.slot);
        scatter<Real>(segment.bias, work_.sweeps.biases, runs.slot);
    }
    /// Returns the storage of an item's runs.
    double* place_of(std::int64_t item) const {
        return work_.nodes + item * kept_of_revolute_run * lanes;
    }
    GroupView const& group() const { return work_.group; }
    Vector3 omega_at(Column<Real> const& here) const {
        return bodies_.loads.omega.origin ? read(bodies_.loads.omega, here) : Vector3::zero();
    }
    RevoluteLoads const& revolutes() const { return bodies_.loads.revolutes; }
    bool has_wrenches() const { return revolutes().torque.origin; }
    /// Returns the rotation matrix from W to the first bodies' axes.
    Matrix3 first_from_ground(RunsInLanes const& runs) const {
        return transpose(
            to_matrix(as_quaternion(pick<Real>(work_.loads.revolutes.orientation, runs.body))));
    }
    /// Returns the torque of the joint inboard of body i, which is inside the run.
    Real torque_about(int i) const {
        return in_tile().revolute_torque.origin
                   ? read(in_tile().revolute_torque, Column<Real>{i % part_length})[0]
                   : Real(0);
    }
    /// Adds the external loads on the bodies `here`. `from_ground` is the rotation matrix from W to
    /// the axes of `torque` and `force`.
    void add_wrench(Column<Real> const& here, Matrix3 const& from_ground, Vector3& torque,
                    Vector3& force) const {
        if (!has_wrenches()) return;
        torque = torque + from_ground * read(revolutes().torque, here);
        force = force + from_ground * read(revolutes().force, here);
    }
    /// Adds the loads on body i if joint loads are given: external loads, and the torques of the
    /// joints at the runs' ends.
    void push(RunsInLanes const& runs, int i, Matrix3 const& from_ground,
              ArticulatedBody<Real>& body) const {
        add_wrench({i % part_length}, from_ground, body.torque, body.force);
        if (!in_tile().revolute_torque.origin) return;
        ConstView<3> const& of_joints = work_.loads.revolutes.joint_torque;
        if (i == 0) body.torque = body.torque + body.e1 * pick<Real>(of_joints, runs.body);
        if (i < count - 1) return;
        alignas(64) double next[lanes];
        for (int j = 0; j < lanes; ++j) {
            std::int64_t const last = runs.column[j] + count - 1;
            next[j] =
                group().is_last[last] ? 0.0 : of_joints.at(last + 1, RevoluteLoads::about_revolute);
        }
        body.torque = body.torque - Real::load(next) * body.e2.column(2);
    }
    /// State of the recursion that computes joint forces in the outward pass
    /// (RunWithLoads::PassedOn).
    struct PassedOn {
        Vector<Real, K> force;
        Matrix3 e1, from_ground;
        Real torque;  // Torque about the revolute joint between the two bodies, within the run.
    };
    /// Returns the force at the joint inboard of body i from that at the next joint. Called for the
    /// bodies from the last to the first.
    Vector<Real, K> pass_on(RunsInLanes const& runs, int i, Kept const& kept, Vector3 const& omega,
                            RevoluteFrame<Real> const& frame, BodyAcceleration<Real> const& a,
                            PassedOn& passed) const {
        auto body = bodies_.leaf.revolute_at_rest(bodies_.loads, Column<Real>{i % part_length});
        bodies_.leaf.add_gyroscopic(bodies_.loads, omega, body);
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
        bodies_.leaf.set_moving(bodies_.loads, Column<Real>{i % part_length}, omega, frame);
        if (i == 0) take_first_biases(runs, frame);
    }
    /// Sets the velocity terms of the first joint in lanes whose runs begin a chain.
    void take_first_biases(RunsInLanes const& runs, RevoluteFrame<Real>& body) const {
        if (!bodies_.loads.revolute_rate.origin) return;
        alignas(64) double bias[K * lanes];
        store_vectors<Real>(bias, body.bias);
        for (int j = 0; j < lanes; ++j)
            if (group().is_first[runs.body[j]])
                for (int n = 0; n < K; ++n)
                    bias[n * lanes + j] =
                        work_.loads.bias.origin[n * work_.loads.bias.pitch + runs.body[j]];
        load_vectors<Real>(bias, body.bias);
    }
    /// Writes the wanted results of the runs' last bodies, and begin_at() those of the first ones,
    /// in the lanes where FusedSweep::accelerate() would write them.
    void end_at(RunsInLanes const& runs, RevoluteFrame<Real> const& frame,
                BodyAcceleration<Real> const& a) const {
        scatter(component<Real>(work_.out.revolute_acceleration, 1), runs.column, count,
                Vector<Real, 1>{{about_outboard_revolute(frame, a)}});
        scatter_accelerations(runs.column, count - 1, a, [&](int j) {
            std::int64_t const next = runs.column[j] + count;
            return next >= group().size || group().is_last[next];
        });
    }
    void begin_at(RunsInLanes const& runs, RevoluteFrame<Real> const& frame,
                  BodyAcceleration<Real> const& a) {
        scatter_accelerations(runs.body, 0, a,
                              [&](int j) { return group().is_first[runs.body[j]] != 0; });
        Real const about = about_inboard_revolute(frame, a);
        joint_acceleration(runs, 0, about);
        if (runs.late != 0)
            scatter(component<Real>(work_.out.revolute_acceleration, 0), runs.body, 0,
                    Vector<Real, 1>{{about}});
    }
    /// Writes the accelerations of bodies body[j] + i in the lanes with wanted(j).
    template <class Wanted>
    void scatter_accelerations(std::int64_t const* body, int i, BodyAcceleration<Real> const& a,
                               Wanted const& wanted) const {
        bool stored = false;
        alignas(64) double numbers[6 * lanes];
        for (int j = 0; j < lanes; ++j) {
            if (!wanted(j)) continue;
            if (!stored) store_vectors<Real>(numbers, a);
            stored = true;
            for (int n = 0; n < 3; ++n) {
                work_.out.alpha.origin[n * work_.out.alpha.pitch + body[j] + i] =
                    numbers[n * lanes + j];
                work_.out.acceleration.origin[n * work_.out.acceleration.pitch + body[j] + i] =
                    numbers[(3 + n) * lanes + j];
            }
        }
    }
    /// Writes the joint acceleration of body i of the runs, the last result for this body. At the
    /// first body of a part, the part's results leave the tile.
    void joint_acceleration(RunsInLanes const& runs, int i, Real const& of_revolute) {
        View<2> const& to = out_.revolute_acceleration;
        if (to.origin)
            write(component<Real>(to, 0), Column<Real>{i % part_length},
                  Vector<Real, 1>{{of_revolute}});
        if (i % part_length == 0) empty(runs, i / part_length);
    }
};

}  // namespace catena::dca
