// Implements the treatment of forces that a scene leaves out or that move particles, and of
// particles without dynamics.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <set>

#include "error.hpp"
#include "scene/force_changes.hpp"
#include "scene/node.hpp"
#include "systems/model.hpp"

namespace catena {

namespace {

/// Ways to do without the force.
std::string way_out(OpenMM::Force const& force) {
    return fmt::format(
        "remove it, or leave it out by `leave_out: [{0}]` (catena import --leave-out {0})",
        kind_of(force));
}

std::string constant_volume(OpenMM::Force const& force) {
    return way_out(force) + ": Catena runs at constant volume, in the System's box";
}

/// Describes what the force would do in OpenMM; empty if it does not move particles. `remedy`
/// receives the advice; it stays empty for a force that may be removed.
std::string work_of(OpenMM::Force const& force, std::string& remedy) {
    if (auto const* isotropic = dynamic_cast<OpenMM::MonteCarloBarostat const*>(&force)) {
        remedy = constant_volume(force);
        return fmt::format("which changes the box's volume to hold {:.6g} bar at {:.6g} K",
                           isotropic->getDefaultPressure(), isotropic->getDefaultTemperature());
    }
    if (kind_of(force).find("Barostat") != std::string::npos) {
        remedy = constant_volume(force);
        return "which changes the box's edges to hold a pressure";
    }
    if (auto const* andersen = dynamic_cast<OpenMM::AndersenThermostat const*>(&force)) {
        remedy = way_out(force) +
                 ": Catena's own integrators hold the temperature (dynamics.integrator: g-baoab)";
        return fmt::format("which holds {:.6g} K by collisions", andersen->getDefaultTemperature());
    }
    if (dynamic_cast<OpenMM::CMMotionRemover const*>(&force))
        return "which has no energy and stops the centre of mass";
    return "";
}

/// Throws InputError for virtual sites and for masses that are not positive and finite.
void refuse_particles(OpenMM::System const& system, std::string const& where) {
    for (int p = 0; p < system.getNumParticles(); ++p) {
        if (system.isVirtualSite(p))
            throw InputError(fmt::format("particle {} (from 0) is a virtual site", p), where,
                             "leave virtual sites out: every particle is a bead with a mass");
        double const mass = system.getParticleMass(p);
        if (mass == 0)
            throw InputError(fmt::format("particle {} (from 0) has no mass", p), where,
                             "give it one: every particle is a bead that moves");
        if (!(mass > 0 && std::isfinite(mass)))
            throw InputError(fmt::format("particle {} (from 0) has mass {}", p, mass), where,
                             "give it one above 0, in amu");
    }
}

/// Name of a force for messages: "yukawa (CustomNonbondedForce)", or its kind alone.
std::string label_of(OpenMM::Force const& force) {
    std::string const name = shown_name(force), kind = kind_of(force);
    return name == kind ? kind : fmt::format("{} ({})", name, kind);
}

/// Names of the System's forces for messages.
std::string names_of(OpenMM::System const& system, bool custom_bonds_only) {
    std::vector<std::string> names;
    for (int i = 0; i < system.getNumForces(); ++i) {
        OpenMM::Force const& force = system.getForce(i);
        if (custom_bonds_only && dynamic_cast<OpenMM::CustomBondForce const*>(&force) == nullptr)
            continue;
        std::string const name = custom_bonds_only ? shown_name(force) : label_of(force);
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
    return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

/// Indices of the forces that an entry of `leave_out` names. `terms` are the names that `check`
/// shows.
std::vector<int> forces_named(OpenMM::System const& system, std::vector<std::string> const& terms,
                              std::string const& name) {
    std::vector<int> found;
    for (int i = 0; i < system.getNumForces(); ++i)
        if (is_named(system.getForce(i), name) || terms[static_cast<std::size_t>(i)] == name)
            found.push_back(i);
    return found;
}

/// Sentence on the forces that one entry of `leave_out` removes.
std::string note_on(OpenMM::System const& system, std::vector<int> const& forces,
                    std::string const& name) {
    if (forces.size() == 1)
        return fmt::format("The System's {} is left out by `leave_out`.",
                           label_of(system.getForce(forces[0])));
    std::vector<std::string> labels;
    for (int const i : forces) labels.push_back(label_of(system.getForce(i)));
    return fmt::format("{} forces of the System are left out by `leave_out: [{}]`: {}.",
                       forces.size(), scene::shown(name), fmt::join(labels, ", "));
}

/// Removes the forces with one of these names and returns a sentence on each name.
std::vector<std::string> leave_named_out(OpenMM::System& system,
                                         std::vector<std::string> const& names,
                                         std::string const& scene_file) {
    std::vector<int> all(static_cast<std::size_t>(names.empty() ? 0 : system.getNumForces()));
    std::iota(all.begin(), all.end(), 0);
    std::vector<std::string> const terms = term_names(system, all);
    std::vector<std::string> notes;
    std::set<int, std::greater<>> removed;  // removals shift later indices
    for (std::string const& name : names) {
        std::vector<int> const found = forces_named(system, terms, name);
        if (found.empty())
            throw InputError(
                fmt::format("the System has no force `{}`", scene::shown(name)),
                openmm_key(scene_file, "leave_out"),
                fmt::format("name a force or a kind of force: {}", names_of(system, false)));
        notes.push_back(note_on(system, found, name));
        removed.insert(found.begin(), found.end());
    }
    for (int const i : removed) system.removeForce(i);
    return notes;
}

/// Throws InputError for a name in `links` that is no CustomBondForce's.
void refuse_unknown_links(OpenMM::System const& system, NamedLinks const& links,
                          std::string const& scene_file) {
    for (auto const& [name, length] : links) {
        bool known = false;
        for (int i = 0; i < system.getNumForces(); ++i)
            known = known || (is_named(system.getForce(i), name) &&
                              named_length(links, system.getForce(i)) > 0);
        if (!known)
            throw InputError(
                fmt::format("the System has no CustomBondForce `{}`", scene::shown(name)),
                openmm_key(scene_file, "links"),
                fmt::format("name one of its CustomBondForces ({}); constraints and stiff harmonic "
                            "bonds become links by themselves",
                            names_of(system, true)));
    }
}

}  // namespace

bool is_named(OpenMM::Force const& force, std::string const& name) {
    return force.getName() == name || kind_of(force) == name || shown_name(force) == name;
}

double named_length(NamedLinks const& links, OpenMM::Force const& force) {
    if (dynamic_cast<OpenMM::CustomBondForce const*>(&force) == nullptr) return 0;
    for (auto const& [name, length] : links)
        if (is_named(force, name)) return length;
    return 0;
}

std::unique_ptr<OpenMM::System> read_scene_system(OpenMmSpec const& spec,
                                                  std::string const& scene_file,
                                                  std::vector<std::string>& notes) {
    std::string const where = openmm_key(scene_file, "system");
    ForceChanges const changes = changes_of(spec);
    auto system = read_openmm_system(spec.system, where);
    for (auto const& more : {leave_named_out(*system, changes.leave_out, scene_file),
                             leave_movers_out(*system, spec.force_groups, where)})
        notes.insert(notes.end(), more.begin(), more.end());
    refuse_unknown_links(*system, changes.links, scene_file);
    return system;
}

std::vector<std::string> leave_movers_out(OpenMM::System& system, std::vector<int> const& groups,
                                          std::string const& where) {
    refuse_particles(system, where);
    std::vector<std::string> notes;
    // The loop runs backwards, because removals shift later indices.
    for (int i = system.getNumForces() - 1; i >= 0; --i) {
        OpenMM::Force const& force = system.getForce(i);
        std::string remedy;
        std::string const kind = kind_of(force), work = work_of(force, remedy);
        if (work.empty()) continue;
        bool const excluded = !groups.empty() && std::find(groups.begin(), groups.end(),
                                                           force.getForceGroup()) == groups.end();
        if (!remedy.empty() && !excluded)
            throw InputError(fmt::format("the System holds {} {}, {}",
                                         kind.starts_with('A') ? "an" : "a", kind, work),
                             where, remedy);
        notes.insert(notes.begin(), fmt::format("The System's {}, {}, is left out.", kind, work));
        system.removeForce(i);
    }
    return notes;
}

}  // namespace catena
