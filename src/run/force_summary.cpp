// Implements the summary of OpenMM's forces.
#include "run/force_summary.hpp"
#include "mpi/collectives.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

namespace catena {
namespace {

using nlohmann::json;

/// Summary of ghosts: beads of other ranks that a rank's forces need. Lists have one entry per
/// rank. Collective.
json summary_of_ghosts(ChainSystem const& system, GhostTraffic const& traffic, std::int64_t steps) {
    Communicator const& communicator = system.communicator();
    auto const a_step = [&](std::int64_t own) {
        std::vector<double> shares;
        for (std::int64_t const all : all_gathered(communicator, own))
            shares.push_back(static_cast<double>(all) /
                             static_cast<double>(std::max<std::int64_t>(1, steps)));
        return shares;
    };
    std::vector<std::int64_t> own;
    for (int rank = 0; rank < communicator.size(); ++rank)
        own.push_back(system.beads().first_of_rank[rank + 1] - system.beads().first_of_rank[rank]);
    return {{"evaluations", traffic.updates},
            {"rebuilds", traffic.rebuilds},
            {"direct", traffic.direct},
            {"seconds_of_lists", system.communicator().max(traffic.seconds_of_lists)},
            {"own_beads", own},
            {"ghosts", all_gathered(communicator, traffic.ghosts)},
            {"most_ghosts", all_gathered(communicator, traffic.most_ghosts)},
            {"contexts", all_gathered(communicator, system.openmm()->contexts())},
            {"messages_a_step", a_step(traffic.messages)},
            {"bytes_a_step", a_step(traffic.bytes)}};
}

/// Adds how often OpenMM's lists of pairs were made and kept.
void add_pair_lists(DevicePath const& path, json& summary) {
    auto const counted = [](DevicePath::PairLists const& lists) {
        return json{{"made", lists.made}, {"kept", lists.kept}};
    };
    if (path.pair_lists().made > 0) summary["pair_lists"] = counted(path.pair_lists());
    for (DevicePath::PairLists const& lists : path.pair_lists_of_layers())
        if (lists.made > 0) summary["pair_lists_of_layers"].push_back(counted(lists));
}

}  // namespace

json summary_of_forces(ChainSystem const& system, std::int64_t steps) {
    OpenMmForce* const openmm = system.openmm();
    if (openmm == nullptr) return nullptr;
    double const matrix = system.matrix_seconds();
    json summary = {{"openmm", openmm_version()},
                    {"platform", openmm->platform()},
                    {"path", openmm->path()},
                    {"description", openmm->description()},
                    {"matrix_sweep_seconds", matrix},
                    {"matrix_sweep_hidden", matrix > 0 ? system.hidden_seconds() / matrix : 0.0},
                    {"largest_context", openmm->largest_context()}};
    if (DevicePath const* const path = openmm->device_path()) add_pair_lists(*path, summary);
    GhostTraffic const traffic = openmm->traffic();
    if (traffic.updates > 0) summary["ghosts"] = summary_of_ghosts(system, traffic, steps);
    return summary;
}

}  // namespace catena
