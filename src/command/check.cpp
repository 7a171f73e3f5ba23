// Implements `catena check`.
#include <fmt/format.h>

#include "command/commands.hpp"
#include "console/long_task.hpp"
#include "console/terminal.hpp"
#include "integrate/chain_system.hpp"
#include "measure/run_start.hpp"
#include "observe/observables.hpp"
#include "plan/describe.hpp"
#include "plan/host_memory.hpp"
#include "reader/force_notes.hpp"
#include "start/concentrations.hpp"
#include "start/start_relaxation.hpp"
#include "start/start_report.hpp"
#include "systems/charges.hpp"

namespace catena::command {
namespace {

/// OpenMM's description of the scene, and the start as it is used in computations.
struct Found {
    std::vector<std::string> openmm;
    StartReport start;
    /// True if there was no memory to look at the start.
    bool skipped = false;
};

/// Relaxes the start if the scene asks for it and evaluates OpenMM's forces once, unless both are
/// skipped. Collective.
Found find(Scene const& scene, Communicator const& communicator, bool skipped) {
    std::optional<RelaxedScene> relaxed;
    if (!skipped) relaxed = relaxed_where_asked(scene, communicator, relaxation_says(is_quiet()));
    Found found;
    found.skipped = skipped;
    found.start.change = scene.start;
    if (relaxed) found.start.relaxation = relaxed->relaxation;
    if (!scene.forces.openmm || skipped) return found;
    LongTask const task(communicator.rank() == 0 && !is_quiet(), "computing the forces once");
    if (!relaxed) refuse_coinciding(scene, communicator);
    ChainSystem system(relaxed ? relaxed->scene : scene, Axes::joint, communicator);
    found.openmm = system.openmm()->description();
    system.evaluate(false);
    found.start.forces = look_at_start(system);
    return found;
}

/// Returns the numbers of loads and OpenMM's lines as JSON.
Json forces_json(Scene const& scene, std::vector<std::string> const& openmm) {
    Vec3 const& g = scene.forces.gravity;
    Json forces{{"gravity", {g[0], g[1], g[2]}}};
    for (terms::TermCount const& each : loads_of(scene)) forces[each.name] = each.count;
    forces["openmm"] = openmm;
    return forces;
}

/// Returns the dynamics as JSON; null if the scene has none.
Json dynamics_json(Scene const& scene, std::optional<StepLimit> const& limit) {
    DynamicsSpec const& d = scene.dynamics;
    if (!d.given) return nullptr;
    return {{"integrator", name_of(d.integrator)},
            {"step", d.step},
            {"longest_stable_step", limit ? Json(limit->step) : Json()},
            {"steps", d.steps},
            {"temperature", d.temperature},
            {"friction", d.friction},
            {"seed", d.seed},
            {"constraint_tolerance", d.constraint_tolerance},
            {"tolerance", d.tolerance > 0 ? Json(d.tolerance) : Json()}};
}

/// Returns the kind of handles and their numbers of directions as JSON.
Json handles_json(Scene const& scene) {
    Directions const d = directions_of(scene);
    Json handles{{"kind", name_of(scene.solver.handles)}};
    if (d.beads > 0) handles["beads"] = d.beads;
    if (d.bodies > 0) handles["bodies"] = d.bodies;
    return handles;
}

/// Returns the concentrations as JSON.
Json concentrations_json(Scene const& scene) {
    Json list = Json::array();
    for (ChainConcentration const& each : concentrations_of(scene))
        list.push_back({{"chains", each.chains},
                        {"count", each.count},
                        {"in", each.where},
                        {"mg_per_ml", each.mg_per_ml},
                        {"mmol_per_l", each.mmol_per_l}});
    return list;
}

/// Returns the text that `catena check` prints.
Text text_of(Scene const& scene, Found const& found, Memory const& memory, int ranks,
             std::optional<StepLimit> const& limit) {
    std::vector<std::string> const& openmm = found.openmm;
    Directions const d = directions_of(scene);
    Text text;
    text.heading(title_of(scene));
    text.entry("units",
               scene.si ? "si: numbers are used without conversion" : "md: nm, ps, amu, kJ/mol");
    text.entry("chains", std::to_string(scene.chains.size()));
    if (scene.replicas > 1)
        text.entry("replicas",
                   fmt::format("{}, of {} {} each", scene.replicas, scene.chains_a_replica(),
                               scene.chains_a_replica() == 1 ? "chain" : "chains"));
    text.entry("bodies", std::to_string(scene.bodies()));
    text.entry("degrees of freedom", std::to_string(degrees_of_freedom(scene)));
    text.entry("box", scene.box ? "periodic " + terms::vector_text(*scene.box) : "none");
    std::vector<ChainConcentration> const concentrations = concentrations_of(scene);
    for (std::size_t i = 0; i < concentrations.size(); ++i)
        text.entry(i == 0 ? "concentration" : "", concentrations[i].text());
    if (std::string const charges = assumed_charges(scene); !charges.empty())
        text.entry("net charge", charges);
    text.add(chain_table(scene));
    text.heading("start");
    for (auto const& [name, value] : lines_of(scene, found.start)) text.entry(name, value);
    text.heading("solver");
    text.entry("backend", name_of(scene.solver.backend));
    if (d.beads > 0) text.entry("blocks of links", block_text(true, d.beads, scene.solver.handles));
    if (d.bodies > 0)
        text.entry("blocks of bodies", block_text(false, d.bodies, scene.solver.handles));
    text.heading("forces");
    text.entry("gravity", terms::vector_text(scene.forces.gravity));
    text.entry("joints and bodies", loads_text(scene));
    for (std::size_t i = 0; i < openmm.size(); ++i) text.entry(i == 0 ? "OpenMM" : "", openmm[i]);
    text.heading("dynamics");
    text.entry("integrator", dynamics_text(scene));
    if (std::string const advice = scene::longer_steps(scene); !advice.empty())
        text.entry("longer steps", advice);
    if (limit) text.entry("longest stable step", catena::text_of(*limit, scene));
    text.heading("memory");
    text.entry(
        ranks == 1 ? "estimate" : "estimate per rank",
        fmt::format("{}: scene {}, state {}, solver {}{}", bytes_text(memory.sum()),
                    bytes_text(memory.scene), bytes_text(memory.state), bytes_text(memory.solver),
                    scene.forces.openmm ? "; without OpenMM" : ""));
    for (std::string const& note : notes_on(scene, limit)) text.note(note);
    text.heading(found.skipped ? "The scene is valid as far as it was checked."
                               : "The scene is valid.");
    return text;
}

}  // namespace

Outcome check_scene(Scene scene, Communicator const& communicator, bool json) {
    refuse_before_run(scene, communicator);
    auto const lacking = lacking_memory(scene, communicator);
    if (lacking) scene.note(lacking->note());
    bool const skipped = lacking && scene.forces.openmm;
    if (skipped)
        scene.note(
            "for lack of memory the start was neither relaxed nor looked at, and the forces were "
            "not evaluated.");
    Found const found = find(scene, communicator, skipped);
    Memory const memory = memory_of(scene, communicator.size());
    std::optional<StepLimit> const limit = estimate_step_limit(scene);
    Outcome outcome;
    outcome.text = text_of(scene, found, memory, communicator.size(), limit).str();
    if (!json) return outcome;
    std::string const charges = assumed_charges(scene);
    outcome.json = {
        {"scene", scene.file},
        {"title", scene.title},
        {"units", scene.si ? "si" : "md"},
        {"chains", chains_json(scene)},
        {"replicas", scene.replicas},
        {"bodies", scene.bodies()},
        {"dof", degrees_of_freedom(scene)},
        {"box", scene.box ? Json{(*scene.box)[0], (*scene.box)[1], (*scene.box)[2]} : Json()},
        {"concentrations", concentrations_json(scene)},
        {"net_charge", charges.empty() ? Json() : Json(charges)},
        {"backend", name_of(scene.solver.backend)},
        {"handles", handles_json(scene)},
        {"start", json_of(found.start)},
        {"forces", forces_json(scene, found.openmm)},
        {"dynamics", dynamics_json(scene, limit)},
        {"memory_bytes_per_rank",
         {{"scene", memory.scene}, {"state", memory.state}, {"solver", memory.solver}}},
        {"scene_hash", scene.hash},
        {"ranks", communicator.size()},
        {"notes", notes_on(scene, limit)},
        {"valid", true}};
    return outcome;
}

}  // namespace catena::command
