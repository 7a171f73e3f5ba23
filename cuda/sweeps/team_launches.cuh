// Kernels of passes of runs on revolute joints by teams of lanes (revolute_teams.cuh), their grids,
// and the choice between teams and one thread per run. Precondition of the kernels: the sweep takes
// whole runs. tests/support/cuda_on_host.hpp, included first, makes this file compile on the host.
#pragma once

#include "cuda/sweeps/revolute_teams.cuh"

namespace catena::cuda::kernels {

/// Inward pass of one run by a team.
template <bool whole, class Sweep>
__device__ __forceinline__ void climb_by_team(Sweep const& sweep, dca::Run const& run, int lane,
                                              bool works) {
    RevoluteTeam<whole> team(BodiesOfTeam<whole>(run), lane, works);
    auto const of_run = sweep.whole(run);
    dca::RunWorkspace<typename Sweep::Sweeps> kept(sweep.s, run, of_run.goes_by_all());
    BodiesAhead const ahead(shared_numbers, lane);
    auto const put_row = [&](int i, dca::SegmentRow<double, Sweep::K> const& row) {
        of_run.store_row(i, row);
    };
    if (of_run.follows()) {
        team.climb(of_run.with_loads(), of_run.goes_by_all(), ahead, kept, put_row);
    } else {
        auto const body = [&](int i) {
            return sweep.s.leaf.revolute(sweep.bodies.loads, run.body + i);
        };
        team.climb(body, ahead, kept, put_row);
    }
    sweep.s.note(kept.lost());
}
/// Outward pass of one run by a team.
template <bool whole, class Sweep>
__device__ __forceinline__ void descend_by_team(Sweep const& sweep, dca::Run const& run, int lane,
                                                bool works) {
    auto const of_run = sweep.whole(run);
    BodiesOfTeam<whole> const bodies(run);
    bool const leads = works && lane % lanes_of_team == 0;
    dca::RunWorkspace<typename Sweep::Sweeps> const kept(sweep.s, run, false);
    auto const first = sweep.s.forces.load(run.body), next = sweep.s.forces.load(run.next);
    RevolutesBehind<Sweep, whole> const behind(bodies, shared_numbers, lane);
    behind.fetch(kept, first, [&](int i) { return of_run.frame(kept, i); });
    dca::descend_revolutes<double>(
        bodies.count(), false, [&](int i) { return behind.frame(i); }, behind, first, next,
        [&](int i, dca::RevoluteFrame<double> const& frame,
            dca::BodyAcceleration<double> const& a) {
            if (leads) of_run.accelerate(i, frame, a);
        },
        [](int, dca::BodyAcceleration<double>&) {},
        [&](int i, double of_revolute) {
            if (leads) of_run.joint_acceleration(i, of_revolute);
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
/// Kernel of the inward pass by teams. Teams take runs on revolute joints of three or more bodies.
/// A thread takes the remaining runs.
template <class Sweep>
__global__ void __launch_bounds__(32) climb_runs_by_teams(RunsView runs, Sweep sweep) {
    int const lane = static_cast<int>(threadIdx.x) % 32;
    std::int64_t const wanted = thread() / lanes_of_team;
    bool const works = wanted < runs.count;
    dca::Run const run = runs[works ? wanted : runs.count - 1];
    bool const by_revolutes = run.count > 2 && sweep.whole(run).is_on_revolutes();
    bool const whole = all_lanes(lane, by_revolutes && run.count == dca::longest_run);
    wait_for_launch();
    if (whole) {
        climb_by_team<true>(sweep, run, lane, works);
        return;
    }
    if (!all_lanes(lane, !by_revolutes)) {
        dca::Run const of_team = for_team(runs, wanted, run, by_revolutes);
        climb_by_team<false>(sweep, of_team, lane, works && by_revolutes);
    }
    if (by_revolutes) return;
    if (works && lane % lanes_of_team == 0) climb_run(sweep, run);
}
/// Kernel of the outward pass by teams. If results of every body are required, a thread computes
/// them one after the other.
template <class Sweep>
__global__ void __launch_bounds__(32) descend_runs_by_teams(RunsView runs, Sweep sweep) {
    int const lane = static_cast<int>(threadIdx.x) % 32;
    std::int64_t const wanted = thread() / lanes_of_team;
    bool const works = wanted < runs.count;
    dca::Run const run = runs[works ? wanted : runs.count - 1];
    bool const by_revolutes =
        run.count > 2 && !sweep.out.by_all_bodies() && sweep.whole(run).is_on_revolutes();
    bool const whole = all_lanes(lane, by_revolutes && run.count == dca::longest_run);
    wait_for_launch();
    if (whole) {
        descend_by_team<true>(sweep, run, lane, works);
        return;
    }
    if (!all_lanes(lane, !by_revolutes)) {
        dca::Run const of_team = for_team(runs, wanted, run, by_revolutes);
        descend_by_team<false>(sweep, of_team, lane, works && by_revolutes);
    }
    if (by_revolutes) return;
    if (works && lane % lanes_of_team == 0) descend_run(sweep, run);
}
/// Returns the grid of a launch by teams. `numbers_of_warp`: shared memory in doubles.
inline RunsGrid grid_of_teams(std::int64_t runs, std::size_t numbers_of_warp) {
    RunsGrid grid = grid_of_runs(runs, lanes_of_team, 32);
    grid.shared_bytes = sizeof(double) * numbers_of_warp;
    return grid;
}
/// Returns the grid of climb_runs_by_teams().
inline RunsGrid grid_of_climb_by_teams(std::int64_t runs) {
    return grid_of_teams(runs, BodiesAhead::size);
}
/// Returns the grid of descend_runs_by_teams().
template <class Sweep>
RunsGrid grid_of_descent_by_teams(std::int64_t runs) {
    return grid_of_teams(runs, RevolutesBehind<Sweep, true>::size);
}
/// Largest number of runs for teams. More runs keep a GPU busy with one thread per run.
constexpr std::int64_t most_runs_of_teams = 2048;

}  // namespace catena::cuda::kernels
