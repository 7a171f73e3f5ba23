// Passes of runs on revolute joints by several lanes of a warp, for chains with fewer runs than a
// GPU has threads. Each lane computes what does not depend on other bodies for one body at a time
// and stores it in shared memory. In the inward pass all lanes have the articulated-body inertia,
// and each has one or two of the six wrenches (floating_run.hpp). At the end each has a row of the
// segment. Results are bitwise those of one thread's climb_revolutes() and descend_revolutes().
// tests/support/cuda_on_host.hpp, included first, makes this file compile on the host.
#pragma once

#include "cuda/sweeps/team_memory.cuh"

namespace catena::cuda::kernels {

/// Lanes per team.
constexpr int lanes_of_narrow_team = 4, lanes_of_broad_team = 16;
// Largest numbers of runs for broad teams and for teams at all. More runs keep a GPU busy with
// narrow teams, or with one thread per run.
constexpr std::int64_t most_runs_of_broad_teams = 2048, most_runs_of_teams = 8192;

/// Team of lanes that eliminates one run in the inward pass. All lanes of a warp call its members
/// together. Teams of the warp may have different numbers of bodies unless `whole`.
template <int lanes, bool whole>
class RevoluteTeam {
    using Body = dca::ArticulatedBody<double>;
    using Wrench = dca::Wrench<double>;
    using VelocityBias = dca::BodyAcceleration<double>;
    using InRun = dca::LoadedBodyInRun<double>;
    using Ahead = BodiesAhead<lanes>;
    using Column = Vector<double, 6>;
    // Wrenches 0 to 4 are `first`, wrench 5 is the bias. Lane w % lanes holds wrench w.
    static constexpr int bias = 5, wrenches = (bias + lanes) / lanes, last_wrench = wrenches - 1;
    static_assert(whole ? bodies_of_whole_run % lanes == 0 : bodies_of_whole_run == lanes);

  public:
    /// `works`: false for a team that only accompanies the warp's other teams.
    __device__ RevoluteTeam(BodiesOfTeam<lanes, whole> const& bodies, int lane, bool works)
        : bodies_(bodies),
          own_(lane % lanes),
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
    /// Prepares all bodies and stores what the inward pass needs. Returns the state of the last of
    /// the lane's own bodies.
    template <class BodyOf, class Kept>
    __device__ __forceinline__ Prepared prepare(BodyOf const& body, Ahead const& ahead,
                                                Kept& kept) {
        Prepared own{Mat3::identity(), Mat3::identity(), Vec3::zero()};
        Mat3 rotation = own.rotation;
        VelocityBias velocity_bias{Vec3::zero(), Vec3::zero()};
        CATENA_NO_UNROLL
        for (int first = 0; first < bodies_of_whole_run; first += lanes) {
            Body const here = body(bodies_.body_or_last(first + own_));
            Mat3 const mine =
                along(first, rotation, here.rotation_to(one_before(here.e2, own.axes2)),
                      [](Mat3& t, Mat3 const& to_before) { t = t * to_before; });
            Vec3 const inward = mine * here.inward2;
            InRun const in_run = dca::in_run(here, mine, one_before(inward, own.inward));
            put_ahead(first, in_run, 0.0, velocity_bias, ahead, kept);
            own = {mine, here.e2, inward};
        }
        __syncwarp();
        return own;
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
        Vec3 const first_inward = own.inward;
        Quat rotation = own.rotation;
        Vec3 omega = own.omega;
        VelocityBias velocity_bias{Vec3::zero(), Vec3::zero()};
        CATENA_NO_UNROLL
        for (int first = 0; first < bodies_of_whole_run; first += lanes) {
            int const i = first + own_;
            int const read = bodies_.body_or_last(i);
            dca::BodyOnRevolute<double> const here = loaded.on_revolute(read);
            Vec3 const omega_of_last = omega;
            own.rotation = along(first, rotation, here.rotation,
                                 [](Quat& t, Quat const& next) { t = t * next; });
            Mat3 const mine = to_matrix_of_unit(own.rotation);
            Vec3 const after = along(
                first, omega, Turning{mine * here.axis, here.rate},
                [](Vec3& w, Turning const& next) { w = plus_scaled(w, next.rate, next.axis); });
            dca::FollowedBody<double> const body =
                dca::follow(here, mine, one_before(after, omega_of_last));
            Vec3 const inward = i == 0 ? first_inward : body.inward2;
            own.inward = one_before(inward, own.inward);
            InRun in_run = own.go_on(body);
            own.inward = inward;
            loaded.add_wrench(read, in_run);
            put_ahead(first, in_run, loaded.torque_about(read), velocity_bias, ahead, kept);
            if (works_ && bodies_.is_within(i) && (all || i == bodies_.last() - 1))
                kept.put_omega(i, transposed_times(mine, own.omega));
        }
        __syncwarp();
        return of_lane(own, before_last());
    }
    /// Lane that holds the last body but one.
    __device__ int before_last() const { return (bodies_.last() - 1) % lanes; }
    /// Stores what the inward pass needs of the bodies from `first` on, one per lane.
    /// `velocity_bias`: velocity bias of the body before them.
    template <class Kept>
    __device__ __forceinline__ void put_ahead(int first, InRun const& body, double torque_about,
                                              VelocityBias& velocity_bias, Ahead const& ahead,
                                              Kept& kept) {
        /// Terms of a body by which the velocity bias is propagated.
        struct VelocityBiasTerms {
            VelocityBias difference;
            Vec3 across;
        };
        int const i = first + own_;
        velocity_bias_ =
            along(first, velocity_bias, VelocityBiasTerms{body.difference, body.across},
                  [](VelocityBias& s, VelocityBiasTerms const& next) { swing_on(s, next); });
        if (!bodies_.is_within(i)) return;
        ahead.put(i - 1, {body, torque_about, dca::added_body(body.mass, body.inertia, body.centre),
                          about_point(load_of(body, velocity_bias_), body.centre)});
        if (works_) kept.put(i, body, velocity_bias_);
    }

    /// Starts the inward pass with the run's first body.
    __device__ __forceinline__ void begin(Body const& body) {
        all_ = inertia_of(body);
        CATENA_UNROLL
        for (int s = 0; s < wrenches; ++s) {
            wrench_[s] = bias_of(body);
            CATENA_UNROLL
            for (int j = 0; j < bias; ++j)
                if (j == own_ + s * lanes) {
                    wrench_[s] = first_of(body, j);
                    e_[s] = row_of_first(body, j);
                }
            CATENA_UNROLL
            for (int i = 0; i < bias; ++i) row_[s][i] = 0;
        }
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
            CATENA_UNROLL
            for (int s = 0; s < wrenches; ++s) move_point(wrench_[s], next.across);
            if (has_bias()) add_load(wrench_[last_wrench], next.load);
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
        double along[wrenches] = {};
        if (goes) {
            dca::Release<double> const r = release_revolute(all_, axis, h);
            CATENA_UNROLL
            for (int s = 0; s < last_wrench; ++s) along[s] = release_revolute(wrench_[s], r);
            // Adding -0 leaves the wrenches that are not the bias unchanged, bit by bit.
            if constexpr (std::is_same_v<Torque, double>)
                along[last_wrench] =
                    release_driven(wrench_[last_wrench], r, has_bias() ? torque : -0.0);
            else
                along[last_wrench] = release_revolute(wrench_[last_wrench], r);
        }
        CATENA_UNROLL
        for (int j = 0; j < bias; ++j) h.first[j] = of_lane(along[j / lanes], j % lanes);
        h.bias = of_lane(along[last_wrench], bias % lanes);
        if (!goes) return h;
        CATENA_UNROLL
        for (int s = 0; s < wrenches; ++s) gain_row(h, along[s], bias - 1, row_[s], e_[s]);
        return h;
    }
    /// Ends the run and writes the rows of its segment, as dca::end_run() and dca::segment_of() do.
    template <class Torque, class Kept, class PutRow>
    __device__ __forceinline__ void end(dca::OutboardHandle<double> const& before, Body const& last,
                                        Torque const& torque, Kept& kept, PutRow const& put_row) {
        add_velocity_bias(of_lane(velocity_bias_, before_last()));
        Mat3 const rotation = transpose(before.axes);
        rotate_axes(all_, rotation);
        CATENA_UNROLL
        for (int s = 0; s < wrenches; ++s) rotate_axes(wrench_[s], rotation);
        dca::ReleasedRevolute<double> const revolute =
            pass_revolute(dca::last_axis<double>(), torque);
        leave_revolute(all_);
        CATENA_UNROLL
        for (int s = 0; s < wrenches; ++s) wrench_[s].torque[2] = 0;
        if (has_bias()) wrench_[last_wrench].torque[2] = dca::left_along_revolute<double>(torque);
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
        Column first[wrenches], second[wrenches];
        CATENA_UNROLL
        for (int s = 0; s < wrenches; ++s) {
            int const own = own_ + s * lanes;
            first[s] = own == bias ? bias_of_end(wrench_[s], body)
                                   : dca::six_of(wrench_[s].force, wrench_[s].torque);
            if (works_ && own < bias) kept.put_first(own, first[s]);
            if (works_ && own == bias) kept.put_bias(first[s]);
            second[s] = second_of(handle, 0);
            CATENA_UNROLL
            for (int j = 1; j < bias; ++j)
                if (j == own) second[s] = second_of(handle, j);
            first[s] = dca::solve_lower(factor, first[s]);
            second[s] = dca::solve_lower(factor, second[s]);
        }
        dca::SegmentRow<double, 5> row[wrenches];
        CATENA_UNROLL
        for (int j = 0; j < bias; ++j) {
            Column const first_j = of_lane(first[j / lanes], j % lanes),
                         second_j = of_lane(second[j / lanes], j % lanes);
            CATENA_UNROLL
            for (int s = 0; s < wrenches; ++s) {
                row[s].z11[j] = row_[s][j] + dca::product(factor, first[s], first_j);
                row[s].z12[j] = dca::product(factor, first[s], second_j);
                row[s].z22[j] = dca::product(factor, second[s], second_j);
            }
        }
        Column const of_bias = of_lane(first[last_wrench], bias % lanes);
        Vector<double, 5> const beyond = bias_beyond(handle, last);
        CATENA_UNROLL
        for (int s = 0; s < wrenches; ++s) {
            double own_beyond = beyond[0];
            CATENA_UNROLL
            for (int j = 1; j < bias; ++j)
                if (j == own_ + s * lanes) own_beyond = beyond[j];
            row[s].b1 = e_[s] - dca::product(factor, first[s], of_bias);
            row[s].b2 = own_beyond - dca::product(factor, second[s], of_bias);
            if (works_ && own_ + s * lanes < bias) put_row(own_ + s * lanes, row[s]);
        }
    }
    /// Subtracts the acceleration difference `d` of a joint's two sides from the bias and the rows.
    __device__ __forceinline__ void add_velocity_bias(VelocityBias const& d) {
        CATENA_UNROLL
        for (int s = 0; s < wrenches; ++s) dca::add_velocity_bias(e_[s], wrench_[s], d);
        if (has_bias()) dca::add_velocity_bias(wrench_[last_wrench], all_, d);
    }
    /// True if the lane's last wrench is the bias.
    __device__ bool has_bias() const { return own_ == bias % lanes; }

    /// Calls step(state, value) with the values of the team's lanes in order, except for the run's
    /// first body. Returns the state after the lane's own value.
    template <class State, class T, class Step>
    __device__ __forceinline__ State along(int first, State& state, T const& value,
                                           Step const& step) const {
        constexpr int few = 4;  // exchanges in flight together
        State own = state;
        CATENA_NO_UNROLL
        for (int begin = 0; begin < lanes; begin += few) {
            CATENA_UNROLL
            for (int i = 0; i < few; ++i) {
                int const lane = begin + i;
                T const here = of_lane(value, lane);
                bool const goes_on = i > 0 || first + begin > 0;
                if constexpr (lanes == bodies_of_whole_run) {
                    if (goes_on) step(state, here);
                    if (lane == own_) own = state;
                } else if (goes_on && lane <= own_) {
                    step(own, here);
                }
            }
        }
        if constexpr (lanes < bodies_of_whole_run) state = of_lane(own, lanes - 1);
        return own;
    }
    /// Returns the value of the lane before. For lane 0 it is `of_last` of the last lane, which
    /// belongs to the bodies before.
    template <class T>
    __device__ T one_before(T const& value, T const& of_last) const {
        T const before = from_lane(value, leader_ + (own_ + lanes - 1) % lanes),
                last = of_lane(of_last, lanes - 1);
        return dca::either(own_ > 0, before, last);
    }
    /// Returns the value of lane `lane` of the team.
    template <class T>
    __device__ T of_lane(T const& value, int lane) const {
        return from_lane(value, leader_ + lane);
    }

    BodiesOfTeam<lanes, whole> bodies_;
    int own_, leader_;  // lane in the team, and the team's first lane in the warp
    int most_;          // largest number of bodies of the warp's teams
    bool works_;
    VelocityBias velocity_bias_;  // velocity bias of the last of the lane's own bodies
    /// Articulated-body inertia of the bodies so far.
    dca::SpatialInertia<double> all_;
    Wrench wrench_[wrenches];
    double row_[wrenches][bias], e_[wrenches] = {};
};

/// Inward pass of one run by a team.
template <bool whole, int lanes, class Sweep>
__device__ __forceinline__ void climb_by_team(Sweep const& sweep, dca::Run const& run, int lane,
                                              bool works) {
    RevoluteTeam<lanes, whole> team(BodiesOfTeam<lanes, whole>(run), lane, works);
    dca::RunWorkspace<typename Sweep::Sweeps> kept(sweep.s, run, sweep.goes_by_all());
    BodiesAhead<lanes> const ahead(shared_numbers, lane);
    auto const put_row = [&](int i, dca::SegmentRow<double, Sweep::K> const& row) {
        sweep.store_row(run.slot, i, row);
    };
    if (sweep.follows()) {
        team.climb(sweep.with_loads(run), sweep.goes_by_all(), ahead, kept, put_row);
    } else {
        auto const body = [&](int i) {
            return sweep.s.leaf.revolute(sweep.bodies.loads, run.body + i);
        };
        team.climb(body, ahead, kept, put_row);
    }
    sweep.s.note(kept.lost());
}
/// Outward pass of one run by a team.
template <bool whole, int lanes, class Sweep>
__device__ __forceinline__ void descend_by_team(Sweep const& sweep, dca::Run const& run, int lane,
                                                bool works) {
    BodiesOfTeam<lanes, whole> const bodies(run);
    bool const leads = works && lane % lanes == 0;
    dca::RunWorkspace<typename Sweep::Sweeps> const kept(sweep.s, run, false);
    auto const first = sweep.s.forces.load(run.body), next = sweep.s.forces.load(run.next);
    RevolutesBehind<Sweep, lanes, whole> const behind(bodies, shared_numbers, lane);
    behind.fetch(kept, first, [&](int i) { return sweep.frame(run, kept, i); });
    dca::descend_revolutes<double>(
        bodies.count(), false, [&](int i) { return behind.frame(i); }, behind, first, next,
        [&](int i, dca::RevoluteFrame<double> const& frame,
            dca::BodyAcceleration<double> const& a) {
            if (leads) sweep.accelerate(run, i, frame, a);
        },
        [](int, dca::BodyAcceleration<double>&) {},
        [&](int i, double of_revolute) {
            if (leads) sweep.joint_acceleration(run, i, of_revolute);
        });
}
/// True if `says` is true on all lanes of the warp. It uses shuffles, because after a vote nvcc 13
/// generates code that is a quarter slower.
__device__ inline bool all_lanes(int lane, bool says) {
    int all = says ? 1 : 0;
    CATENA_UNROLL
    for (int apart = 16; apart > 0; apart /= 2) all &= __shfl_sync(0xffffffffu, all, lane ^ apart);
    return all != 0;
}
/// Returns the run of a team. A team without a run on revolute joints takes that of the warp's
/// other team.
__device__ inline dca::Run for_team(RunsView const& runs, std::int64_t wanted, dca::Run const& run,
                                    bool by_revolutes) {
    std::int64_t const other = wanted ^ 1;
    return by_revolutes ? run : runs[other < runs.count ? other : runs.count - 1];
}
/// Kernel of the inward pass by teams. Teams take whole runs if all runs of the warp are whole.
/// Broad teams also take other runs on revolute joints of three or more bodies. A thread takes the
/// remaining runs.
template <int lanes, class Sweep>
__global__ void __launch_bounds__(32) climb_runs_by_teams(RunsView runs, Sweep sweep) {
    int const lane = static_cast<int>(threadIdx.x) % 32;
    std::int64_t const wanted = thread() / lanes;
    bool const works = wanted < runs.count;
    dca::Run const run = runs[works ? wanted : runs.count - 1];
    bool const by_revolutes = run.count > 2 && sweep.takes(run);
    bool const whole = all_lanes(lane, by_revolutes && run.count == dca::longest_run);
    wait_for_launch();
    if (whole) {
        climb_by_team<true, lanes>(sweep, run, lane, works);
        return;
    }
    if constexpr (lanes == bodies_of_whole_run) {
        if (!all_lanes(lane, !by_revolutes)) {
            dca::Run const of_team = for_team(runs, wanted, run, by_revolutes);
            climb_by_team<false, lanes>(sweep, of_team, lane, works && by_revolutes);
        }
        if (by_revolutes) return;
    }
    if (works && lane % lanes == 0) climb_run(sweep, run);
}
/// Kernel of the outward pass by teams. If results of every body are required, a thread computes
/// them one after the other.
template <int lanes, class Sweep>
__global__ void __launch_bounds__(32) descend_runs_by_teams(RunsView runs, Sweep sweep) {
    int const lane = static_cast<int>(threadIdx.x) % 32;
    std::int64_t const wanted = thread() / lanes;
    bool const works = wanted < runs.count;
    dca::Run const run = runs[works ? wanted : runs.count - 1];
    bool const by_revolutes = run.count > 2 && !sweep.goes_by_all() && sweep.takes(run);
    bool const whole = all_lanes(lane, by_revolutes && run.count == dca::longest_run);
    wait_for_launch();
    if (whole) {
        descend_by_team<true, lanes>(sweep, run, lane, works);
        return;
    }
    if constexpr (lanes == bodies_of_whole_run) {
        if (!all_lanes(lane, !by_revolutes)) {
            dca::Run const of_team = for_team(runs, wanted, run, by_revolutes);
            descend_by_team<false, lanes>(sweep, of_team, lane, works && by_revolutes);
        }
        if (by_revolutes) return;
    }
    if (works && lane % lanes == 0) descend_run(sweep, run);
}
/// Returns the grid of a launch by teams.
template <int lanes>
RunsGrid grid_of_teams(std::int64_t runs, std::size_t numbers_of_warp) {
    RunsGrid grid = grid_of_runs(runs, lanes, 32);
    grid.shared_bytes = sizeof(double) * numbers_of_warp;
    return grid;
}
/// Returns the number of lanes per run on revolute joints; 0: one thread per run.
constexpr int lanes_of_teams(std::int64_t runs) {
    return runs <= most_runs_of_broad_teams ? lanes_of_broad_team
           : runs <= most_runs_of_teams     ? lanes_of_narrow_team
                                            : 0;
}
/// Calls launch(kernel, grid) for the inward pass. Returns false, without a call, if teams are not
/// used.
template <class Sweep, class Launch>
bool climb_by_teams(int lanes, std::int64_t runs, Launch const& launch) {
    if constexpr (dca::takes_whole_runs<Sweep>) {
        constexpr int broad = lanes_of_broad_team, narrow = lanes_of_narrow_team;
        if (lanes == broad)
            launch(climb_runs_by_teams<broad, Sweep>,
                   grid_of_teams<broad>(runs, BodiesAhead<broad>::size));
        if (lanes == narrow)
            launch(climb_runs_by_teams<narrow, Sweep>,
                   grid_of_teams<narrow>(runs, BodiesAhead<narrow>::size));
        return lanes != 0;
    }
    return false;
}
/// Calls launch(kernel, grid) for the outward pass. Returns false, without a call, if teams are not
/// used.
template <class Sweep, class Launch>
bool descend_by_teams(int lanes, std::int64_t runs, Launch const& launch) {
    if constexpr (dca::takes_whole_runs<Sweep>) {
        constexpr int broad = lanes_of_broad_team, narrow = lanes_of_narrow_team;
        std::size_t const numbers = lanes == broad ? RevolutesBehind<Sweep, broad, true>::size
                                                   : RevolutesBehind<Sweep, narrow, true>::size;
        if (lanes == broad)
            launch(descend_runs_by_teams<broad, Sweep>, grid_of_teams<broad>(runs, numbers));
        if (lanes == narrow)
            launch(descend_runs_by_teams<narrow, Sweep>, grid_of_teams<narrow>(runs, numbers));
        return lanes != 0;
    }
    return false;
}

}  // namespace catena::cuda::kernels
