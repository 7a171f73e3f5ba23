// Implements `catena plan`.
#include <fmt/format.h>

#include <algorithm>

#include "command/commands.hpp"
#include "integrate/chain_system.hpp"
#include "integrate/constrained_integrator.hpp"
#include "integrate/joint_integrators.hpp"
#include "plan/cache.hpp"
#include "plan/describe.hpp"
#include "plan/host_memory.hpp"
#include "plan/plan_messages.hpp"
#include "plan/plan_steps.hpp"
#include "plan/predictions.hpp"
#include "plan/savings.hpp"
#include "scene/branch_limits.hpp"
#include "scene/branches.hpp"
#include "scene/loops.hpp"
#include "terms/force_terms.hpp"

namespace catena::command {
namespace {

/// Returns the axes in which the scene's integrator evaluates.
Axes axes_for(Scene const& scene) {
    return scene.dynamics.given && !uses_joint_coordinates(scene.dynamics.integrator) ? Axes::world
                                                                                      : Axes::joint;
}

/// Collective operations of one evaluation of a group.
struct Rounds {
    /// True if the end of a rank's range cuts a chain.
    bool shared = false;
    /// Collectives per matrix sweep, per bias sweep and per pass of the kinematics.
    int matrices = 0, biases = 0, kinematics = 0;
};
/// Counts the collectives of a group.
Rounds rounds_of(ChainGroup const& group) {
    Rounds r;
    for (int chain = 0; chain < group.partition.chains(); ++chain)
        r.shared = r.shared || group.partition.is_split(chain);
    r.matrices = r.biases = r.shared ? 1 : 0;
    r.kinematics = r.shared && !group.beads && group.axes == Axes::joint ? 1 : 0;
    return r;
}

/// Returns the number of bodies of each rank.
std::vector<std::int64_t> shares_of(ChainGroup const& group) {
    std::vector<std::int64_t> shares;
    for (std::size_t r = 0; r + 1 < group.first_of_rank().size(); ++r)
        shares.push_back(group.first_of_rank()[r + 1] - group.first_of_rank()[r]);
    return shares;
}

/// Formats the numbers of bodies; for many ranks the smallest and the largest.
std::string shares_text(std::vector<std::int64_t> const& shares) {
    if (shares.size() <= 8) return fmt::format("{}", fmt::join(shares, ", "));
    auto const [least, most] = std::minmax_element(shares.begin(), shares.end());
    return fmt::format("{} to {} on {} ranks", *least, *most, shares.size());
}

/// Returns the tree of the longest chain.
dca::ChainTree const& longest_tree(ChainGroup const& group) {
    return *std::max_element(group.partition.trees.begin(), group.partition.trees.end(),
                             [](auto const& a, auto const& b) { return a.bodies < b.bodies; });
}

/// Counts of the tree of a group's longest chain, of the paths of branched chains, or of the levels
/// of branched chains of rigid bodies.
struct TreeCounts {
    std::int64_t runs = 0, levels = 0, depth = 0;
};
TreeCounts counts_of(ChainGroup const& group, Scene const& scene, SolverReport const& report) {
    dca::ChainTree const& tree = longest_tree(group);
    if (!group.is_branched()) return {tree.runs, tree.levels(), tree.depth()};
    if (!group.beads) {
        TreeCounts counts{group.partition.bodies(), 0, report.depth};
        for (GroupChain const& chain : group.chains)
            counts.levels = std::max(
                counts.levels,
                1 + scene::height_of(scene.chains[static_cast<std::size_t>(chain.in_scene)]));
        return counts;
    }
    dca::BranchCounts const& branched = group.branching.paths.of_all_ranks;
    return {branched.runs, branched.levels, branched.depth};
}

/// Describes the tree of a group's longest chain, or the paths of branched chains.
std::string tree_text(ChainGroup const& group, TreeCounts const& counts) {
    dca::ChainTree const& tree = longest_tree(group);
    if (group.is_branched() && !group.beads)
        return fmt::format("{} bodies, swept by {}; depth {}", group.partition.bodies(),
                           counted(counts.levels, "level", "levels"), counts.depth);
    std::string const bodies =
        group.is_branched()
            ? fmt::format(
                  "{} bodies in {} and {}: {} of up to {} bodies, at most {} of "
                  "merges in a phase",
                  group.partition.bodies(),
                  counted(group.branching.paths.of_all_ranks.paths, "path", "paths"),
                  counted(group.branching.paths.of_all_ranks.phases, "phase", "phases"),
                  counted(counts.runs, "run", "runs"), tree.run_length,
                  counted(counts.levels, "level", "levels"))
            : fmt::format("{} bodies: {} of up to {} bodies, then {} of merges", tree.bodies,
                          counted(counts.runs, "run", "runs"), tree.run_length,
                          counted(counts.levels, "level", "levels"));
    return fmt::format("{}; depth {}; table version {}", bodies, counts.depth,
                       dca::tree_table_version);
}

/// Cross-links of a group's chains, whichever ranks have them.
struct CrossLinkCounts {
    std::size_t all = 0, most_of_a_chain = 0;
};
CrossLinkCounts crosslinks_of(ChainGroup const& group, Scene const& scene) {
    CrossLinkCounts counts;
    for (GroupChain const& chain : group.chains) {
        std::size_t const own =
            scene.chains[static_cast<std::size_t>(chain.in_scene)].crosslinks.size();
        counts.all += own;
        counts.most_of_a_chain = std::max(counts.most_of_a_chain, own);
    }
    return counts;
}

/// Kind of a group's chains for messages, with a blank: "branched ", "cross-linked " or nothing.
std::string chain_word(ChainGroup const& group, CrossLinkCounts const& crosslinks) {
    if (crosslinks.all > 0) return "cross-linked ";
    return group.is_branched() ? "branched " : "";
}

/// Describes the cost of cross-links.
std::string crosslinks_text(CrossLinkCounts const& crosslinks) {
    std::size_t const most = crosslinks.most_of_a_chain;
    return fmt::format(
        "{}, up to {} a chain: after each matrix sweep {} for their responses and systems of up to "
        "{} x {}; bias sweeps are made twice",
        crosslinks.all, most, counted(static_cast<std::int64_t>(most), "bias sweep", "bias sweeps"),
        most, most);
}

/// Loops of a group's chains, and the directions that they restrict.
struct LoopCounts {
    std::size_t all = 0;
    std::int64_t most_directions_of_a_chain = 0;
};
LoopCounts loops_of(ChainGroup const& group, Scene const& scene) {
    LoopCounts counts;
    for (GroupChain const& of : group.chains) {
        ChainSpec const& chain = scene.chains[static_cast<std::size_t>(of.in_scene)];
        counts.all += chain.loops.size();
        counts.most_directions_of_a_chain =
            std::max(counts.most_directions_of_a_chain, scene::directions_of_loops(chain));
    }
    return counts;
}

/// Describes the cost of loops.
std::string loops_text(LoopCounts const& loops) {
    std::int64_t const most = loops.most_directions_of_a_chain;
    return fmt::format(
        "{}, up to {} restricted directions a chain: after each matrix sweep {} for their "
        "responses and systems of up to {} x {}; bias sweeps are made twice",
        loops.all, most, counted(most, "bias sweep", "bias sweeps"), most, most);
}

/// Adds the description of a group: blocks, tree, units, collectives and memory.
void add_group(Text& text, Json& list, ChainGroup const& group, Scene const& scene,
               SolverReport const& report) {
    CrossLinkCounts const crosslinks = crosslinks_of(group, scene);
    std::string const word = chain_word(group, crosslinks);
    dca::ChainTree const& tree = longest_tree(group);
    Rounds const rounds = rounds_of(group);
    std::vector<std::int64_t> const shares = shares_of(group);
    text.heading(fmt::format("{} of {} ({})",
                             counted(group.partition.chains(), word + "chain", word + "chains"),
                             group.beads ? "beads on links" : "bodies", group.kind()));
    text.entry("blocks", block_text(group.beads, group.directions, group.handles));
    TreeCounts const counts = counts_of(group, scene, report);
    text.entry("tree", tree_text(group, counts));
    if (crosslinks.all > 0) text.entry("cross-links", crosslinks_text(crosslinks));
    LoopCounts const loops = loops_of(group, scene);
    if (loops.all > 0) text.entry("loops", loops_text(loops));
    if (!group.is_branched())
        text.entry(
            "units",
            fmt::format("{} (one rank computes each; every rank computes the tree above them)",
                        tree.units));
    text.entry("bodies per rank", shares_text(shares));
    text.entry(
        "collectives",
        rounds.shared
            ? fmt::format("matrices {} per sweep, biases {} per sweep, kinematics {}",
                          rounds.matrices, rounds.biases, rounds.kinematics > 0 ? "1" : "none") +
                  (report.direct_exchange ? "; from GPU to GPU" : "")
            : "none: no chain is shared by ranks");
    text.entry("solver memory",
               bytes_text(static_cast<double>(report.memory_bytes)) + " on this rank");
    list.push_back({{"kind", group.kind()},
                    {"chains", group.partition.chains()},
                    {"bodies", group.partition.bodies()},
                    {"directions", group.directions},
                    {"run_length", tree.run_length},
                    {"runs", counts.runs},
                    {"levels", counts.levels},
                    {"depth", counts.depth},
                    {"crosslinks", crosslinks.all},
                    {"loops", loops.all},
                    {"directions_of_loops", loops.most_directions_of_a_chain},
                    {"units", group.is_branched() ? 1 : tree.units},
                    {"bodies_of_ranks", shares},
                    {"collectives",
                     {{"matrices", rounds.matrices},
                      {"biases", rounds.biases},
                      {"kinematics", rounds.kinematics}}},
                    {"direct_exchange", report.direct_exchange},
                    {"solver_memory_bytes", report.memory_bytes}});
}

/// Sweeps of one time step and their explanation.
struct StepPlan {
    int matrix_sweeps = 0, bias_sweeps = 0, bias_sweeps_a_drift_sweep = 0;
    std::string text;
};
/// Counts the sweeps of an integrator in joint coordinates that kicks rates and moves joints by
/// turns.
StepPlan kicks_of(DynamicsSpec const& d, bool tips, int corrections) {
    SweepsAStep const sweeps = sweeps_a_step(d, tips);
    std::string text = sweeps.matrices == 2 ? "2 matrix sweeps (kick, thermostat); 3 bias "
                                              "sweeps (2 of the kick, thermostat)"
                                            : "1 matrix sweep; 2 bias sweeps of the kick";
    if (is_implicit(d.integrator))
        text += "; joints with springs or dampers are implicit: their chains have full handles";
    if (tips)
        text += fmt::format(
            "; {} corrections that close jointed tips, a matrix sweep and a bias sweep each",
            corrections);
    return {sweeps.matrices + corrections, sweeps.biases + corrections, 0, text};
}

/// Counts the sweeps of an integrator in joint coordinates whose steps consist of evaluations.
StepPlan evaluations_of(DynamicsSpec const& d, bool tips, int corrections) {
    int const evaluations = sweeps_a_step(d, tips).matrices;
    std::string const inner =
        d.tolerance > 0
            ? fmt::format(" for each inner step (tolerance {:g} determines their number)",
                          d.tolerance)
            : "";
    return {evaluations + corrections, evaluations + corrections, 0,
            fmt::format("{}{}: a matrix sweep and a bias sweep each; {}",
                        counted(evaluations, "evaluation", "evaluations"), inner,
                        tips ? fmt::format("{} corrections that close tips and loops, again "
                                           "a matrix sweep and a bias sweep each",
                                           corrections)
                             : "joint coordinates need no projection")};
}

/// Counts the sweeps of the scene's integrator.
StepPlan step_of(Scene const& scene) {
    DynamicsSpec const& d = scene.dynamics;
    bool const tips = has_closures(scene);
    int const corrections = tips ? JointDynamics::usual_corrections + 1 : 0;
    if (is_refined(d.integrator)) return evaluations_of(d, tips, corrections);
    if (uses_joint_coordinates(d.integrator)) return kicks_of(d, tips, corrections);
    std::string const chosen = fmt::format(
        "s is the smallest number that closes the joints to {:g} at the start; a run adds one when "
        "they no longer close",
        ConstrainedIntegrator::early * d.constraint_tolerance);
    if (is_langevin(d.integrator))
        return {2, 2, 2,
                "2 matrix sweeps; 2 + 2 s bias sweeps: projections of the kick and of the "
                "thermostat, s for either half drift; " +
                    chosen};
    return {1, 1, 1,
            "1 matrix sweep; 1 + s bias sweeps: 1 projection of the velocities (both half "
            "kicks in one), s of the drift; " +
                chosen};
}

/// Adds the integrator and the sweeps of a step.
void add_dynamics(Text& text, Json& json, Scene const& scene) {
    text.heading("dynamics");
    text.entry("integrator", dynamics_text(scene));
    json["dynamics"] = nullptr;
    if (!scene.dynamics.given) return;
    StepPlan const step = step_of(scene);
    text.entry("per step", step.text);
    json["dynamics"] = {
        {"integrator", name_of(scene.dynamics.integrator)},
        {"matrix_sweeps_a_step", step.matrix_sweeps},
        {"bias_sweeps_a_step",
         {{"fixed", step.bias_sweeps}, {"each_drift_sweep", step.bias_sweeps_a_drift_sweep}}}};
}

/// Adds the frames and checkpoints that a run would write.
void add_output(Text& text, Json& json, Scene const& scene) {
    if (!scene.dynamics.given) return;
    OutputSpec const& o = scene.output;
    bool const bodies = std::any_of(scene.chains.begin(), scene.chains.end(),
                                    [](ChainSpec const& c) { return !c.is_beads(); });
    std::int64_t const frames = scene.dynamics.steps / o.every + 1;
    double const numbers = 3 + (o.velocities ? 3 : 0) + (bodies ? 4 : 0) + (o.joint_forces ? 6 : 0);
    double const size =
        8.0 * numbers * static_cast<double>(scene.bodies()) * static_cast<double>(frames);
    text.heading("output");
    text.entry("frames", fmt::format("{}, one every {} steps; trajectory about {}", frames, o.every,
                                     bytes_text(size)));
    text.entry("checkpoints", o.checkpoint_every > 0
                                  ? fmt::format("every {} steps and at the end", o.checkpoint_every)
                                  : "at the end");
    json["output"] = {
        {"frames", frames}, {"trajectory_bytes", size}, {"checkpoint_every", o.checkpoint_every}};
}

/// Adds the estimated memory on host and GPU.
void add_memory(Text& text, Json& json, Scene const& scene, Predictions const& predictions,
                int ranks) {
    Memory const memory = memory_of(scene, ranks);
    text.heading("memory per rank");
    text.entry("host", bytes_text(memory.sum()));
    std::string const why = terms::why_host_alone(scene);
    text.entry("GPU", why.empty() ? bytes_text(predictions.gpu_memory) + " with backend cuda" +
                                        (predictions.no_gpu.empty() ? "" : ", if there were a GPU")
                                  : "not usable: " + why);
    json["memory_bytes_per_rank"] = {{"host", memory.sum()}, {"gpu", nullptr}};
    if (why.empty()) json["memory_bytes_per_rank"]["gpu"] = predictions.gpu_memory;
}

/// Returns the time step that enters the matrices of implicit joints; 0 for explicit integrators.
double implicit_step_of(Scene const& scene) {
    return scene.dynamics.given && is_implicit(scene.dynamics.integrator) ? scene.dynamics.step
                                                                          : 0.0;
}

/// Measures the phases of an evaluation of the chains without OpenMM. Throws InputError for
/// implicit-g-baoab.
plan::PhaseSeconds measure(Scene scene, Axes axes, Communicator const& communicator) {
    if (scene.dynamics.given && is_implicit(scene.dynamics.integrator) &&
        !uses_joint_coordinates(scene.dynamics.integrator))
        throw InputError("implicit-g-baoab has no evaluation outside a step that could be measured",
                         "--measure", "leave it out, and see the time per step of a run");
    scene.forces.openmm.reset();
    ChainSystem system(scene, axes, communicator, implicit_step_of(scene));
    return plan::measure_phases(system, {5, 200, 0.5});
}

/// Adds what the system runs on: backend, ranks and threads.
void add_backend(Text& text, Json& json, ChainSystem const& system, std::string const& reason) {
    Scene const& scene = system.scene();
    Communicator const& communicator = system.communicator();
    GatherWay const& way = communicator.gather_way();
    json = {{"scene", scene.file},
            {"backend", name_of(system.backend())},
            {"backend_reason", reason},
            {"ranks", communicator.size()},
            {"balance", scene.solver.balance},
            {"gathers", {{"stages", way.stages}, {"hosts", way.hosts}}},
            {"threads", system.executor().threads()},
            {"handles", name_of(scene.solver.handles)},
            {"gpu_levels", gpu_levels_json(scene)},
            {"tree_table", dca::tree_table_version},
            {"groups", Json::array()}};
    text.heading(title_of(scene));
    text.entry("backend", fmt::format("{} ({})", name_of(system.backend()), reason));
    if (!json["gpu_levels"].is_null())
        text.entry("levels on the GPU",
                   json["gpu_levels"].get<std::string>() +
                       " of the lowest levels (up,down); the host's threads compute the others");
    text.entry("ranks", std::to_string(communicator.size()));
    if (communicator.size() > 1) text.entry("gathers", way.text());
    if (scene.solver.balance)
        text.entry("balance", communicator.size() == 1
                                  ? "no effect on one rank"
                                  : "`run` measures the speeds of the ranks and divides the chains "
                                    "accordingly; this plan assumes equal speeds");
    text.entry("threads per rank", std::to_string(system.executor().threads()));
}

/// Adds the forces.
void add_forces(Text& text, Json& json, ChainSystem const& system) {
    Scene const& scene = system.scene();
    text.heading("forces");
    text.entry("gravity", terms::vector_text(scene.forces.gravity));
    text.entry("joints and bodies", loads_text(scene));
    json["openmm"] = nullptr;
    if (!system.openmm()) return;
    json["openmm"] = system.openmm()->description();
    for (std::size_t i = 0; i < json["openmm"].size(); ++i)
        text.entry(i == 0 ? "OpenMM" : "", json["openmm"][i].get<std::string>());
    text.entry("",
               "on path host the matrix sweep runs during OpenMM's forces, because matrices do "
               "not depend on forces");
}

/// Adds what is left out, with the time that this saves if the request asks for it. Collective.
void add_left_out(Text& text, Json& json, ChainSystem const& system, PlanRequest const& request) {
    Scene const& scene = system.scene();
    text.heading("left out");
    json["left_out"] = Json::array();
    for (Savings const& each : left_out(scene, system)) {
        json["left_out"].push_back(each.text);
        if (!request.explain) text.note(each.text);
    }
    if (request.explain) add_savings(text, json, scene, system);
}

/// Adds the notes on the scene, and on memory that this host lacks.
void add_notes(Text& text, Json& json, Scene const& scene,
               std::optional<HostMemory> const& lacking) {
    std::vector<std::string> notes = notes_on(scene, estimate_step_limit(scene));
    if (lacking) notes.push_back(lacking->note());
    if (std::any_of(scene.chains.begin(), scene.chains.end(), scene::is_body_tree))
        notes.push_back(
            "branched chains of rigid bodies are predicted as unbranched ones, and may take a "
            "fifth "
            "of that: --measure shows it");
    if (std::any_of(scene.chains.begin(), scene.chains.end(), [](ChainSpec const& chain) {
            return chain.is_beads() && scene::branches(chain);
        }))
        notes.push_back(
            "branched chains of beads are predicted as unbranched ones; with short side chains "
            "they take "
            "about twice as long, with many branchings longer: --measure shows it");
    if (std::any_of(scene.chains.begin(), scene.chains.end(),
                    [](ChainSpec const& chain) { return chain.is_cross_linked(); }))
        notes.push_back(
            "cross-linked chains are predicted without their cross-links, which take further bias "
            "sweeps: --measure shows the time");
    if (std::any_of(scene.chains.begin(), scene.chains.end(),
                    [](ChainSpec const& chain) { return chain.has_loops(); }))
        notes.push_back(
            "chains with loops are predicted without them; their responses take further bias "
            "sweeps: --measure shows the time");
    json["notes"] = Json::array();
    for (std::string const& note : notes) {
        json["notes"].push_back(note);
        text.note(note);
    }
}

/// Returns the plan for the chosen backend. Collective.
Outcome plan_chosen(Scene const& scene, Axes axes, Communicator const& communicator,
                    PlanRequest const& request, Predictions predictions) {
    auto const lacking = lacking_memory(scene, communicator);
    ChainSystem const system(scene, axes, communicator, implicit_step_of(scene));
    predictions.choice.arrangement = {system.backend(), system.executor().threads()};
    std::vector<SolverReport> const reports = system.solver_reports();
    Outcome outcome;
    Json& json = outcome.json;
    Text text;
    add_backend(text, json, system, predictions.choice.reason);
    for (std::size_t i = 0; i < reports.size(); ++i)
        add_group(text, json["groups"], *system.groups()[i], system.scene(), reports[i]);
    add_memory(text, json, scene, predictions, communicator.size());
    add_forces(text, json, system);
    add_dynamics(text, json, scene);
    add_messages(text, json, system, request, predictions);
    add_output(text, json, scene);
    add_left_out(text, json, system, request);
    if (communicator.rank() == 0) add_predictions(text, json, predictions);
    add_notes(text, json, scene, lacking);
    if (request.measure) {
        plan::PhaseSeconds const measured = measure(scene, axes, communicator);
        if (communicator.rank() == 0) add_measured(text, json, predictions, measured);
    }
    outcome.text = text.str();
    return outcome;
}

}  // namespace

Outcome calibrate(Communicator const& communicator, PlanRequest const& request) {
    Outcome outcome;
    int const threads = request.threads.empty() ? 0 : std::stoi(request.threads);
    plan::with_planner(
        communicator, threads, plan::largest_at_start, "", [&](plan::Planner& planner) {
            double const start = seconds_now();
            planner.measure_everything();
            std::string const file = plan::cache_file(planner.machine());
            outcome.text = fmt::format(
                "{}\n  {} measured in {:.3g} s; {}\n", planner.machine().identity,
                counted(static_cast<long long>(planner.calibration().points()), "point", "points"),
                seconds_now() - start,
                file.empty() ? "there is no folder to keep them: set XDG_CACHE_HOME"
                             : "kept in " + file);
            outcome.json = {{"machine", planner.machine().identity},
                            {"points", planner.calibration().points()},
                            {"file", file}};
        });
    return outcome;
}

Outcome plan_scene(Scene const& given, Communicator const& communicator,
                   PlanRequest const& request) {
    scene::refuse_unsupported_branches(given);
    Axes const axes = axes_for(given);
    Predictions predictions;
    auto const choose = [&](Scene const& scene, std::string const& no_gpu) {
        plan::with_planner(communicator, scene.solver.threads, largest_sample, no_gpu,
                           [&](plan::Planner& planner) {
                               predictions = predict(planner, scene, axes, communicator.size());
                               if (request.ranks > 0 && scene.dynamics.given)
                                   predict_steps(predictions, planner, scene, axes, request.ranks);
                           });
        share(communicator, predictions.choice);
        return predictions.choice;
    };
    Outcome outcome;
    plan::with_choice(given, choose, [&](Scene const& scene, plan::Choice const&) {
        outcome = plan_chosen(scene, axes, communicator, request, predictions);
    });
    return outcome;
}

}  // namespace catena::command
