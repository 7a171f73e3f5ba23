// A run on revolute joints in the fused sweep (fused_sweep.hpp), computed by articulated-body
// inertias (floating_run.hpp). Host and device.
#pragma once

#include <cstddef>

#include "dca/run_kinematics.hpp"
#include "dca/run_workspace.hpp"

namespace catena::dca {

/// One run, with the arrays, loads and results of its sweep.
template <class Leaf>
struct RevoluteRun {
    static constexpr int K = Leaf::K;
    using Sweeps = TreeSweeps<Leaf>;
    using Segment = BiasedSegment<double, K>;
    using Directions = typename Sweeps::Directions;
    Sweeps const& s;
    LoadsView const& loads;
    AccelerationsView const& out;
    Run run;

    /// True if the run has two bodies or more on revolute joints and no jointed tip. Others are
    /// eliminated part by part.
    CATENA_HD bool is_on_revolutes() const {
        bool revolutes =
            run.count > 1 && !has_jointed_tip(s.leaf.group(), run.body + run.count - 1);
        if (run.count == longest_run) {  // The unrolled loop issues all reads together.
            CATENA_UNROLL
            for (int i = 1; i < longest_run; ++i) revolutes &= s.restricted[run.body + i] == K;
            return revolutes;
        }
        for (int i = 1; i < run.count; ++i) revolutes &= s.restricted[run.body + i] == K;
        return revolutes;
    }
    /// Inward pass: returns the segment of the run and stores what descend() needs.
    CATENA_HD_IN_PLACE Segment climb() const {
        RunWorkspace<Sweeps> kept(s, run, goes_by_all());
        int const count = static_cast<int>(run.count);
        Segment segment;
        if (follows()) {
            RunWithLoads<Leaf> const loaded = with_loads();
            segment = climb_revolutes<double>(
                count, FollowedBodies<Leaf, RunWorkspace<Sweeps>>(loaded, goes_by_all(), kept),
                [&](int i) { return loaded.torque_about(i); }, kept);
        } else {
            auto const body = [&](int i) { return s.leaf.revolute(loads, run.body + i); };
            segment = climb_revolutes<double>(
                count, BodiesOfRun<double, decltype(body)>(body), [](int) { return Undriven{}; },
                kept);
        }
        s.note(kept.lost());
        return segment;
    }
    /// Outward pass. `first` is the force at the first joint, `next` that at the joint after the
    /// run.
    CATENA_HD_IN_PLACE void descend(Directions const& first, Directions const& next) const {
        RunWorkspace<Sweeps> const kept(s, run, goes_by_all());
        typename RunWithLoads<Leaf>::PassedOn passed{next};
        Directions& outboard = passed.force;
        descend_revolutes<double>(
            static_cast<int>(run.count), goes_by_all(), [&](int i) { return frame(kept, i); }, kept,
            first, next,
            [&](int i, RevoluteFrame<double> const& frame, BodyAcceleration<double> const& a) {
                std::int64_t const k = run.body + i;
                accelerate(i, frame, a);
                if (!out.joint_force) return;
                if (i == 0)
                    outboard = first;
                else if (follows())
                    with_loads().pass_on(i, frame, a, kept, passed);
                else
                    outboard = inboard_force(s.leaf.revolute(loads, k), a, outboard);
                write_directions<K>(out.joint_force, k, outboard);
            },
            [](int, BodyAcceleration<double>&) {},
            [&](int i, double of_revolute) { joint_acceleration(i, of_revolute); });
    }
    /// True if velocities within runs are computed along the run (RevoluteLoads).
    CATENA_HD bool follows() const { return loads.revolutes.given; }
    /// Returns the run together with its loads.
    CATENA_HD RunWithLoads<Leaf> with_loads() const { return {s.leaf, loads, run}; }
    /// Returns the kinematics of body i for the outward pass.
    CATENA_HD RevoluteFrame<double> frame(RunWorkspace<Sweeps> const& kept, int i) const {
        return follows() ? with_loads().frame(i, kept) : s.leaf.revolute_frame(loads, run.body + i);
    }
    /// True if results of every body are requested.
    CATENA_HD bool goes_by_all() const { return out.by_all_bodies(); }
    /// Writes the requested results of body i. `a` is its acceleration in its own axes.
    CATENA_HD void accelerate(int i, RevoluteFrame<double> const& frame,
                              BodyAcceleration<double> const& a) const {
        std::int64_t const k = run.body + i;
        if (out.revolute_acceleration.origin) {
            bool const begins = i == 0, ends = i == static_cast<int>(run.count) - 1;
            if (begins) out.revolute_acceleration.at(k, 0) = about_inboard_revolute(frame, a);
            if (ends) out.revolute_acceleration.at(k + 1, 1) = about_outboard_revolute(frame, a);
            if (!(begins && begins_chain(s.leaf.group(), k)) &&
                !(ends && comes_before_one(s.leaf.group(), k)))
                return;
        }
        if (!out.acceleration.origin) return;
        write(out.alpha, k, a.alpha);
        write(out.acceleration, k, a.a);
    }
    /// Writes the joint acceleration of the revolute joint inboard of body i.
    CATENA_HD void joint_acceleration(int i, double of_revolute) const {
        if (out.revolute_acceleration.origin)
            out.revolute_acceleration.at(run.body + i, 0) = of_revolute;
    }
    /// Stores row `i` of the segment. The numbers lie where the matrix and the bias as a whole
    /// would put them.
    CATENA_HD void store_row(int i, SegmentRow<double, K> const& row) const {
        constexpr int at_z22 = Symmetric<double, K>::size, at_z12 = 2 * at_z22;
        using Matrices = SegmentMatrix<double, K>;
        static_assert(offsetof(Matrices, z22) == at_z22 * sizeof(double) &&
                      offsetof(Matrices, z12) == at_z12 * sizeof(double));
        int const begin = i * (i + 1) / 2;
        CATENA_UNROLL
        for (int j = 0; j < K; ++j) {
            if (j <= i) {
                s.matrices.number(run.slot, begin + j) = row.z11[j];
                s.matrices.number(run.slot, at_z22 + begin + j) = row.z22[j];
            }
            s.matrices.number(run.slot, at_z12 + i * K + j) = row.z12[j];
        }
        s.biases.number(run.slot, i) = row.b1;
        s.biases.number(run.slot, K + i) = row.b2;
    }
};

}  // namespace catena::dca
