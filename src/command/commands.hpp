// The work of the commands. All are collective; what they return counts on rank 0.
#pragma once

#include "console/outcome.hpp"
#include "console/requests.hpp"
#include "mpi/communicator.hpp"
#include "scene/scene.hpp"

namespace catena::command {

/// What the scene is: chains, bodies, degrees of freedom, handle kinds, forces, memory. `json`:
/// whether the outcome's is asked for, whose list of chains takes a kilobyte a chain.
Outcome check_scene(Scene const&, Communicator const&, bool json);

/// What will run, how long it takes, what is left out, and why.
Outcome plan_scene(Scene const&, Communicator const&, PlanRequest const&);
/// Measures every kind of chain, and keeps that.
Outcome calibrate(Communicator const&, PlanRequest const&);

/// One evaluation, timed, with its residual.
Outcome solve_scene(Scene, Communicator const&, SolveRequest const&);

/// A simulation with its folder.
Outcome run_scene(Scene, Communicator const&, RunRequest const&);

/// What `report` measures: the solver's error on all scenes, the integrators' and forces' on those
/// that have them.
struct ReportScenes {
    std::vector<Scene> solver, integrators, forces, drift;
    std::vector<Scene> slow;  // of the integrators, whose stiff springs hardly vibrate
    double time = 0;          // of the integrators; 0: 32 steps of each scene's own
    std::vector<std::string>
        left_out;  // what is measured of some scenes and not of others, and why
};
/// Error against run time, or the stability suite (no scenes); writes report.json, report.html and,
/// where Python can draw them, pictures.
Outcome report_scenes(ReportScenes const&, Communicator const&, ReportRequest const&);
Outcome report_stability(Communicator const&, ReportRequest const&);

}  // namespace catena::command
