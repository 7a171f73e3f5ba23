// Bodies of a run on revolute joints, prepared by a team of lanes: each lane computes what does not
// depend on other bodies for one body (revolute_teams.cuh). tests/support/cuda_on_host.hpp,
// included first, makes this file compile on the host.
#pragma once

#include "cuda/sweeps/team_memory.cuh"

namespace catena::cuda::kernels {

/// A lane's place in its team, and exchanges of values with the team's other lanes. All lanes of a
/// warp call along(), one_before() and of_lane() together.
template <bool whole>
struct TeamLanes {
    BodiesOfTeam<whole> bodies;
    int own, leader;  // lane in the team, and the team's first lane in the warp
    bool works;       // false for a team that only accompanies the warp's other teams

    __device__ TeamLanes(BodiesOfTeam<whole> const& of_team, int lane, bool team_works)
        : bodies(of_team), own(lane % lanes_of_team), leader(lane - own), works(team_works) {}
    __device__ bool leads() const { return works && own == 0; }
    /// Lane that holds the last body but one.
    __device__ int before_last() const { return bodies.last() - 1; }
    /// Calls step(state, value) with the values of the team's lanes in order, except for the run's
    /// first body. Returns the state after the lane's own value.
    template <class State, class T, class Step>
    __device__ __forceinline__ State along(State state, T const& value, Step const& step) const {
        constexpr int few = 4;  // exchanges in flight together
        State of_own = state;
        CATENA_NO_UNROLL
        for (int begin = 0; begin < lanes_of_team; begin += few) {
            CATENA_UNROLL
            for (int i = 0; i < few; ++i) {
                int const lane = begin + i;
                T const here = of_lane(value, lane);
                if (i > 0 || begin > 0) step(state, here);
                if (lane == own) of_own = state;
            }
        }
        return of_own;
    }
    /// Returns the value of the lane before; for lane 0, `of_first`.
    template <class T>
    __device__ T one_before(T const& value, T const& of_first) const {
        T const before = from_lane(value, leader + (own + lanes_of_team - 1) % lanes_of_team);
        return dca::either(own > 0, before, of_first);
    }
    /// Returns the value of lane `lane` of the team.
    template <class T>
    __device__ T of_lane(T const& value, int lane) const {
        return from_lane(value, leader + lane);
    }
};

/// State of a body that the following bodies need; see dca::BodiesOfRun::State.
struct TurnedBody {
    Mat3 rotation, axes2;
    Vec3 inward;
};

/// Prepares the bodies of a run, one per lane. It holds the velocity bias of the lane's body.
template <bool whole>
class PreparedBodies {
    using Body = dca::ArticulatedBody<double>;
    using VelocityBias = dca::BodyAcceleration<double>;
    using InRun = dca::LoadedBodyInRun<double>;
    using Ahead = BodiesAhead;

  public:
    __device__ explicit PreparedBodies(TeamLanes<whole> const& team) : team_(team) {}
    /// Prepares all bodies and stores what the inward pass needs. Returns the state of the lane's
    /// own body.
    template <class BodyOf, class Kept>
    __device__ __forceinline__ TurnedBody prepare(BodyOf const& body, Ahead const& ahead,
                                                  Kept& kept) {
        Body const here = body(team_.bodies.body_or_last(team_.own));
        Mat3 const mine = team_.along(Mat3::identity(),
                                      here.rotation_to(team_.one_before(here.e2, Mat3::identity())),
                                      [](Mat3& t, Mat3 const& to_before) { t = t * to_before; });
        Vec3 const inward = mine * here.inward2;
        put_ahead(dca::in_run(here, mine, team_.one_before(inward, Vec3::zero())), 0.0, ahead,
                  kept);
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
        int const read = team_.bodies.body_or_last(team_.own);
        dca::BodyOnRevolute<double> const here = loaded.on_revolute(read);
        Vec3 const first_omega = own.omega;
        own.rotation = team_.along(own.rotation, here.rotation,
                                   [](Quat& t, Quat const& next) { t = t * next; });
        Mat3 const mine = to_matrix_of_unit(own.rotation);
        Vec3 const after = team_.along(
            first_omega, Turning{mine * here.axis, here.rate},
            [](Vec3& w, Turning const& next) { w = plus_scaled(w, next.rate, next.axis); });
        dca::FollowedBody<double> const body =
            dca::follow(here, mine, team_.one_before(after, first_omega));
        Vec3 const inward = team_.own == 0 ? own.inward : body.inward2;
        own.inward = team_.one_before(inward, own.inward);
        InRun in_run = own.go_on(body);
        own.inward = inward;
        loaded.add_wrench(read, in_run);
        put_ahead(in_run, loaded.torque_about(read), ahead, kept);
        if (team_.works && team_.bodies.is_within(team_.own) &&
            (all || team_.own == team_.bodies.last() - 1))
            kept.put_omega(team_.own, transposed_times(mine, own.omega));
        __syncwarp();
        return team_.of_lane(own, team_.before_last());
    }
    /// Returns the velocity bias of the last body but one.
    __device__ VelocityBias velocity_bias_before_last() const {
        return team_.of_lane(velocity_bias_, team_.before_last());
    }

  private:
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
            team_.along(VelocityBias{Vec3::zero(), Vec3::zero()},
                        VelocityBiasTerms{body.difference, body.across},
                        [](VelocityBias& s, VelocityBiasTerms const& next) { swing_on(s, next); });
        if (!team_.bodies.is_within(team_.own)) return;
        ahead.put(team_.own - 1,
                  {body, torque_about, dca::added_body(body.mass, body.inertia, body.centre),
                   about_point(load_of(body, velocity_bias_), body.centre)});
        if (team_.works) kept.put(team_.own, body, velocity_bias_);
    }

    TeamLanes<whole> team_;
    VelocityBias velocity_bias_;  // velocity bias of the lane's own body
};

}  // namespace catena::cuda::kernels
