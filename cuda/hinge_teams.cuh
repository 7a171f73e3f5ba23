// Runs on hinges by four lanes of a warp each: where runs are few, a GPU has more threads than that. What does not wait for other bodies
// the lanes find of a body each, and leave in shared memory; then, on the way up, all have the inertia and each one or two of the six
// wrenches (inertia_run.hpp). They leave the bits of one thread's climb_hinges() and descend_hinges(). A host compiler takes it too, where
// tests/support/cuda_on_host.hpp stands before it.
#pragma once

#include "cuda/stage_kernels.cuh"
#include "dca/evaluation.hpp"

namespace catena::cuda::kernels {

constexpr int lanes_of_team = 4;
constexpr std::int64_t most_runs_of_teams = 16384;  // more keep a GPU busy with a thread each

/// Some of a run's bodies in turn, for each of a warp's teams.
template <class T>
class BodiesOfTeam {
    static constexpr int teams = 32 / lanes_of_team;
    using Records = PackedRecords<T, numbers_of<T>>;

  public:
    static constexpr int at_once = 8;  // more would leave less room for other warps
    static_assert(at_once % lanes_of_team == 0 && dca::longest_run % at_once == 0);
    static constexpr std::size_t numbers = Records::size(teams * at_once);
    __device__ BodiesOfTeam(double* memory, int lane) : records_{memory}, team_(lane / lanes_of_team) {}
    __device__ void put(int i, T const& of_body) const { records_.store(i % at_once * teams + team_, of_body); }
    __device__ T get(int i) const { return records_.load(i % at_once * teams + team_); }

  private:
    Records records_;
    int team_;
};
/// What a run needs of a body to go on to it.
struct HingeAhead {
    dca::HingePassed<double> joint;
    Vec3 to_hinge, to_centre;
    double mass;
    Sym3 inertia;
    Vec3 torque, force;
};
/// And to come back to it.
struct HingeBehind {
    dca::HingedFrame<double> frame;
    dca::ReleasedHinge<double> outboard;  // its outboard joint's
};

class HingeTeam {
    using Body = dca::HingedBody<double>;
    using Outboard = dca::OutboardHandle<double>;
    using Wrench = dca::Wrench<double>;
    static constexpr int bias = 5;  // wrench 0 to 4: `first`; wrench w is that of lane w % 4

  public:
    /// `works`: else it only goes along with the warp's other teams.
    __device__ HingeTeam(int lane, bool works) : own_(lane % lanes_of_team), leader_(lane - own_), leads_(works && own_ == 0) {}
    __device__ bool leads() const { return leads_; }

    /// As dca::climb_hinges(), of dca::longest_run bodies, where the team's first lane keeps; all lanes of the warp come to these.
    template <class BodyOf, class Kept>
    __device__ dca::BiasedSegment<double, 5> climb(BodyOf const& body, BodiesOfTeam<HingeAhead> const& bodies, Kept& kept) {
        begin(body(0));
        Outboard before{};  // of the last body that is prepared
        CATENA_NO_UNROLL
        for (int i = 0; i < count - 1; ++i) {
            if (i % at_once == 0) prepare(body, i, before, bodies);
            if (i == 0) continue;
            dca::ReleasedHinge<double> const hinge = go_on(bodies.get(i));
            if (leads()) kept.put(i, hinge);
        }
        dca::InertiaRun<double> run = whole();
        Body const last = body(count - 1);
        dca::ReleasedHinge<double> hinge;
        dca::RunsEnd<double> const end = end_run(run, outboard_handle(body(count - 2)), last, hinge, dca::Undriven{});
        if (leads()) {
            kept.put(count - 1, hinge);
            kept.put(end);
        }
        return segment_of(run, end, last);
    }
    /// As dca::descend_hinges(), by every lane.
    template <class Frame, class Kept, class Accelerate, class Turn>
    __device__ void descend(Frame const& frame, BodiesOfTeam<HingeBehind> const& bodies, Kept const& kept, Vector<double, 5> const& first,
                            Vector<double, 5> const& next, Accelerate const& accelerate, Turn const& turn) const {
        auto const frame_here = [&](int i) {
            if (i % at_once == at_once - 1) {
                __syncwarp();  // the others are read
                CATENA_NO_UNROLL
                for (int k = i - own_; k > i - at_once; k -= lanes_of_team)
                    bodies.put(k, {frame(k), k + 1 < count ? kept.hinge(k + 1) : dca::ReleasedHinge<double>{}});
                __syncwarp();
            }
            return bodies.get(i).frame;
        };
        struct KeptHere {
            BodiesOfTeam<HingeBehind> const& bodies;
            Kept const& kept;
            __device__ dca::ReleasedHinge<double> hinge(int i) const { return bodies.get(i - 1).outboard; }
            __device__ dca::RunsEnd<double> end() const { return kept.end(); }
        } const kept_here{bodies, kept};
        dca::descend_hinges<double, false>(count, frame_here, kept_here, first, next, accelerate, turn);
    }

  private:
    static constexpr int count = static_cast<int>(dca::longest_run), at_once = BodiesOfTeam<HingeAhead>::at_once;

    /// Bodies from `begin` on. `last`: of the team's first lane, the handle of the one before them, and then of the last of them.
    template <class BodyOf>
    __device__ void prepare(BodyOf const& body, int begin, Outboard& last, BodiesOfTeam<HingeAhead> const& bodies) const {
        __syncwarp();  // the others are read
        CATENA_NO_UNROLL
        for (int first = begin; first < begin + at_once; first += lanes_of_team) {
            Body const own = body(first + own_);
            Outboard const neighbour = from_lane(outboard_handle(own), leader_ + (own_ + lanes_of_team - 1) % lanes_of_team);
            Outboard const before = own_ == 0 ? last : neighbour;
            last = neighbour;
            bodies.put(first + own_, {joint_between(before, own), before.r, -own.r1, own.mass, own.inertia, own.torque, own.force});
        }
        __syncwarp();
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
    __device__ dca::ReleasedHinge<double> go_on(HingeAhead const& ahead) {
        dca::HingePassed<double> const& joint = ahead.joint;
        dca::ReleasedHinge<double> h;
        move_point(all_, ahead.to_hinge);
        turn_axes(all_, joint.turn);
        dca::Release<double> const r = release_hinge(all_, joint.axis, h);
        double along[2];
        CATENA_UNROLL
        for (int s = 0; s < 2; ++s) {
            move_point(wrench_[s], ahead.to_hinge);
            turn_axes(wrench_[s], joint.turn);
            along[s] = release_hinge(wrench_[s], r);
        }
        CATENA_UNROLL
        for (int j = 0; j < bias; ++j) h.first[j] = of_lane(along[j / lanes_of_team], j % lanes_of_team);
        h.bias = of_lane(along[bias / lanes_of_team], bias % lanes_of_team);
        Wrench with_bias = wrench_[1];
        differ(with_bias, all_, joint);
        CATENA_UNROLL
        for (int s = 0; s < 2; ++s) {
            gain_row(h, along[s], bias - 1, row_[s], e_[s]);
            differ(e_[s], wrench_[s], joint);
        }
        bool const has_bias = own_ == bias % lanes_of_team;
        if (has_bias) wrench_[1] = with_bias;
        CATENA_UNROLL
        for (int s = 0; s < 2; ++s) move_point(wrench_[s], ahead.to_centre);
        Body share;  // what is added of it
        share.mass = ahead.mass, share.inertia = ahead.inertia, share.torque = ahead.torque, share.force = ahead.force;
        if (has_bias) add_body(wrench_[1], share);
        move_point(all_, ahead.to_centre);
        add_body(all_, share);
        return h;
    }
    /// What all lanes have together.
    __device__ dca::InertiaRun<double> whole() const {
        dca::InertiaRun<double> run;
        run.inertia = all_;
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
    bool leads_;
    dca::SpatialInertia<double> all_;
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
__global__ void __launch_bounds__(32) climb_runs_by_teams(dca::Run const* runs, std::int64_t count, Sweep sweep) {
    wait_for_launch();
    int const lane = static_cast<int>(threadIdx.x) % 32;
    std::int64_t const wanted = thread() / lanes_of_team;
    HingeTeam team(lane, wanted < count);
    dca::Run const run = runs[wanted < count ? wanted : count - 1];
    if (all_lanes(lane, run.count == dca::longest_run && sweep.takes(run))) {
        dca::HingesInJoints<typename Sweep::Sweeps> kept(sweep.s, run);
        auto const body = [&](int i) { return sweep.s.leaf.hinged(sweep.bodies.loads, run.body + i); };
        typename Sweep::Segment const segment = team.climb(body, BodiesOfTeam<HingeAhead>(shared_numbers, lane), kept);
        sweep.s.note(kept.lost());
        if (team.leads()) sweep.store(run.slot, segment);
    } else if (team.leads()) {
        climb_run(sweep, run);
    }
}
/// Joint forces, if they are wanted, are found one from the other: by a thread.
template <class Sweep>
__global__ void __launch_bounds__(32) descend_runs_by_teams(dca::Run const* runs, std::int64_t count, Sweep sweep) {
    wait_for_launch();
    int const lane = static_cast<int>(threadIdx.x) % 32;
    std::int64_t const wanted = thread() / lanes_of_team;
    HingeTeam const team(lane, wanted < count);
    dca::Run const run = runs[wanted < count ? wanted : count - 1];
    bool const whole = run.count == dca::longest_run && !sweep.out.joint_force && sweep.takes(run);
    if (all_lanes(lane, whole)) {
        dca::HingesInJoints<typename Sweep::Sweeps> const kept(sweep.s, run);
        auto const frame = [&](int i) { return sweep.s.leaf.hinged_frame(sweep.bodies.loads, run.body + i); };
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
/// `T`: what is kept of bodies, HingeAhead on the way up and HingeBehind downwards.
template <class T>
RunsGrid grid_of_teams(std::int64_t runs) {
    RunsGrid grid = grid_of_runs(runs, lanes_of_team, 32);
    grid.shared_bytes = sizeof(double) * BodiesOfTeam<T>::numbers;
    return grid;
}

}  // namespace catena::cuda::kernels
