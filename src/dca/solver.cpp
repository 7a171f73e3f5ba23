// Default implementations of the solver interface, and the error message for pivot failures.
#include "dca/solver.hpp"

#include <algorithm>

#include "dca/host_space.hpp"
#include "dca/pivot_failure.hpp"
#include "error.hpp"

namespace catena {

std::vector<double> ChainSolver::time_evaluations(ConfigurationView const& configuration,
                                                  LoadsView const& loads,
                                                  AccelerationsView const& out, int chained,
                                                  int repeat) {
    auto const executor = serial_executor();
    return HostSpace(*executor).time_chained(
        chained, repeat, true, [&] { assemble_and_solve(configuration, loads, out); });
}

void ChainSolver::invert(InverseView const& /*out*/) {
    throw ComputationError("this solver does not keep the inverse of its matrix");
}

void add_tree(ChainGroup const& group, Communicator const& communicator, SolverReport& report) {
    report.directions = group.directions;
    report.ranks = communicator.size();
    for (dca::ChainTree const& tree : group.partition.trees) {
        report.run_length = std::max(report.run_length, tree.run_length);
        report.depth = std::max(report.depth, tree.depth());
    }
    if (group.is_branched()) report.depth = group.branching.paths.of_all_ranks.depth;
}

void refuse_indefinite(ChainGroup const& group, int rank, std::int64_t joint) {
    dca::Schedule const& schedule = group.schedule;
    std::int64_t chain, body;
    // Joints are stored in this order: own bodies and halo, jointed tips, top of shared chains
    // (Schedule).
    if (joint <= schedule.halo) {
        std::int64_t const global = group.partition.first_of_rank[rank] + joint;
        chain = group.partition.chain_of(global);
        body = global - group.partition.first_of_chain[chain];
    } else if (joint < schedule.first_top_joint()) {
        chain = schedule.tip_chain[joint - schedule.first_tip()];
        body = group.partition.trees[chain].bodies;
    } else {
        chain = schedule.top_chain_of_joint[joint - schedule.first_top_joint()];
        body = schedule.top_body_of_joint[joint - schedule.first_top_joint()];
    }
    bool const tip = body == group.partition.trees[chain].bodies;
    // The message recommends articulated handles where they exist: open chains in joint coordinates
    // without implicit springs.
    bool const open =
        !group.beads && !group.linked && group.axes == Axes::joint && !group.ends.has_tips();
    bool const may = open && group.handles != Handles::articulated && group.joints.implicit.empty();
    std::string const what =
        group.handles == Handles::articulated ? "an articulated inertia" : "the matrix of a joint";
    throw ComputationError(what + " is not positive definite (chain " + group.chains[chain].name +
                           (tip ? ", the tip's joint" : ", body " + std::to_string(body + 1)) +
                           "): " + dca::cause_of_lost_matrix +
                           (may ? "; `handles: articulated` keeps more digits" : ""));
}

}  // namespace catena
