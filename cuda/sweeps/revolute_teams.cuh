// Passes of runs on revolute joints by several lanes of a warp, for chains with fewer runs than a
// GPU has threads. Each lane computes what does not depend on other bodies for one body at a time
// and stores it in shared memory. In the inward pass all lanes have the articulated-body inertia,
// and six of them have one of the six wrenches each (floating_run.hpp). At the end each has a row
// of the segment. team_launches.cuh has the kernels. Results are bitwise those of one thread's
// climb_revolutes() and descend_revolutes(). tests/support/cuda_on_host.hpp, included first, makes
// this file compile on the host.
#pragma once

#include "cuda/sweeps/team_memory.cuh"

namespace catena::cuda::kernels {

/// Team of lanes that eliminates one run in the inward pass. All lanes of a warp call its members
/// together. Teams of the warp may have different numbers of bodies unless `whole`.
template <bool whole>
class RevoluteTeam {
    using Body = dca::ArticulatedBody<double>;
    using Wrench = dca::Wrench<double>;
    using VelocityBias = dca::BodyAcceleration<double>;
    using InRun = dca::LoadedBodyInRun<double>;
    using Ahead = BodiesAhead;
    using Column = Vector<double, 6>;
    // Wrenches 0 to 4 are `first`, wrench 5 is the bias. Lane w holds wrench w.
    static constexpr int bias = 5;
    static_assert(bias < lanes_of_team);

  public:
    /// `works`: false for a team that only accompanies the warp's other teams.
    __device__ RevoluteTeam(BodiesOfTeam<whole> const& bodies, int lane, bool works)
        : bodies_(bodies),
          own_(lane % lanes_of_team),
          leader_(lane - own_),
          most_(bodies.most(lane)),
          works_(works) {}
    __device__ bool leads() const { return works_ && own_ == 0; }

    /// Eliminates the run as dca::climb_revolutes() does. put_row(i, dca::SegmentRow) is called by
    /// the lane that holds row i.
    template <class BodyOf, class Kept, class PutRow>
    __device__ __forceinline__ void climb(BodyOf const& body, Ahead const& ahead, Kept& kept,
                                          PutRow const& put_row) {
        Prepared const last_one = prepare(body, ahead, kept);
        begin(body(0));
        go_on<dca::Undriven>(ahead, kept);
        dca::OutboardHandle<double> const before = of_lane(
            dca::OutboardHandle<double>{last_one.rotation * last_one.axes2, last_one.inward},
            before_last());
        end(before, body(bodies_.last()), dca::Undriven{}, kept, put_row);
    }
    /// Eliminates a run whose loads at revolute joints are given. `all`: as for FollowedBodies.
    template <class Leaf, class Kept, class PutRow>
    __device__ __forceinline__ void climb(dca::RunWithLoads<Leaf> const& loaded, bool all,
                                          Ahead const& ahead, Kept& kept, PutRow const& put_row) {
        dca::FollowedState<double> const last_one = follow(loaded, all, ahead, kept);
        begin(loaded.first());
        go_on<double>(ahead, kept);
        dca::OutboardHandle<double> const before{
            to_matrix_of_unit(last_one.rotation) * loaded.axes2(bodies_.last() - 1),
            last_one.inward};
        Body const last = loaded.last(before.axes, last_one.omega, ByLeader<Kept>{kept, leads()});
        end(before, last, loaded.torque_about(bodies_.last()), kept, put_row);
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

    /// State of a body that the following bodies need; see dca::BodiesOfRun::State.
    struct Prepared {
        Mat3 rotation, axes2;
        Vec3 inward;
    };
    /// Prepares all bodies and stores what the inward pass needs. Returns the state of the lane's
    /// own body.
    template <class BodyOf, class Kept>
    __device__ __forceinline__ Prepared prepare(BodyOf const& body, Ahead const& ahead,
                                                Kept& kept) {
        Body const here = body(bodies_.body_or_last(own_));
        Mat3 const mine =
            along(Mat3::identity(), here.rotation_to(one_before(here.e2, Mat3::identity())),
                  [](Mat3& t, Mat3 const& to_before) { t = t * to_before; });
        Vec3 const inward = mine * here.inward2;
        put_ahead(dca::in_run(here, mine, one_before(inward, Vec3::zero())), 0.0, ahead, kept);
        __syncwarp();
        return {mine, here.e2, inward};
    }
    /// Computes the motion along the run and prepares all bodies, as FollowedBodies does. Returns
    /// the state of the last body but one.
    template <class Leaf, class Kept>
    __device__ __forceinline__ dca::FollowedState<double> follow(
        dca::RunWithLoads<Leaf> const& loaded, bool all, Ahead const& ahead, Kept& kept) {
        /// Axis of a revolute joint in the run's axes, and its rate.
        struct Turning {
            Vec3 axis;
            double rate;
        };
        dca::FollowedState<double> own{Quat::identity(), loaded.first_omega(),
                                       loaded.first_inward()};
        int const read = bodies_.body_or_last(own_);
        dca::BodyOnRevolute<double> const here = loaded.on_revolute(read);
        Vec3 const first_omega = own.omega;
        own.rotation =
            along(own.rotation, here.rotation, [](Quat& t, Quat const& next) { t = t * next; });
        Mat3 const mine = to_matrix_of_unit(own.rotation);
        Vec3 const after =
            along(first_omega, Turning{mine * here.axis, here.rate},
                  [](Vec3& w, Turning const& next) { w = plus_scaled(w, next.rate, next.axis); });
        dca::FollowedBody<double> const body =
            dca::follow(here, mine, one_before(after, first_omega));
        Vec3 const inward = own_ == 0 ? own.inward : body.inward2;
        own.inward = one_before(inward, own.inward);
        InRun in_run = own.go_on(body);
        own.inward = inward;
        loaded.add_wrench(read, in_run);
        put_ahead(in_run, loaded.torque_about(read), ahead, kept);
        if (works_ && bodies_.is_within(own_) && (all || own_ == bodies_.last() - 1))
            kept.put_omega(own_, transposed_times(mine, own.omega));
        __syncwarp();
        return of_lane(own, before_last());
    }
    /// Lane that holds the last body but one.
    __device__ int before_last() const { return bodies_.last() - 1; }
    /// Stores what the inward pass needs of the bodies, one per lane.
    template <class Kept>
    __device__ __forceinline__ void put_ahead(InRun const& body, double torque_about,
                                              Ahead const& ahead, Kept& kept) {
        /// Terms of a body by which the velocity bias is propagated.
        struct VelocityBiasTerms {
            VelocityBias difference;
            Vec3 across;
        };
        velocity_bias_ =
            along(VelocityBias{Vec3::zero(), Vec3::zero()},
                  VelocityBiasTerms{body.difference, body.across},
                  [](VelocityBias& s, VelocityBiasTerms const& next) { swing_on(s, next); });
        if (!bodies_.is_within(own_)) return;
        ahead.put(own_ - 1,
                  {body, torque_about, dca::added_body(body.mass, body.inertia, body.centre),
                   about_point(load_of(body, velocity_bias_), body.centre)});
        if (works_) kept.put(own_, body, velocity_bias_);
    }

    /// Starts the inward pass with the run's first body.
    __device__ __forceinline__ void begin(Body const& body) {
        all_ = inertia_of(body);
        wrench_ = bias_of(body);
        CATENA_UNROLL
        for (int j = 0; j < bias; ++j)
            if (j == own_) {
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
            bool const goes = whole || bodies_.is_within(i);
            BodyAhead const next = ahead.get(i - 1);
            dca::ReleasedRevolute<double> const revolute =
                pass_revolute(next.axis, torque_of<Torque>(next.torque_about), goes);
            if (!goes) continue;
            move_point(wrench_, next.across);
            if (has_bias()) add_load(wrench_, next.load);
            move_point(all_, next.across);
            add_body(all_, next.body);
            if (leads()) kept.put(i, revolute);
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
        for (int j = 0; j < bias; ++j) h.first[j] = of_lane(along, j);
        h.bias = of_lane(along, bias);
        if (goes) gain_row(h, along, bias - 1, row_, e_);
        return h;
    }
    /// Ends the run and writes the rows of its segment, as dca::end_run() and dca::segment_of() do.
    template <class Torque, class Kept, class PutRow>
    __device__ __forceinline__ void end(dca::OutboardHandle<double> const& before, Body const& last,
                                        Torque const& torque, Kept& kept, PutRow const& put_row) {
        add_velocity_bias(of_lane(velocity_bias_, before_last()));
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
        if (leads()) {
            kept.put(bodies_.last(), revolute);
            kept.put(factor);
            kept.put_axes(before.axes);
        }
        dca::Handle<double, 5> const handle = handle2_of_end(last);
        // L^-1 times the wrenches; on the lane of the bias, L^-1 times the bias.
        Column first = has_bias() ? bias_of_end(wrench_, body)
                                  : dca::six_of(wrench_.force, wrench_.torque),
               second = second_of(handle, 0);
        if (works_ && own_ < bias) kept.put_first(own_, first);
        if (works_ && has_bias()) kept.put_bias(first);
        CATENA_UNROLL
        for (int j = 1; j < bias; ++j)
            if (j == own_) second = second_of(handle, j);
        first = dca::solve_lower(factor, first);
        second = dca::solve_lower(factor, second);
        dca::SegmentRow<double, 5> row;
        CATENA_UNROLL
        for (int j = 0; j < bias; ++j) {
            Column const first_j = of_lane(first, j), second_j = of_lane(second, j);
            row.z11[j] = row_[j] + dca::product(factor, first, first_j);
            row.z12[j] = dca::product(factor, first, second_j);
            row.z22[j] = dca::product(factor, second, second_j);
        }
        Column const of_bias = of_lane(first, bias);
        Vector<double, 5> const beyond = bias_beyond(handle, last);
        double own_beyond = beyond[0];
        CATENA_UNROLL
        for (int j = 1; j < bias; ++j)
            if (j == own_) own_beyond = beyond[j];
        row.b1 = e_ - dca::product(factor, first, of_bias);
        row.b2 = own_beyond - dca::product(factor, second, of_bias);
        if (works_ && own_ < bias) put_row(own_, row);
    }
    /// Subtracts the acceleration difference `d` of a joint's two sides from the bias and the row.
    __device__ __forceinline__ void add_velocity_bias(VelocityBias const& d) {
        dca::add_velocity_bias(e_, wrench_, d);
        if (has_bias()) dca::add_velocity_bias(wrench_, all_, d);
    }
    /// True if the lane's wrench is the bias.
    __device__ bool has_bias() const { return own_ == bias; }

    /// Calls step(state, value) with the values of the team's lanes in order, except for the run's
    /// first body. Returns the state after the lane's own value.
    template <class State, class T, class Step>
    __device__ __forceinline__ State along(State state, T const& value, Step const& step) const {
        constexpr int few = 4;  // exchanges in flight together
        State own = state;
        CATENA_NO_UNROLL
        for (int begin = 0; begin < lanes_of_team; begin += few) {
            CATENA_UNROLL
            for (int i = 0; i < few; ++i) {
                int const lane = begin + i;
                T const here = of_lane(value, lane);
                if (i > 0 || begin > 0) step(state, here);
                if (lane == own_) own = state;
            }
        }
        return own;
    }
    /// Returns the value of the lane before; for lane 0, `of_first`.
    template <class T>
    __device__ T one_before(T const& value, T const& of_first) const {
        T const before = from_lane(value, leader_ + (own_ + lanes_of_team - 1) % lanes_of_team);
        return dca::either(own_ > 0, before, of_first);
    }
    /// Returns the value of lane `lane` of the team.
    template <class T>
    __device__ T of_lane(T const& value, int lane) const {
        return from_lane(value, leader_ + lane);
    }

    BodiesOfTeam<whole> bodies_;
    int own_, leader_;  // lane in the team, and the team's first lane in the warp
    int most_;          // largest number of bodies of the warp's teams
    bool works_;
    VelocityBias velocity_bias_;  // velocity bias of the lane's own body
    /// Articulated-body inertia of the bodies so far.
    dca::SpatialInertia<double> all_;
    Wrench wrench_;
    double row_[bias], e_ = 0;
};

}  // namespace catena::cuda::kernels
