// A run from a scene's start (or a checkpoint) to its last step, with all its files.
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

struct RunOptions {
    std::string output = "catena-run";  // folder
    std::optional<std::int64_t>
        steps;            // instead of dynamics.steps: total, counted from the scene's start
    std::string restart;  // checkpoint to go on from
    bool overwrite = false;
    bool quiet = false;
    bool branch = false;  // from `restart`, in a folder of its own: values of the scene may differ
                          // from the checkpoint's
    StopAgreement::Wish
        stop;  // the run ends after the step that is under way, with a checkpoint and what it has
    std::string command_line;             // for the summary
    std::int64_t bodies_beside = 100000;  // in the scene, from which on frames on one rank are
                                          // written beside the steps that follow
    std::optional<bool> topology_beside;  // the topology's files with the first frame, where that
                                          // is; none: where a GPU does the steps
    double begun = seconds_now();  // when whoever runs it took it up: what a run takes to its first
                                   // step counts from there
    MeasureOwnCosts own_costs = measure_own_costs;  // what solver.balance goes by
};

/// Runs the scene and writes its folder: trajectory.h5md, topology.pdb, observables.csv,
/// checkpoint.h5, summary.json, timeline.json, report.html. Returns the summary (on rank 0;
/// {"valid": ...} on the others). Collective. `valid` is false when the constraint error or a value
/// that is not finite makes the run worthless. A run that `stop` ended has "run": {"stopped_by":
/// ..., "steps": ...}. A branch has "branch": {"from": file, "step": n, "changes": [{"key",
/// "before", "now"}]} and takes dynamics.steps steps where `steps` is not given. Throws InputError
/// for a folder that exists (without restart or overwrite) or a checkpoint of another scene.
nlohmann::json run_simulation(Scene const&, Communicator const&, RunOptions const&);

}  // namespace catena
