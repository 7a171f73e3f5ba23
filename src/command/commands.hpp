// The commands. All are collective; their outcomes are complete on rank 0 only.
#pragma once

#include "console/outcome.hpp"
#include "console/requests.hpp"
#include "mpi/communicator.hpp"
#include "scene/scene.hpp"

namespace catena::command {

/// Describes the scene: chains, bodies, degrees of freedom, handle kinds, forces and memory. `json`
/// is true if the outcome's JSON is needed; its list of chains takes about a kilobyte per chain.
Outcome check_scene(Scene, Communicator const&, bool json);

/// Writes the picture that `check --picture` asks for, on rank 0. Throws InputError if no chain of
/// the scene decides its domains by a prediction. Collective.
void draw_domains(CheckRequest const&, Communicator const&);

/// Describes what will run, how long it takes, what is left out, and why.
Outcome plan_scene(Scene const&, Communicator const&, PlanRequest const&);
/// Measures every kind of chain on this machine and writes the times to the cache.
Outcome calibrate(Communicator const&, PlanRequest const&);

/// Computes one evaluation repeatedly, with its times and residual.
Outcome solve_scene(Scene, Communicator const&, SolveRequest const&);

/// Runs a simulation and writes its folder.
Outcome run_scene(Scene, Communicator const&, RunRequest const&);

/// Analyses the trajectory of a run on rank 0 and writes its tables. Collective.
Outcome analyse_run(Communicator const&, AnalyseRequest const&);
/// Writes the trajectory of a run in another format, on rank 0. Collective.
Outcome convert_run(Communicator const&, ConvertRequest const&);

/// Writes a scene from the files of another tool, on rank 0, and checks it. Collective.
Outcome import_folder(Communicator const&, ImportRequest const&);

/// Scenes that `report` measures: the solver's error on all scenes, the errors of integrators and
/// forces on those that have them.
struct ReportScenes {
    std::vector<Scene> solver, integrators, forces, drift;
    /// Scenes for integrators that compare slow motion, whose stiff springs hardly vibrate.
    std::vector<Scene> slow;
    /// Simulated time of the comparison of integrators; 0 for 32 steps of each scene's own step.
    double time = 0;
    /// Measurements that are left out for some scenes, and why.
    std::vector<std::string> left_out;
};
/// Measures error against run time; writes report.json, report.html and, if Python can draw them,
/// pictures.
Outcome report_scenes(ReportScenes const&, Communicator const&, ReportRequest const&);
/// Measures the stability suite, which has scenes of its own; writes the same files.
Outcome report_stability(Communicator const&, ReportRequest const&);

/// Declared keys of the maps, or of the key, that the request names. Throws InputError for a name
/// that is neither.
Outcome declared_keys(KeysRequest const&);

}  // namespace catena::command
