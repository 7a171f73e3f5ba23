// Simulation from a scene's start (or a checkpoint) to its last step, with all output files.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "clock.hpp"
#include "mpi/communicator.hpp"
#include "run/balance.hpp"
#include "run/stop_agreement.hpp"
#include "scene/scene.hpp"

namespace catena {

/// Options of a run, mostly from the command line.
struct RunOptions {
    std::string output = "catena-run";  // folder of all output files
    std::optional<std::int64_t>
        steps;            // replaces dynamics.steps: total number, counted from the scene's start
    std::string restart;  // checkpoint from which the run continues
    bool overwrite = false;  // replaces the files of an existing folder
    bool quiet = false;      // prints no progress
    bool branch = false;     // continues from `restart` in a new folder: values of the scene may
                             // differ from the checkpoint's
    StopAgreement::Wish
        stop;  // requests the end after the current step, with a checkpoint and the files so far
    std::string command_line;            // text for the summary
    std::int64_t bodies_beside = 10000;  // number of bodies in the scene from which frames of one
                                         // rank are written concurrently with the steps that follow
    std::optional<bool>
        topology_beside;  // topology files are written with the first frame, if that is written
                          // concurrently; empty: if a GPU computes the steps
    double begun =
        seconds_now();  // start of the program: the time to the first step is measured from it
    MeasureOwnCosts own_costs = measure_own_costs;  // measurement on which solver.balance is based
};

/// Runs the scene and writes its folder: trajectory.h5md, topology.pdb, observables.csv,
/// checkpoint.h5, summary.json, timeline.json, report.html. Returns the summary on rank 0, and
/// {"valid": ...} with "run" on the other ranks. `valid` is false if a check of the verdict fails
/// (observe/verdict.hpp). A run ended by `stop` has "run": {"stopped_by": ..., "steps": ...}. A
/// branch has "branch": {"from": file, "step": n, "changes": [{"key", "before", "now"}]}. It runs
/// for dynamics.steps steps unless `steps` is set. Throws InputError for a folder that exists
/// (without restart or overwrite) or a checkpoint of another scene. Collective.
nlohmann::ordered_json run_simulation(Scene const&, Communicator const&, RunOptions const&);

}  // namespace catena
