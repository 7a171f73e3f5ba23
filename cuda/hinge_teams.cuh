// Runs on hinges on the way up, four lanes of a warp each: where runs are few, a GPU has more threads than that. All of a team have the
// inertia; each has one or two of the six wrenches (inertia_run.hpp), and together they leave the bits of one thread's climb_hinges(). A
// host compiler takes it too, where tests/support/cuda_on_host.hpp stands before it.
#pragma once

#include "cuda/stage_kernels.cuh"
#include "dca/evaluation.hpp"

namespace catena::cuda::kernels {

constexpr int lanes_of_team = 4;
constexpr std::int64_t most_runs_of_teams = 16384;  // more keep a GPU busy with a thread each

class HingeTeam {
    using Body = dca::HingedBody<double>;
    using Wrench = dca::Wrench<double>;
    static constexpr int bias = 5;  // wrench 0 to 4: `first`; wrench w is that of lane w % 4

  public:
    /// `works`: else it only goes along with the warp's other teams.
    __device__ HingeTeam(int lane, bool works) : own_(lane % lanes_of_team), leader_(lane - own_), leads_(works && own_ == 0) {}
    __device__ bool leads() const { return leads_; }

    /// As dca::climb_hinges(), where the team's first lane keeps; all lanes of the warp come here with as many bodies.
    template <class BodyOf, class Kept>
    __device__ dca::BiasedSegment<double, 5> climb(int count, BodyOf const& body, Kept& kept) {
        Body const begins = body(0);
        begin(begins);
        dca::OutboardHandle<double> before = outboard_handle(begins);
        CATENA_NO_UNROLL
        for (int i = 1; i < count - 1; ++i) {
            Body const next = body(i);
            dca::ReleasedHinge<double> const hinge = go_on(before, next);
            if (leads()) kept.put(i, hinge);
            before = outboard_handle(next);
        }
        dca::InertiaRun<double> run = whole();
        Body const last = body(count - 1);
        dca::ReleasedHinge<double> hinge;
        dca::RunsEnd<double> const end = end_run(run, before, last, hinge);
        if (leads()) {
            kept.put(count - 1, hinge);
            kept.put(end);
        }
        return segment_of(run, end, last);
    }

  private:
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
    __device__ dca::ReleasedHinge<double> go_on(dca::OutboardHandle<double> const& before, Body const& body) {
        dca::HingePassed<double> const joint = joint_between(before, body);
        dca::ReleasedHinge<double> h;
        move_point(all_, before.r);
        turn_axes(all_, joint.turn);
        dca::Release<double> const r = release_hinge(all_, joint.axis, h);
        double along[2];
        CATENA_UNROLL
        for (int s = 0; s < 2; ++s) {
            move_point(wrench_[s], before.r);
            turn_axes(wrench_[s], joint.turn);
            along[s] = release_hinge(wrench_[s], r);
        }
        CATENA_UNROLL
        for (int j = 0; j < bias; ++j) h.first[j] = of_lane(along[j / lanes_of_team], j % lanes_of_team);
        h.bias = of_lane(along[bias / lanes_of_team], bias % lanes_of_team);
        Vec3 const to_centre = -body.r1;
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
        for (int s = 0; s < 2; ++s) move_point(wrench_[s], to_centre);
        if (has_bias) add_body(wrench_[1], body);
        move_point(all_, to_centre);
        add_body(all_, body);
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
        typename Sweep::Segment const segment = team.climb(static_cast<int>(dca::longest_run), body, kept);
        sweep.s.note(kept.lost());
        if (team.leads()) sweep.store(run.slot, segment);
    } else if (team.leads()) {
        climb_run(sweep, run);
    }
}
/// Whether so many runs go by teams.
template <class Sweep>
bool go_by_teams(std::int64_t runs) {
    return dca::takes_whole_runs<Sweep> && runs <= most_runs_of_teams;
}
inline RunsGrid grid_of_teams(std::int64_t runs) { return grid_of_runs(runs, lanes_of_team, 32); }

}  // namespace catena::cuda::kernels
