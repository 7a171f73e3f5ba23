// Records of runs on revolute joints side by side, between the inward and the outward pass.
#pragma once

#include "dca/floating_run.hpp"
#include "dca/simd/prefetch.hpp"
#include "dca/simd/runs_in_tile.hpp"

namespace catena::dca {

/// Storage of what the outward pass needs of the runs in the lanes of one item, with the interface
/// that climb_revolutes() and descend_revolutes() need. `out`: the results that are wanted.
template <class Real, class Leaf>
struct KeptRevolutes {
    static constexpr int lanes = Real::lanes, count = static_cast<int>(longest_run);
    using Vector3 = Vector<Real, 3>;
    using Matrix3 = Matrix<Real, 3, 3>;
    RunWork<Leaf> const& work;
    AccelerationsView const& out;
    RunsInLanes const& runs;
    double* place;

    /// Stores joint i and checks its pivot.
    void put(int i, ReleasedRevolute<Real> const& revolute) {
        double* const kept = of_revolute(i);
        int const further = ahead * numbers_of_revolute + (i + ahead < count ? 0 : numbers_of_end);
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
        if (i == count - 2 || out.by_all_bodies())
            store_vectors<Real>(of_revolute(i) + at_swing, velocity_bias);
    }
    /// Stores the angular velocity of the body outboard of joint i, in the body's axes.
    void put_omega(int i, Vector3 const& omega) {
        store_vectors<Real>(of_revolute(i) + at_omega, omega);
    }
    /// Stores the axes of the last revolute joint, in the run's axes.
    void put_axes(Matrix3 const& axes) { store_vectors<Real>(place + met_numbers * lanes, axes); }
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
            prefetch<Real>(kept, -ahead * numbers_of_revolute - (i > ahead ? 0 : numbers_of_end),
                           numbers_of_revolute);
        return load<ReleasedRevolute<Real>>(kept);
    }
    BodyInRun<Real> body(int i) const {
        return load<BodyInRun<Real>>(of_revolute(i) + released_numbers * lanes);
    }
    RunsEnd<Real> end() const {
        if (prefetches()) prefetch<Real>(place, -kept_of_revolute_run * lanes, met_numbers * lanes);
        return load<RunsEnd<Real>>(place);
    }

  private:
    static constexpr int numbers_of_revolute = revolute_numbers * lanes;
    static_assert(sizeof(ReleasedRevolute<Real>) == released_numbers * sizeof(Real) &&
                  sizeof(RunsEnd<Real>) == met_numbers * sizeof(Real) &&
                  sizeof(BodyInRun<Real>) == passed_body_numbers * sizeof(Real));
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
    bool prefetches() const { return work.prefetches; }
    /// Returns the storage of joint i and the body outboard of it.
    double* of_revolute(int i) const {
        return place + end_numbers * lanes + (i - 1) * numbers_of_revolute;
    }
    /// Records pivot failures. Skipped columns and the first body of a lane's run have no joint
    /// within the run.
    void watch(int i, unsigned bad) const {
        for (int j = 0; bad != 0 && j < lanes; ++j)
            if (i <= runs.skipped[j]) bad &= ~(1U << j);
        note_lost<Real>(work.sweeps, runs.column, i, bad);
    }
};

}  // namespace catena::dca
