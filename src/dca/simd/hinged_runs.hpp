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
    using Base::work_, Base::bodies_, Base::out_, Base::fill, Base::empty;
    static_assert(sizeof(ReleasedHinge<Real>) == hinge_numbers * sizeof(Real) && sizeof(RunsEnd<Real>) == end_numbers * sizeof(Real));

  public:
    explicit HingedRunsSideBySide(RunWork<Leaf> const& work) : Base(work) {}

    void climb(std::int64_t item) {
        RunsInLanes const& runs = work_.runs[item];
        Kept kept{*this, runs, place_of(item)};
        auto const segment = climb_hinges<Real>(
            count,
            [&](int i) {
                if (i % part_length == 0) fill(runs, i / part_length, 1);
                auto body = bodies_.leaf.hinged(bodies_.loads, Column<Real>{i % part_length});
                if (i == 0) take_first_biases(runs, body);
                return body;
            },
            kept);
        scatter<Real>(segment.matrix, work_.sweeps.matrices, runs.slot);
        scatter<Real>(segment.bias, work_.sweeps.biases, runs.slot);
    }
    void descend(std::int64_t item) {
        RunsInLanes const& runs = work_.runs[item];
        Vector<Real, K> first, next;
        gather<Real>(work_.sweeps.forces, runs.body, first);
        gather<Real>(work_.sweeps.forces, runs.next, next);
        Vector<Real, K> outboard = next;
        descend_hinges<Real, false>(
            count,
            [&](int i) {
                if (i % part_length == part_length - 1) fill(runs, i / part_length, -1);
                auto body = bodies_.leaf.hinged_frame(bodies_.loads, Column<Real>{i % part_length});
                if (i == 0) take_first_biases(runs, body);
                return body;
            },
            Kept{*this, runs, place_of(item)}, first, next,
            [&](int i, HingedFrame<Real> const& frame, BodyAcceleration<Real> const& a) {
                Column<Real> const here{i % part_length};
                if (out_.acceleration.origin) {
                    write(out_.alpha, here, a.alpha);
                    write(out_.acceleration, here, a.a);
                }
                if (out_.hinge_acceleration.origin && i == count - 1) end_at(runs, frame, a);
                if (out_.joint_force) {
                    outboard = i == 0 ? first : inboard_force(bodies_.leaf.hinged(bodies_.loads, here), a, outboard);
                    write_directions<K>(out_.joint_force, here, outboard);
                }
                if (i == 0) begin_at(runs, frame, a);
            },
            [&](int i, Real const& of_hinge) { turn(runs, i, of_hinge); });
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
            prefetch<Real>(place, -kept_of_hinged_run * lanes, numbers_of_end);
            load_vectors<Real>(place, e);
            return e;
        }

      private:
        // What is asked for is so many hinges further, in the order of items: the next one's end lies between.
        static constexpr int ahead = 4, numbers_of_end = end_numbers * lanes;
        double* of_hinge(int i) const { return place + end_numbers * lanes + (i - 1) * numbers_of_hinge; }
        void watch(int i, unsigned bad) const { note_lost<Real>(all.work_.sweeps, runs.body, i, bad); }
    };
    double* place_of(std::int64_t item) const { return work_.nodes + item * kept_of_hinged_run * lanes; }
    GroupView const& group() const { return work_.group; }
    template <class Condition>
    static bool any(RunsInLanes const& runs, Condition const& of_first_body) {
        bool found = false;
        for (int j = 0; j < lanes; ++j) found = found || of_first_body(runs.body[j]);
        return found;
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
    /// What is wanted of the runs' last and first bodies, as Evaluation::accelerate.
    void end_at(RunsInLanes const& runs, HingedFrame<Real> const& frame, BodyAcceleration<Real> const& a) const {
        scatter(component<Real>(work_.out.hinge_acceleration, 1), runs.body, count, Vector<Real, 1>{{about_outboard_hinge(frame, a)}});
        if (any(runs, [&](std::int64_t body) { return body + count >= group().size || group().is_last[body + count]; }))
            scatter_accelerations(runs, count - 1, a);
    }
    void begin_at(RunsInLanes const& runs, HingedFrame<Real> const& frame, BodyAcceleration<Real> const& a) {
        if (out_.hinge_acceleration.origin && any(runs, [&](std::int64_t body) { return group().is_first[body]; }))
            scatter_accelerations(runs, 0, a);
        turn(runs, 0, about_inboard_hinge(frame, a));
    }
    void scatter_accelerations(RunsInLanes const& runs, int i, BodyAcceleration<Real> const& a) const {
        scatter(work_.out.alpha, runs.body, i, a.alpha);
        scatter(work_.out.acceleration, runs.body, i, a.a);
    }
    /// The last that is known of body i of the runs.
    void turn(RunsInLanes const& runs, int i, Real const& of_hinge) {
        View<2> const& to = out_.hinge_acceleration;
        if (to.origin) write(component<Real>(to, 0), Column<Real>{i % part_length}, Vector<Real, 1>{{of_hinge}});
        if (i % part_length == 0) empty(runs, i / part_length);
    }
};

}  // namespace catena::dca
