// Runs on hinges by four lanes of a warp each: where runs are few, a GPU has more threads than that. What does not wait for other bodies
// the lanes find of a body each, and leave in shared memory; then, on the way up, all have the inertia and each one or two of the six
// wrenches (inertia_run.hpp). They leave the bits of one thread's climb_hinges() and descend_hinges(). A host compiler takes it too, where
// tests/support/cuda_on_host.hpp stands before it.
#pragma once

#include "cuda/stage_kernels.cuh"
#include "dca/evaluation.hpp"

namespace catena::cuda::kernels {

constexpr int lanes_of_team = 4;
constexpr std::int64_t most_runs_of_teams = 8192;  // more keep a GPU busy with a thread each

/// Bodies of a run, for each of a warp's teams: in T::slots, of which body i has T::slot(i).
template <class T>
class BodiesOfTeam {
    static constexpr int teams = 32 / lanes_of_team;
    using Records = PackedRecords<T, numbers_of<T>>;

  public:
    static constexpr std::size_t numbers = Records::size(teams * T::slots);
    __device__ BodiesOfTeam(double* memory, int lane) : records_{memory}, team_(lane / lanes_of_team) {}
    __device__ void put(int i, T const& of_body) const { records_.store(T::slot(i) * teams + team_, of_body); }
    __device__ T get(int i) const { return records_.load(T::slot(i) * teams + team_); }

  private:
    Records records_;
    int team_;
};
/// What a run needs of a body to go on to it. All are found before what the way up needs takes the registers; not those of the first and
/// the last, so that eight warps have room.
struct BodyAhead : dca::LoadedBodyInRun<double> {
    double torque_about;  // the hinge, where that is in no body's own
    static constexpr int slots = static_cast<int>(dca::longest_run) - 2;
    __device__ static int slot(int i) { return i - 1; }
};
/// And to come back from it: some in turn.
struct HingeBehind {
    static constexpr int slots = 8;
    static_assert(slots % lanes_of_team == 0 && dca::longest_run % slots == 0);
    __device__ static int slot(int i) { return i % slots; }
    dca::ReleasedHinge<double> hinge;
    dca::BodyInRun<double> body;
};

class HingeTeam {
    using Body = dca::HingedBody<double>;
    using Wrench = dca::Wrench<double>;
    static constexpr int bias = 5;  // wrench 0 to 4: `first`; wrench w is that of lane w % 4

  public:
    /// `works`: else it only goes along with the warp's other teams.
    __device__ HingeTeam(int lane, bool works) : own_(lane % lanes_of_team), leader_(lane - own_), works_(works) {}
    __device__ bool leads() const { return works_ && own_ == 0; }

    /// As dca::climb_hinges(), of dca::longest_run bodies, where the team's first lane keeps; all lanes of the warp come to these.
    template <class BodyOf, class Kept>
    __device__ dca::BiasedSegment<double, 5> climb(BodyOf const& body, BodiesOfTeam<BodyAhead> const& bodies, Kept& kept) {
        Prepared const last_one = prepare(body, bodies);
        begin(body(0));
        go_on<dca::Undriven>(bodies, kept);
        dca::InertiaRun<double> run = whole();
        Body const last = body(count - 1);
        return end(run, of_lane(dca::OutboardHandle<double>{last_one.turn * last_one.axes2, last_one.inward}, before_last), last,
                   dca::Undriven{}, kept);
    }
    /// The same where hinges' loads are given. `all`: as FollowedBodies.
    template <class Leaf, class Kept>
    __device__ dca::BiasedSegment<double, 5> climb(dca::RunWithLoads<Leaf> const& loaded, bool all, BodiesOfTeam<BodyAhead> const& bodies,
                                                   Kept& kept) {
        dca::FollowedState<double> const last_one = follow(loaded, all, bodies, kept);
        begin(loaded.first());
        go_on<double>(bodies, kept);
        dca::InertiaRun<double> run = whole();
        dca::OutboardHandle<double> const before{to_matrix_of_unit(last_one.turn) * loaded.axes2(count - 2), last_one.inward};
        Body const last = loaded.last(before.axes, last_one.omega, ByLeader<Kept>{kept, leads()});
        return end(run, before, last, loaded.torque_about(count - 1), kept);
    }
    /// As dca::descend_hinges(), by every lane. Precondition: not of all bodies.
    template <class Frame, class Kept, class Accelerate, class Turn>
    __device__ void descend(Frame const& frame, BodiesOfTeam<HingeBehind> const& bodies, Kept const& kept, Vector<double, 5> const& first,
                            Vector<double, 5> const& next, Accelerate const& accelerate, Turn const& turn) const {
        struct KeptHere {
            BodiesOfTeam<HingeBehind> const& bodies;
            Kept const& kept;
            __device__ dca::ReleasedHinge<double> hinge(int i) const { return i == count - 1 ? kept.hinge(i) : bodies.get(i).hinge; }
            __device__ dca::BodyInRun<double> body(int i) const { return bodies.get(i).body; }
            __device__ dca::BodyAcceleration<double> swing(int i) const { return kept.swing(i); }
            __device__ dca::RunsEnd<double> end() const { return kept.end(); }
            __device__ Mat3 axes() const { return kept.axes(); }
        } const kept_here{bodies, kept};
        auto const at = [&](int i, dca::BodyAcceleration<double>&) {
            constexpr int slots = HingeBehind::slots;
            if (i != count - 2 && i % slots != slots - 1) return;
            __syncwarp();  // the others are read
            CATENA_NO_UNROLL
            for (int k = i - i % slots + own_; k <= i; k += lanes_of_team)
                if (k > 0) bodies.put(k, {kept.hinge(k), kept.body(k)});
            __syncwarp();
        };
        dca::descend_hinges<double>(count, false, frame, kept_here, first, next, accelerate, at, turn);
    }

  private:
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
    static constexpr int count = static_cast<int>(dca::longest_run);
    static constexpr int before_last = (count - 2) % lanes_of_team;  // lane that has this body

    /// What the bodies after it want of one, as dca::BodiesOfRun::State.
    struct Prepared {
        Mat3 turn, axes2;
        Vec3 inward;
    };
    /// All bodies; returns the last of the lane's own.
    template <class BodyOf>
    __device__ Prepared prepare(BodyOf const& body, BodiesOfTeam<BodyAhead> const& bodies) const {
        Prepared own{};
        CATENA_NO_UNROLL
        for (int first = 0; first < count; first += lanes_of_team) {
            Body const here = body(first + own_);
            int const before = leader_ + (own_ + lanes_of_team - 1) % lanes_of_team;
            Mat3 const neighbours = from_lane(here.e2, before), of_others = from_last(own.axes2);
            Mat3 const to_before = here.turn_to(own_ == 0 ? of_others : neighbours);
            Mat3 turn = first == 0 ? Mat3::identity() : from_last(own.turn);
            Mat3 mine = turn;
            CATENA_NO_UNROLL
            for (int lane = 0; lane < lanes_of_team; ++lane) {
                if (first + lane > 0) turn = of_lane(turn * to_before, lane);
                if (lane == own_) mine = turn;
            }
            Vec3 const inward = mine * here.inward2;
            Vec3 const inward_before = from_lane(inward, before), of_last = from_last(own.inward);
            BodyAhead const ahead{in_run(here, mine, own_ == 0 ? of_last : inward_before), 0.0};
            if (int const i = first + own_; i > 0 && i < count - 1) bodies.put(i, ahead);
            own = {mine, here.e2, inward};
        }
        __syncwarp();
        return own;
    }
    /// All bodies, as FollowedBodies; returns the last but one.
    template <class Leaf, class Kept>
    __device__ dca::FollowedState<double> follow(dca::RunWithLoads<Leaf> const& loaded, bool all, BodiesOfTeam<BodyAhead> const& bodies,
                                                 Kept& kept) const {
        dca::FollowedState<double> own{Quat::identity(), loaded.first_omega(), loaded.first_inward()};
        Vec3 const first_inward = own.inward;
        Quat turn = own.turn;
        Vec3 omega = own.omega;
        CATENA_NO_UNROLL
        for (int first = 0; first < count; first += lanes_of_team) {
            int const i = first + own_;
            dca::BodyOnHinge<double> const here = loaded.on_hinge(i);
            own.turn = turn;
            CATENA_NO_UNROLL
            for (int lane = 0; lane < lanes_of_team; ++lane) {
                if (first + lane > 0) turn = of_lane(turn * here.turn, lane);
                if (lane == own_) own.turn = turn;
            }
            Mat3 const mine = to_matrix_of_unit(own.turn);
            Vec3 const axis = mine * here.axis;
            Vec3 omega_before = omega;
            CATENA_NO_UNROLL
            for (int lane = 0; lane < lanes_of_team; ++lane) {
                if (lane == own_) omega_before = omega;
                if (first + lane > 0) omega = of_lane(plus_scaled(omega, here.rate, axis), lane);
            }
            dca::FollowedBody<double> const body = dca::follow(here, mine, omega_before);
            Vec3 const inward = i == 0 ? first_inward : body.inward2;
            int const before = leader_ + (own_ + lanes_of_team - 1) % lanes_of_team;
            Vec3 const inward_before = from_lane(inward, before), of_last = from_last(own.inward);
            own.inward = own_ == 0 ? of_last : inward_before;
            BodyAhead ahead{own.go_on(body), loaded.torque_about(i)};
            own.inward = inward;
            loaded.add_wrench(i, ahead);
            if (i > 0 && i < count - 1) {
                bodies.put(i, ahead);
                if (works_ && (all || i == count - 2)) kept.put_omega(i, transposed_times(mine, own.omega));
            }
        }
        __syncwarp();
        return of_lane(own, before_last);
    }
    /// Of the team's last lane.
    template <class T>
    __device__ T from_last(T const& value) const {
        return of_lane(value, lanes_of_team - 1);
    }
    __device__ void begin(Body const& body) {
        all_ = inertia_of(body);
        CATENA_UNROLL
        for (int s = 0; s < 2; ++s) {
            wrench_[s] = bias_of(body);
            CATENA_UNROLL
            for (int j = 0; j < bias; ++j)
                if (j == own_ + s * lanes_of_team) {
                    wrench_[s] = first_of(body, j);
                    e_[s] = row_of_first(body, j);
                }
            CATENA_UNROLL
            for (int i = 0; i < bias; ++i) row_[s][i] = 0;
        }
    }
    /// To all bodies but the first and the last. `Torque`: as dca::release_driven.
    template <class Torque, class Kept>
    __device__ void go_on(BodiesOfTeam<BodyAhead> const& bodies, Kept& kept) {
        CATENA_NO_UNROLL
        for (int i = 1; i < count - 1; ++i) {
            BodyAhead const ahead = bodies.get(i);
            dca::ReleasedHinge<double> const hinge = go_on<Torque>(ahead);
            if (leads()) kept.put(i, hinge, ahead, swing_);
        }
    }
    template <class Torque>
    __device__ dca::ReleasedHinge<double> go_on(BodyAhead const& body) {
        dca::ReleasedHinge<double> h;
        dca::Release<double> const r = release_hinge(all_, body.axis, h);
        double along[2];
        along[0] = release_hinge(wrench_[0], r);
        if constexpr (std::is_same_v<Torque, double>)  // to what is no bias -0 is added: it stays what it is
            along[1] = release_driven(wrench_[1], r, own_ == bias % lanes_of_team ? body.torque_about : -0.0);
        else
            along[1] = release_hinge(wrench_[1], r);
        CATENA_UNROLL
        for (int j = 0; j < bias; ++j) h.first[j] = of_lane(along[j / lanes_of_team], j % lanes_of_team);
        h.bias = of_lane(along[bias / lanes_of_team], bias % lanes_of_team);
        CATENA_UNROLL
        for (int s = 0; s < 2; ++s) gain_row(h, along[s], bias - 1, row_[s], e_[s]);
        swing_on(swing_, body);
        CATENA_UNROLL
        for (int s = 0; s < 2; ++s) move_point(wrench_[s], body.across);
        Wrench const load = load_of(body, swing_);
        if (own_ == bias % lanes_of_team) add_body(wrench_[1], load.torque, load.force, body.centre);
        move_point(all_, body.across);
        add_body(all_, body.mass, body.inertia, body.centre);
        return h;
    }
    template <class Torque, class Kept>
    __device__ dca::BiasedSegment<double, 5> end(dca::InertiaRun<double>& run, dca::OutboardHandle<double> const& before, Body const& last,
                                                 Torque const& torque, Kept& kept) const {
        dca::ReleasedHinge<double> hinge;
        dca::RunsEnd<double> const end = end_run(run, before, last, hinge, torque);
        if (leads()) {
            kept.put(count - 1, hinge);
            kept.put(end);
            kept.put_axes(before.axes);
        }
        return segment_of(run, end, last);
    }
    /// What all lanes have together.
    __device__ dca::InertiaRun<double> whole() const {
        dca::InertiaRun<double> run;
        run.inertia = all_;
        run.swing = swing_;
        run.bias = of_lane(wrench_[bias / lanes_of_team], bias % lanes_of_team);
        CATENA_UNROLL
        for (int j = 0; j < bias; ++j) {
            int const s = j / lanes_of_team, lane = j % lanes_of_team;
            run.first[j] = of_lane(wrench_[s], lane);
            run.e[j] = of_lane(e_[s], lane);
            CATENA_UNROLL
            for (int i = 0; i <= j; ++i) run.z(j, i) = of_lane(row_[s][i], lane);
        }
        return run;
    }
    template <class T>
    __device__ T of_lane(T const& value, int lane) const {
        return from_lane(value, leader_ + lane);
    }

    int own_, leader_;  // lane of the team, and of the warp that is the team's first
    bool works_;
    dca::SpatialInertia<double> all_;
    dca::BodyAcceleration<double> swing_{Vec3::zero(), Vec3::zero()};
    Wrench wrench_[2];
    double row_[2][bias], e_[2] = {};
};

/// Whether all lanes of the warp say so.
__device__ inline bool all_lanes(int lane, bool says) {
    int all = says ? 1 : 0;
    CATENA_UNROLL
    for (int apart = 16; apart > 0; apart /= 2) all &= __shfl_sync(0xffffffffu, all, lane ^ apart);
    return all != 0;
}
/// A warp with another run among its own has a thread take each.
template <class Sweep>
__global__ void __launch_bounds__(32) climb_runs_by_teams(RunsView runs, Sweep sweep) {
    wait_for_launch();
    int const lane = static_cast<int>(threadIdx.x) % 32;
    std::int64_t const wanted = thread() / lanes_of_team;
    HingeTeam team(lane, wanted < runs.count);
    dca::Run const run = runs[wanted < runs.count ? wanted : runs.count - 1];
    if (all_lanes(lane, run.count == dca::longest_run && sweep.takes(run))) {
        dca::HingesInJoints<typename Sweep::Sweeps> kept(sweep.s, run, sweep.goes_by_all());
        BodiesOfTeam<BodyAhead> const bodies(shared_numbers, lane);
        typename Sweep::Segment segment;
        if (sweep.follows()) {
            segment = team.climb(sweep.with_loads(run), sweep.goes_by_all(), bodies, kept);
        } else {
            auto const body = [&](int i) { return sweep.s.leaf.hinged(sweep.bodies.loads, run.body + i); };
            segment = team.climb(body, bodies, kept);
        }
        sweep.s.note(kept.lost());
        if (team.leads()) sweep.store(run.slot, segment);
    } else if (team.leads()) {
        climb_run(sweep, run);
    }
}
/// What is wanted of every body is found one after the other: by a thread.
template <class Sweep>
__global__ void __launch_bounds__(32) descend_runs_by_teams(RunsView runs, Sweep sweep) {
    wait_for_launch();
    int const lane = static_cast<int>(threadIdx.x) % 32;
    std::int64_t const wanted = thread() / lanes_of_team;
    HingeTeam const team(lane, wanted < runs.count);
    dca::Run const run = runs[wanted < runs.count ? wanted : runs.count - 1];
    bool const whole = run.count == dca::longest_run && !sweep.goes_by_all() && sweep.takes(run);
    if (all_lanes(lane, whole)) {
        dca::HingesInJoints<typename Sweep::Sweeps> const kept(sweep.s, run, sweep.goes_by_all());
        auto const frame = [&](int i) { return sweep.frame(run, kept, i); };
        team.descend(
            frame, BodiesOfTeam<HingeBehind>(shared_numbers, lane), kept, sweep.s.forces.load(run.body), sweep.s.forces.load(run.next),
            [&](int i, dca::HingedFrame<double> const& of_body, dca::BodyAcceleration<double> const& a) {
                if (team.leads()) sweep.accelerate(run, i, of_body, a);
            },
            [&](int i, double of_hinge) {
                if (team.leads()) sweep.turn(run, i, of_hinge);
            });
    } else if (team.leads()) {
        descend_run(sweep, run);
    }
}
/// Whether so many runs go by teams.
template <class Sweep>
bool go_by_teams(std::int64_t runs) {
    return dca::takes_whole_runs<Sweep> && runs <= most_runs_of_teams;
}
/// `T`: what is kept of bodies, BodyAhead on the way up and HingeBehind downwards.
template <class T>
RunsGrid grid_of_teams(std::int64_t runs) {
    RunsGrid grid = grid_of_runs(runs, lanes_of_team, 32);
    grid.shared_bytes = sizeof(double) * BodiesOfTeam<T>::numbers;
    return grid;
}

}  // namespace catena::cuda::kernels
