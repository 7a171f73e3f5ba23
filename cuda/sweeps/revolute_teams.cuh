// Passes of runs on revolute joints by several lanes of a warp, for chains with fewer runs than a
// GPU has threads. Each lane computes what does not depend on other bodies for one body at a time
// and stores it in shared memory. In the inward pass all lanes have the articulated-body inertia,
// and six of them have one of the six wrenches each (floating_run.hpp). At the end each has a row
// of the segment. team_launches.cuh has the kernels. Results are bitwise those of one thread's
// climb_revolutes() and descend_revolutes(). tests/support/cuda_on_host.hpp, included first, makes
// this file compile on the host.
#pragma once

#include "cuda/sweeps/prepared_bodies.cuh"

namespace catena::cuda::kernels {

/// Team of lanes that eliminates one run in the inward pass. All lanes of a warp call its members
/// together. Teams of the warp may have different numbers of bodies unless `whole`.
template <bool whole>
class RevoluteTeam {
    using Body = dca::ArticulatedBody<double>;
    using Wrench = dca::Wrench<double>;
    using VelocityBias = dca::BodyAcceleration<double>;
    using Ahead = BodiesAhead;
    using Column = Vector<double, 6>;
    // Wrenches 0 to 4 are `first`, wrench 5 is the bias. Lane w holds wrench w.
    static constexpr int bias = 5;
    static_assert(bias < lanes_of_team);

  public:
    /// `works`: false for a team that only accompanies the warp's other teams.
    __device__ RevoluteTeam(BodiesOfTeam<whole> const& bodies, int lane, bool works)
        : team_(bodies, lane, works), most_(bodies.most(lane)), prepared_(team_) {}

    /// Eliminates the run as dca::climb_revolutes() does. put_row(i, dca::SegmentRow) is called by
    /// the lane that holds row i.
    template <class BodyOf, class Kept, class PutRow>
    __device__ __forceinline__ void climb(BodyOf const& body, Ahead const& ahead, Kept& kept,
                                          PutRow const& put_row) {
        TurnedBody const last_one = prepared_.prepare(body, ahead, kept);
        begin(body(0));
        go_on<dca::Undriven>(ahead, kept);
        dca::OutboardHandle<double> const before = team_.of_lane(
            dca::OutboardHandle<double>{last_one.rotation * last_one.axes2, last_one.inward},
            team_.before_last());
        end(before, body(team_.bodies.last()), dca::Undriven{}, kept, put_row);
    }
    /// Eliminates a run whose loads at revolute joints are given. `all`: as for FollowedBodies.
    template <class Leaf, class Kept, class PutRow>
    __device__ __forceinline__ void climb(dca::RunWithLoads<Leaf> const& loaded, bool all,
                                          Ahead const& ahead, Kept& kept, PutRow const& put_row) {
        dca::FollowedState<double> const last_one = prepared_.follow(loaded, all, ahead, kept);
        begin(loaded.first());
        go_on<double>(ahead, kept);
        dca::OutboardHandle<double> const before{
            to_matrix_of_unit(last_one.rotation) * loaded.axes2(team_.bodies.last() - 1),
            last_one.inward};
        Body const last =
            loaded.last(before.axes, last_one.omega, ByLeader<Kept>{kept, team_.leads()});
        end(before, last, loaded.torque_about(team_.bodies.last()), kept, put_row);
    }

  private:
    /// Storage that only the team's first lane writes.
    template <class Kept>
    struct ByLeader {
        Kept& kept;
        bool leads;
        __device__ void put_omega(int i, Vec3 const& omega) const {
            if (leads) kept.put_omega(i, omega);
        }
        __device__ void put_orientation(Mat3 const& from_ground) const {
            if (leads) kept.put_orientation(from_ground);
        }
    };

    /// Starts the inward pass with the run's first body.
    __device__ __forceinline__ void begin(Body const& body) {
        all_ = inertia_of(body);
        wrench_ = bias_of(body);
        CATENA_UNROLL
        for (int j = 0; j < bias; ++j)
            if (j == team_.own) {
                wrench_ = first_of(body, j);
                e_ = row_of_first(body, j);
            }
        CATENA_UNROLL
        for (int i = 0; i < bias; ++i) row_[i] = 0;
    }
    /// Adds all bodies but the first and the last to the articulated-body inertia and to the
    /// wrenches. `Torque`: as for dca::release_driven.
    template <class Torque, class Kept>
    __device__ __forceinline__ void go_on(Ahead const& ahead, Kept& kept) {
        CATENA_NO_UNROLL
        for (int i = 1; i < most_ - 1; ++i) {
            bool const goes = whole || team_.bodies.is_within(i);
            BodyAhead const next = ahead.get(i - 1);
            dca::ReleasedRevolute<double> const revolute =
                pass_revolute(next.axis, torque_of<Torque>(next.torque_about), goes);
            if (!goes) continue;
            move_point(wrench_, next.across);
            if (has_bias()) add_load(wrench_, next.load);
            move_point(all_, next.across);
            add_body(all_, next.body);
            if (team_.leads()) kept.put(i, revolute);
        }
    }
    template <class Torque>
    __device__ static Torque torque_of(double torque) {
        if constexpr (std::is_same_v<Torque, double>)
            return torque;
        else
            return {};
    }
    /// Passes a revolute joint about `axis`. `goes`: false if the team only accompanies other
    /// teams.
    template <class Torque>
    __device__ __forceinline__ dca::ReleasedRevolute<double> pass_revolute(Vec3 const& axis,
                                                                           Torque const& torque,
                                                                           bool goes = true) {
        dca::ReleasedRevolute<double> h;
        double along = 0;
        if (goes) {
            dca::Release<double> const r = release_revolute(all_, axis, h);
            // Adding -0 leaves the wrenches that are not the bias unchanged, bit by bit.
            if constexpr (std::is_same_v<Torque, double>)
                along = release_driven(wrench_, r, has_bias() ? torque : -0.0);
            else
                along = release_revolute(wrench_, r);
        }
        CATENA_UNROLL
        for (int j = 0; j < bias; ++j) h.first[j] = team_.of_lane(along, j);
        h.bias = team_.of_lane(along, bias);
        if (goes) gain_row(h, along, bias - 1, row_, e_);
        return h;
    }
    /// Ends the run and writes the rows of its segment, as dca::end_run() and dca::segment_of() do.
    template <class Torque, class Kept, class PutRow>
    __device__ __forceinline__ void end(dca::OutboardHandle<double> const& before, Body const& last,
                                        Torque const& torque, Kept& kept, PutRow const& put_row) {
        add_velocity_bias(prepared_.velocity_bias_before_last());
        Mat3 const rotation = transpose(before.axes);
        rotate_axes(all_, rotation);
        rotate_axes(wrench_, rotation);
        dca::ReleasedRevolute<double> const revolute =
            pass_revolute(dca::last_axis<double>(), torque);
        leave_revolute(all_);
        wrench_.torque[2] = 0;
        if (has_bias()) wrench_.torque[2] = dca::left_along_revolute<double>(torque);
        add_velocity_bias(last_difference(last, rotation * before.inward));

        dca::LastBody<double> const body = last_body(last);
        Symmetric<double, 6> const factor = dca::factorize(inertia_of_end(all_, body), 6);
        if (team_.leads()) {
            kept.put(team_.bodies.last(), revolute);
            kept.put(factor);
            kept.put_axes(before.axes);
        }
        dca::Handle<double, 5> const handle = handle2_of_end(last);
        // L^-1 times the wrenches; on the lane of the bias, L^-1 times the bias.
        Column first = has_bias() ? bias_of_end(wrench_, body)
                                  : dca::six_of(wrench_.force, wrench_.torque),
               second = second_of(handle, 0);
        if (team_.works && team_.own < bias) kept.put_first(team_.own, first);
        if (team_.works && has_bias()) kept.put_bias(first);
        CATENA_UNROLL
        for (int j = 1; j < bias; ++j)
            if (j == team_.own) second = second_of(handle, j);
        first = dca::solve_lower(factor, first);
        second = dca::solve_lower(factor, second);
        dca::SegmentRow<double, 5> row;
        CATENA_UNROLL
        for (int j = 0; j < bias; ++j) {
            Column const first_j = team_.of_lane(first, j), second_j = team_.of_lane(second, j);
            row.z11[j] = row_[j] + dca::product(factor, first, first_j);
            row.z12[j] = dca::product(factor, first, second_j);
            row.z22[j] = dca::product(factor, second, second_j);
        }
        Column const of_bias = team_.of_lane(first, bias);
        Vector<double, 5> const beyond = bias_beyond(handle, last);
        double own_beyond = beyond[0];
        CATENA_UNROLL
        for (int j = 1; j < bias; ++j)
            if (j == team_.own) own_beyond = beyond[j];
        row.b1 = e_ - dca::product(factor, first, of_bias);
        row.b2 = own_beyond - dca::product(factor, second, of_bias);
        if (team_.works && team_.own < bias) put_row(team_.own, row);
    }
    /// Subtracts the acceleration difference `d` of a joint's two sides from the bias and the row.
    __device__ __forceinline__ void add_velocity_bias(VelocityBias const& d) {
        dca::add_velocity_bias(e_, wrench_, d);
        if (has_bias()) dca::add_velocity_bias(wrench_, all_, d);
    }
    /// True if the lane's wrench is the bias.
    __device__ bool has_bias() const { return team_.own == bias; }

    TeamLanes<whole> team_;
    int most_;  // largest number of bodies of the warp's teams
    PreparedBodies<whole> prepared_;
    /// Articulated-body inertia of the bodies so far.
    dca::SpatialInertia<double> all_;
    Wrench wrench_;
    double row_[bias], e_ = 0;
};

}  // namespace catena::cuda::kernels
