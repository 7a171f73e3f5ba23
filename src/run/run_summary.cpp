// Implements the summary of a run, one function for each of its objects.
#include "run/run_summary.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>
#include <system_error>

#include "math/concentration_units.hpp"
#include "page/observable_statistics.hpp"
#include "run/force_summary.hpp"
#include "scene/alike_chains.hpp"
#include "systems/charges.hpp"
#include "terms/force_terms.hpp"

namespace catena {
namespace {

using Json = nlohmann::ordered_json;

constexpr double seconds_per_day = 86400;

double mass_of(ChainSpec const& chain) {
    std::vector<double> const& mass = chain.is_beads()    ? chain.beads.mass
                                      : chain.is_linked() ? chain.linked.mass
                                                          : chain.bodies.mass;
    return std::accumulate(mass.begin(), mass.end(), 0.0);
}

Json units_of(Scene const& scene) {
    return {{"length", scene.si ? "m" : "nm"},
            {"time", scene.si ? "s" : "ps"},
            {"mass", scene.si ? "kg" : "amu"},
            {"energy", scene.si ? "J" : "kJ/mol"}};
}

/// Adds the concentration, mean over the box.
void add_concentration(Json& system, Scene const& scene) {
    Vec3 const& edges = *scene.box;
    double const volume = edges[0] * edges[1] * edges[2];
    double mass = 0;
    for (ChainSpec const& chain : scene.chains) mass += mass_of(chain);
    system["mass_concentration"] = mass / volume * (scene.si ? 1 : mg_per_ml);
    if (!scene.si)
        system["chain_concentration"] =
            static_cast<double>(scene.chains.size()) / volume * (1e-3 * mmol_per_l);
}

Json system_of(Scene const& scene) {
    std::int64_t beads = 0;
    for (ChainSpec const& chain : scene.chains)
        beads += static_cast<std::int64_t>(chain.bead_count());
    Json system{{"description", scene::chains_text(scene)},
                {"forces", terms::forces_text(scene)},
                {"chains", scene.chains.size()},
                {"bodies", scene.bodies()},
                {"beads", beads},
                {"dof", degrees_of_freedom(scene)}};
    if (scene.replicas > 1) system["replicas"] = scene.replicas;
    if (std::string const charges = assumed_charges(scene); !charges.empty())
        system["net_charge"] = charges;
    if (!scene.box) return system;
    system["box"] = {(*scene.box)[0], (*scene.box)[1], (*scene.box)[2]};
    add_concentration(system, scene);
    return system;
}

/// Number of steps that this run took.
std::int64_t steps_of(SummarySource const& of) {
    return of.record.reached - of.origin.first_step();
}

double simulated_time_of(SummarySource const& of) {
    return static_cast<double>(steps_of(of)) * of.scene.dynamics.step;
}

Json run_of(SummarySource const& of) {
    DynamicsSpec const& dynamics = of.scene.dynamics;
    Json run{{"integrator", name_of(dynamics.integrator)},
             {"step", dynamics.step},
             {"first_step", of.origin.first_step()},
             {"last_step", of.record.reached},
             {"time", of.origin.time(of.record.reached)},
             {"simulated_time", simulated_time_of(of)},
             {"bodies", of.scene.bodies()},
             {"dof", degrees_of_freedom(of.scene)}};
    if (has_thermostat(dynamics)) {
        run["temperature"] = dynamics.temperature;
        run["friction"] = dynamics.friction;
        run["seed"] = dynamics.seed;
    }
    if (of.record.stopped_by != 0)
        run.update({{"stopped_by", of.record.stopped_by}, {"steps", of.origin.last_step()}});
    return run;
}

/// Statistics of the observables; empty on ranks other than 0. Collective.
Json statistics_of(SummarySource const& of) {
    ObservablesTable const table = of.frames.folder().table(),
                           of_replicas = of.frames.folder().table_of_replicas();
    if (of.communicator.rank() != 0) return Json::object();
    DynamicsSpec const& dynamics = of.scene.dynamics;
    bool const forgets = is_langevin(dynamics.integrator) && dynamics.friction > 0;
    Json found = json_of(statistics_of(
        table, forgets ? Frames::equilibrated : Frames::without_thermostat, of_replicas));
    for (std::size_t i = 0; i < of.frames.last_row().size(); ++i)
        found["last_observables"][of.frames.columns()[i]] = of.frames.last_row()[i];
    return found;
}

Json speed_of(SummarySource const& of) {
    RunRecord const& record = of.record;
    auto const steps = static_cast<double>(steps_of(of));
    double const per_second = record.seconds > 0 ? 1 / record.seconds : 0,
                 per_day = simulated_time_of(of) * seconds_per_day * per_second;
    Json speed{{"seconds", record.seconds}, {"steps_per_second", steps * per_second}};
    if (of.scene.si)
        speed["simulated_seconds_per_day"] = per_day;
    else
        speed["ns_per_day"] = 1e-3 * per_day;
    if (steps > 0) speed["milliseconds_per_step"] = 1e3 * record.seconds / steps;
    if (record.rate_of_second_half > 0)
        speed["steps_per_second_of_second_half"] = record.rate_of_second_half;
    if (record.first_step_after > 0) speed["seconds_to_first_step"] = record.first_step_after;
    return speed;
}

/// Constraint error and its tolerance; null in joint coordinates without jointed tips, which have
/// none.
Json constraints_of(SummarySource const& of) {
    auto const& groups = of.system.groups();
    bool const tips = std::any_of(groups.begin(), groups.end(),
                                  [](auto const& group) { return group->has_closures(); });
    if (of.system.absolute().empty() && !tips) return nullptr;
    return {{"largest_error", of.verdict.largest_error()},
            {"tolerance", of.scene.dynamics.constraint_tolerance}};
}

/// Ranks, threads and messages. Collective.
Json parallel_of(SummarySource const& of) {
    RunFolder& folder = of.frames.folder();
    auto const steps = static_cast<double>(steps_of(of));
    Json parallel{{"ranks", of.communicator.size()},
                  {"threads", of.system.executor().threads()},
                  {"message_passing", message_passing_library()},
                  {"gathers", of.communicator.gather_way().text()},
                  {"frames_written", folder.frames_way().text},
                  {"frames_beside_steps", of.frames.frames_beside()},
                  {"checkpoints_written", folder.checkpoints_way().text},
                  {"message_rounds_per_step",
                   steps > 0 ? static_cast<double>(of.record.rounds) / steps : 0.0}};
    if (!of.shares.shares.empty()) parallel.update(Json(json_of(of.shares, of.system.groups())));
    if (nlohmann::json const messages = of.messages.json(); !messages.is_null())
        parallel["messages_a_step"] = messages;
    return parallel;
}

Json solver_of(SummarySource const& of) {
    std::vector<SolverReport> const reports = of.system.solver_reports();
    Json groups = Json::array();
    for (std::size_t i = 0; i < of.system.groups().size(); ++i) {
        ChainGroup const& group = *of.system.groups()[i];
        SolverReport const& report = reports[i];
        groups.push_back({{"handle_kind", group.kind()},
                          {"handles", report.handles},
                          {"directions", report.directions},
                          {"chains", group.partition.chains()},
                          {"bodies", group.partition.bodies()},
                          {"run_length", report.run_length},
                          {"depth", report.depth},
                          {"direct_exchange", report.direct_exchange}});
    }
    Json solver{{"backend", name_of(of.system.backend())},
                {"tree_table", dca::tree_table_version},
                {"groups", groups}};
    solver.update(Json(of.stepper.describe()));
    return solver;
}

Json files_of(SummarySource const& of) {
    RunFolder const& folder = of.frames.folder();
    Json files;
    for (char const* name : {"trajectory.h5md", "topology.pdb", "observables.csv", "checkpoint.h5",
                             "summary.json", "timeline.json", "report.html"})
        files[name] = folder.path(name);
    for (char const* name : {"topology.cif", "topology.psf", "replicas.csv"})
        if (std::error_code ignored;
            of.communicator.rank() == 0 && std::filesystem::exists(folder.path(name), ignored))
            files[name] = folder.path(name);
    return files;
}

/// Appends the solver's part of the summary. Collective.
void add_internals(Json& summary, SummarySource const& of) {
    if (nlohmann::json const inner = of.stepper.inner_steps(); !inner.is_null())
        summary["inner_steps"] = inner;
    if (Json const constraints = constraints_of(of); !constraints.is_null())
        summary["constraints"] = constraints;
    if (nlohmann::json const forces = summary_of_forces(of.system, steps_of(of));
        of.system.openmm())
        summary["forces"] = forces;
    summary["solver"] = solver_of(of);
    summary["parallel"] = parallel_of(of);
    summary["seconds_per_phase"] = of.system.seconds();
    for (auto const& [part, seconds] : of.frames.seconds())
        summary["seconds_per_phase"][part] = seconds;
}

}  // namespace

Json summary_of_run(SummarySource const& of, bool valid, std::vector<RunCheck> const& checks) {
    Scene const& scene = of.scene;
    Json summary{{"title", scene.title},
                 {"scene", scene.file},
                 {"units", units_of(scene)},
                 {"system", system_of(scene)},
                 {"run", run_of(of)}};
    if (nlohmann::json const branch = of.origin.branch_json(); !branch.is_null())
        summary["branch"] = branch;
    summary.update(statistics_of(of));
    summary["speed"] = speed_of(of);
    summary["valid"] = valid;
    summary["verdict"] = as_json(checks);
    summary["notes"] = of.record.notes;
    if (!of.origin.is_restart()) summary["start"] = json_of(of.record.start);
    add_internals(summary, of);
    summary["command"] = of.options.command_line;
    summary["scene_hash"] = scene.hash;
    summary["files"] = files_of(of);
    return summary;
}

}  // namespace catena
