// Runs on hinges side by side, one a lane: they go by their inertias (inertia_run.hpp).
#pragma once

#include "dca/simd/runs_in_tile.hpp"

namespace catena::dca {

/// Runs on hinges, by their inertias: as Evaluation::climb and descend.
template <class Real, class Leaf>
class HingedRunsSideBySide : RunsInTile<Real, Leaf> {
    static constexpr int K = Leaf::K, lanes = Real::lanes, count = static_cast<int>(longest_run);
    static constexpr int numbers_of_hinge = hinge_numbers * lanes;
    using Base = RunsInTile<Real, Leaf>;
    using Base::work_, Base::bodies_, Base::out_, Base::fill, Base::empty, Base::hinge_torque;
    static_assert(sizeof(ReleasedHinge<Real>) == released_numbers * sizeof(Real) && sizeof(RunsEnd<Real>) == met_numbers * sizeof(Real));
    using Vector3 = Vector<Real, 3>;
    using Matrix3 = Matrix<Real, 3, 3>;

  public:
    explicit HingedRunsSideBySide(RunWork<Leaf> const& work) : Base(work) {}

    void climb(std::int64_t item) {
        RunsInLanes const& runs = work_.runs[item];
        Kept kept{*this, runs, place_of(item)};
        Vector3 omega;
        Matrix3 before, from_ground;  // axes of the joint at hand in the body inboard of it; what turns to the body's axes
        Vector3 first_omega;          // as the first bodies have these
        Matrix3 first_turn;
        InertiaRun<Real> begun;
        auto const segment = climb_hinges<Real>(
            count,
            [&](int i) {
                if (i % part_length == 0) fill(runs, i / part_length, 1);
                Column<Real> const here{i % part_length};
                auto body = bodies_.leaf.hinged_at_rest(bodies_.loads, here);
                if (!hinges().given) {
                    omega = omega_at(here);
                } else if (i == 0) {
                    first_omega = omega = pick(work_.loads.omega, runs.body);
                    if (has_wrenches()) first_turn = from_ground = first_from_ground(runs);
                } else {
                    Matrix3 const turn = body.turn_from(before);
                    omega = turn * omega + read(bodies_.loads.hinge_rate, here)[0] * body.e1.column(2);
                    if (has_wrenches()) from_ground = turn * from_ground;
                    if (unsigned const begin = runs.begins[i]; begin != 0) {
                        choose<Real>(begin, first_omega, omega);
                        if (has_wrenches()) choose<Real>(begin, first_turn, from_ground);
                    }
                    kept.put(i, omega);
                }
                before = body.e2;
                set_moving(runs, i, omega, body);
                bodies_.leaf.add_gyroscopic(bodies_.loads, omega, body);
                push(runs, i, from_ground, body);
                if (has_wrenches() && i == count - 1) kept.put_orientation(from_ground);
                return body;
            },
            [&](int i) { return torque_about(i); }, kept,
            [&](int i, InertiaRun<Real>& run) {
                if (!runs.short_ones) return;
                if (i == 0)
                    begun = run;
                else if (unsigned const begin = runs.begins[i]; begin != 0)
                    choose<Real>(begin, begun, run);
            });
        scatter<Real>(segment.matrix, work_.sweeps.matrices, runs.slot);
        scatter<Real>(segment.bias, work_.sweeps.biases, runs.slot);
    }
    void descend(std::int64_t item) {
        RunsInLanes const& runs = work_.runs[item];
        Kept const kept{*this, runs, place_of(item)};
        Vector<Real, K> first, next;
        gather<Real>(work_.sweeps.forces, runs.body, first);
        gather<Real>(work_.sweeps.forces, runs.next, next);
        Vector3 omega;
        Real of_first;  // about their inboard hinges, of the bodies that begin where others go on
        PassedOn passed{next, {}, {}, Real(0)};
        descend_hinges<Real, false>(
            count,
            [&](int i) {
                if (i % part_length == part_length - 1) fill(runs, i / part_length, -1);
                Column<Real> const here{i % part_length};
                omega = !hinges().given ? omega_at(here) : i == 0 ? pick(work_.loads.omega, runs.body) : kept.omega(i);
                auto frame = bodies_.leaf.frame_at_rest(here);
                set_moving(runs, i, omega, frame);
                return frame;
            },
            kept, first, next,
            [&](int i, HingedFrame<Real> const& frame, BodyAcceleration<Real> const& a) {
                Column<Real> const here{i % part_length};
                if (out_.acceleration.origin) {
                    write(out_.alpha, here, a.alpha);
                    write(out_.acceleration, here, a.a);
                }
                if (out_.hinge_acceleration.origin && i == count - 1) end_at(runs, frame, a);
                unsigned const begin = runs.begins[i];
                if (out_.joint_force) {
                    Vector<Real, K> force = i == 0 ? first : pass_on(runs, i, kept, omega, frame, a, passed);
                    if (begin != 0) choose<Real>(begin, first, force);
                    write_directions<K>(out_.joint_force, here, force);
                }
                if (begin == 0) return;
                of_first = about_inboard_hinge(frame, a);
                begin_at(runs, begin, a);
                if (i == 0) turn(runs, 0, of_first);
            },
            [&](int i, Real const& of_hinge) {
                unsigned const begin = runs.begins[i];
                turn(runs, i, begin == 0 ? of_hinge : Real::choose(begin, of_first, of_hinge));
            });
    }

  private:
    struct Kept {
        HingedRunsSideBySide const& all;
        RunsInLanes const& runs;
        double* place;

        void put(int i, ReleasedHinge<Real> const& hinge) {
            double* const kept = of_hinge(i);
            int const further = ahead * numbers_of_hinge + (i + ahead < count ? 0 : numbers_of_end);
            prefetch_to_write<Real>(kept, further, numbers_of_hinge);
            if (i == count / 2) prefetch_to_write<Real>(place, 0, numbers_of_end);
            store_vectors<Real>(kept, hinge);
            watch(i, hinge.inverse.not_positive());
        }
        /// Outboard of joint i.
        void put(int i, Vector3 const& omega) { store_vectors<Real>(of_hinge(i) + released_numbers * lanes, omega); }
        Vector3 omega(int i) const {
            Vector3 omega;
            load_vectors<Real>(of_hinge(i) + released_numbers * lanes, omega);
            return omega;
        }
        void put_orientation(Matrix3 const& from_ground) { store_vectors<Real>(place + met_numbers * lanes, from_ground); }
        Matrix3 orientation() const {
            Matrix3 from_ground;
            load_vectors<Real>(place + met_numbers * lanes, from_ground);
            return from_ground;
        }
        void put(RunsEnd<Real> const& end) {
            store_vectors<Real>(place, end);
            for (int i = 0; i < 6; ++i) watch(count - 1, end.factor(i, i).not_positive());
        }
        ReleasedHinge<Real> hinge(int i) const {
            ReleasedHinge<Real> h;
            double const* const kept = of_hinge(i);
            prefetch<Real>(kept, -ahead * numbers_of_hinge - (i > ahead ? 0 : numbers_of_end), numbers_of_hinge);
            load_vectors<Real>(kept, h);
            return h;
        }
        RunsEnd<Real> end() const {
            RunsEnd<Real> e;
            prefetch<Real>(place, -kept_of_hinged_run * lanes, met_numbers * lanes);
            load_vectors<Real>(place, e);
            return e;
        }

      private:
        // What is asked for is so many hinges further, in the order of items: the next one's end lies between.
        static constexpr int ahead = 4, numbers_of_end = end_numbers * lanes;
        double* of_hinge(int i) const { return place + end_numbers * lanes + (i - 1) * numbers_of_hinge; }
        void watch(int i, unsigned bad) const {
            for (int j = 0; bad != 0 && j < lanes; ++j)
                if (i <= runs.skipped[j]) bad &= ~(1U << j);
            note_lost<Real>(all.work_.sweeps, runs.column, i, bad);
        }
    };
    double* place_of(std::int64_t item) const { return work_.nodes + item * kept_of_hinged_run * lanes; }
    GroupView const& group() const { return work_.group; }
    Vector3 omega_at(Column<Real> const& here) const {
        return bodies_.loads.omega.origin ? read(bodies_.loads.omega, here) : Vector3::zero();
    }
    static Vector3 pick(ConstView<3> const& view, std::int64_t const* body) {
        Vector3 v;
        for (int n = 0; n < 3; ++n) v[n] = Real::pick(view.origin + n * view.pitch, body);
        return v;
    }
    HingeLoads const& hinges() const { return bodies_.loads.hinges; }
    bool has_wrenches() const { return hinges().torque.origin; }
    Matrix3 first_from_ground(RunsInLanes const& runs) const {
        ConstView<4> const& all = work_.loads.hinges.orientation;
        Vector<Real, 4> numbers;
        for (int n = 0; n < 4; ++n) numbers[n] = Real::pick(all.origin + n * all.pitch, runs.body);
        return transpose(to_matrix(as_quaternion(numbers)));
    }
    /// Of the hinge inboard of body i, within the run.
    Real torque_about(int i) const { return hinge_torque().origin ? read(hinge_torque(), Column<Real>{i % part_length})[0] : Real(0); }
    /// What acts on body i from outside and by the joints at the runs' ends, where hinges' loads are given.
    void push(RunsInLanes const& runs, int i, Matrix3 const& from_ground, HingedBody<Real>& body) const {
        if (has_wrenches()) {
            Column<Real> const here{i % part_length};
            body.torque = body.torque + from_ground * read(hinges().torque, here);
            body.force = body.force + from_ground * read(hinges().force, here);
        }
        if (!hinge_torque().origin) return;
        ConstView<3> const& of_joints = work_.loads.hinges.joint_torque;
        if (i == 0) body.torque = body.torque + body.e1 * pick(of_joints, runs.body);
        if (i < count - 1) return;
        alignas(64) double next[lanes];
        for (int j = 0; j < lanes; ++j) {
            std::int64_t const last = runs.column[j] + count - 1;
            next[j] = group().is_last[last] ? 0.0 : of_joints.origin[2 * of_joints.pitch + last + 1];
        }
        body.torque = body.torque - Real::load(next) * body.e2.column(2);
    }
    /// What the body after it leaves for a body whose joint force is wanted.
    struct PassedOn {
        Vector<Real, K> force;
        Matrix3 e1, from_ground;
        Real torque;  // about the hinge between them, within the run
    };
    Vector<Real, K> pass_on(RunsInLanes const& runs, int i, Kept const& kept, Vector3 const& omega, HingedFrame<Real> const& frame,
                            BodyAcceleration<Real> const& a, PassedOn& passed) const {
        auto body = bodies_.leaf.hinged_at_rest(bodies_.loads, Column<Real>{i % part_length});
        bodies_.leaf.add_gyroscopic(bodies_.loads, omega, body);
        if (has_wrenches())
            passed.from_ground =
                i == count - 1 ? kept.orientation() : transposed_times(passed.e1 * transpose(frame.e2), passed.from_ground);
        push(runs, i, passed.from_ground, body);
        // Its own hinge's torque is along none of the force's directions.
        body.torque = body.torque - passed.torque * body.e2.column(2);
        passed.force = inboard_force(body, a, passed.force);
        passed.e1 = frame.e1;
        passed.torque = torque_about(i);
        return passed.force;
    }
    void set_moving(RunsInLanes const& runs, int i, Vector3 const& omega, HingedFrame<Real>& frame) const {
        bodies_.leaf.set_moving(bodies_.loads, Column<Real>{i % part_length}, omega, frame);
        if (i == 0) take_first_biases(runs, frame);
    }
    /// In lanes whose runs begin a chain.
    void take_first_biases(RunsInLanes const& runs, HingedFrame<Real>& body) const {
        if (!bodies_.loads.hinge_rate.origin) return;
        alignas(64) double bias[K * lanes];
        store_vectors<Real>(bias, body.bias);
        for (int j = 0; j < lanes; ++j)
            if (group().is_first[runs.body[j]])
                for (int n = 0; n < K; ++n) bias[n * lanes + j] = work_.loads.bias.origin[n * work_.loads.bias.pitch + runs.body[j]];
        load_vectors<Real>(bias, body.bias);
    }
    /// What is wanted of the runs' last and first bodies, as Evaluation::accelerate, in the lanes where it is.
    void end_at(RunsInLanes const& runs, HingedFrame<Real> const& frame, BodyAcceleration<Real> const& a) const {
        scatter(component<Real>(work_.out.hinge_acceleration, 1), runs.column, count, Vector<Real, 1>{{about_outboard_hinge(frame, a)}});
        scatter_accelerations(runs.column, count - 1, a, [&](int j) {
            std::int64_t const next = runs.column[j] + count;
            return next >= group().size || group().is_last[next];
        });
    }
    void begin_at(RunsInLanes const& runs, unsigned begin, BodyAcceleration<Real> const& a) const {
        if (!out_.hinge_acceleration.origin) return;
        scatter_accelerations(runs.body, 0, a, [&](int j) { return (begin >> j & 1U) != 0 && group().is_first[runs.body[j]]; });
    }
    /// Of bodies body[j] + i in the lanes that are wanted(j).
    template <class Wanted>
    void scatter_accelerations(std::int64_t const* body, int i, BodyAcceleration<Real> const& a, Wanted const& wanted) const {
        bool stored = false;
        alignas(64) double numbers[6 * lanes];
        for (int j = 0; j < lanes; ++j) {
            if (!wanted(j)) continue;
            if (!stored) store_vectors<Real>(numbers, a);
            stored = true;
            for (int n = 0; n < 3; ++n) {
                work_.out.alpha.origin[n * work_.out.alpha.pitch + body[j] + i] = numbers[n * lanes + j];
                work_.out.acceleration.origin[n * work_.out.acceleration.pitch + body[j] + i] = numbers[(3 + n) * lanes + j];
            }
        }
    }
    /// The last that is known of body i of the runs.
    void turn(RunsInLanes const& runs, int i, Real const& of_hinge) {
        View<2> const& to = out_.hinge_acceleration;
        if (to.origin) write(component<Real>(to, 0), Column<Real>{i % part_length}, Vector<Real, 1>{{of_hinge}});
        if (i % part_length == 0) empty(runs, i / part_length);
    }
};

}  // namespace catena::dca
