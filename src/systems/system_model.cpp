// Implements the use of a serialised System on the beads of a scene. Rigid links replace its
// constraints and bonds along chains. Forces that move particles and groups that the scene does not
// use are removed. The remaining forces are renamed, and each gets its own force group.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "error.hpp"
#include "scene/force_changes.hpp"
#include "scene/node.hpp"
#include "systems/charges.hpp"
#include "systems/linked_bonds.hpp"
#include "systems/links.hpp"
#include "systems/model.hpp"
#include "systems/pdb_topology.hpp"

namespace catena {

namespace {

using OpenMM::System;

double constexpr same_length = 1e-6;  // nm; covers lengths written in decimals
double constexpr same_mass = 1e-6;    // relative; covers masses written in decimals

/// Throws InputError unless the System has one particle per bead.
void check_counts(System const& system, OpenMmSpec const& spec, BeadSystem const& beads) {
    if (system.getNumParticles() != beads.size())
        throw InputError(fmt::format("the System has {} particles and the scene {} beads",
                                     system.getNumParticles(), beads.size()),
                         openmm_key(beads.scene_file, "system"),
                         fmt::format("make every particle of {} a bead of the scene", spec.system));
}

/// Sizes of the scene's chains.
std::vector<std::int64_t> sizes_of(BeadSystem const& beads) {
    std::vector<std::int64_t> sizes;
    for (std::size_t c = 0; c < beads.chain_name.size(); ++c)
        sizes.push_back(beads.chain_offset[c + 1] - beads.chain_offset[c]);
    return sizes;
}

/// Sizes of the topology's chains.
std::vector<std::int64_t> sizes_of(std::vector<PdbChain> const& chains) {
    std::vector<std::int64_t> sizes;
    for (PdbChain const& chain : chains) sizes.push_back(std::ssize(chain.residue));
    return sizes;
}

/// Checks the topology against the scene. Without a map its chains must be the scene's, in the same
/// order and of the same sizes. The scene's may be cut as those of an import are.
void check_topology(System const& system, OpenMmSpec const& spec, BeadSystem const& beads) {
    if (spec.topology.empty()) return;
    std::string const where = openmm_key(beads.scene_file, "topology");
    auto const chains = read_pdb_topology(spec.topology, where);
    std::int64_t atoms = 0;
    for (auto const& chain : chains) atoms += std::ssize(chain.residue);
    if (atoms != beads.size())
        throw InputError(
            fmt::format("the topology has {} atoms and the System {} particles", atoms,
                        beads.size()),
            where,
            fmt::format("give {} one atom per particle, in the System's order", spec.topology));
    if (!chain_map(spec).empty()) return;
    std::vector<std::int64_t> const in_scene = sizes_of(beads), in_topology = sizes_of(chains);
    if (in_scene == in_topology ||
        in_scene == sizes_of(cut_at_bonds(chains, Joinings(system, changes_of(spec).links, where))))
        return;
    std::size_t c = 0;
    while (c < std::min(in_scene.size(), in_topology.size()) && in_scene[c] == in_topology[c]) ++c;
    throw InputError(fmt::format("chain {} has {} beads in the scene and {} atoms in the topology",
                                 c + 1, c < in_scene.size() ? in_scene[c] : 0,
                                 c < in_topology.size() ? in_topology[c] : 0),
                     where,
                     "give the chains in the topology's order, or assign the particles with "
                     "forces.openmm.map");
}

/// Returns the bead of each particle. `map` names the first and last particle of each chain, from 0
/// as in OpenMM. Without it particles and beads have the same order.
std::vector<std::int64_t> beads_of_particles(OpenMmSpec const& spec, BeadSystem const& beads) {
    ChainMap const map = chain_map(spec);
    std::vector<std::int64_t> bead(static_cast<std::size_t>(beads.size()), map.empty() ? 0 : -1);
    if (map.empty()) {
        for (std::size_t p = 0; p < bead.size(); ++p) bead[p] = static_cast<std::int64_t>(p);
        return bead;
    }
    std::string const where = openmm_key(beads.scene_file, "map");
    std::vector<bool> used(map.size(), false);
    /// Unused entries by the chain's name, the first one at the back.
    std::unordered_map<std::string_view, std::vector<std::size_t>> unused;
    for (std::size_t i = map.size(); i-- > 0;) unused[map[i].first].push_back(i);
    for (std::size_t c = 0; c < beads.chain_name.size(); ++c) {
        std::string const& name = beads.chain_name[c];
        auto const entries = unused.find(name);
        if (entries == unused.end() || entries->second.empty())
            throw InputError(fmt::format("chain {} is not in the map", name), where,
                             "give every chain of beads its first and last particle");
        std::size_t const entry = entries->second.back();
        entries->second.pop_back();
        used[entry] = true;
        auto const [first, last] = map[entry].second;
        std::int64_t const count = beads.chain_offset[c + 1] - beads.chain_offset[c];
        if (first < 0 || last >= beads.size() || last - first + 1 != count)
            throw InputError(
                fmt::format("chain {} has {} beads, and its particles are {} to {} of 0 to {}",
                            name, count, first, last, beads.size() - 1),
                where, "name its first and last particle, counted from 0");
        for (std::int64_t k = 0; k < count; ++k) {
            auto& owner = bead[static_cast<std::size_t>(first + k)];
            if (owner >= 0)
                throw InputError(
                    fmt::format("particle {} (from 0) belongs to two chains", first + k), where,
                    "make the ranges disjoint");
            owner = beads.chain_offset[c] + k;
        }
    }
    auto const spare = std::find(used.begin(), used.end(), false);
    if (spare != used.end())
        throw InputError(fmt::format("the scene has no chain of beads named {}",
                                     map[static_cast<std::size_t>(spare - used.begin())].first),
                         where, fmt::format("use one of {}", fmt::join(beads.chain_name, ", ")));
    return bead;
}

/// Throws InputError if a mass in the System differs from that in the scene.
void check_masses(System const& system, BeadSystem const& beads,
                  std::vector<std::int64_t> const& bead_of_particle) {
    for (int p = 0; p < system.getNumParticles(); ++p) {
        double const in_system = system.getParticleMass(p),
                     in_scene = beads.mass[static_cast<std::size_t>(bead_of_particle[p])];
        if (std::abs(in_system - in_scene) > same_mass * in_system)
            throw InputError(
                fmt::format("particle {} (from 0) has mass {} in the System and {} in the scene", p,
                            in_system, in_scene),
                openmm_key(beads.scene_file, "system"),
                "masses come from the System: give the same in the scene");
    }
}

/// Excludes nonbonded interactions between beads of one rigid body. They have no effect on the
/// motion but add rounding.
std::vector<std::string> exclude_within_bodies(System& system, BeadSystem const& beads,
                                               std::vector<int> const& particle_of_bead) {
    if (beads.rigid.empty()) return {};
    std::set<std::pair<int, int>> pairs;
    for (auto const& [first, last] : beads.rigid)
        for (std::int64_t a = first; a < last; ++a)
            for (std::int64_t b = a + 1; b < last; ++b)
                pairs.insert(std::minmax({particle_of_bead[a], particle_of_bead[b]}));
    for (int i = 0; i < system.getNumForces(); ++i) {
        std::set<std::pair<int, int>> missing = pairs;
        if (auto* custom = dynamic_cast<OpenMM::CustomNonbondedForce*>(&system.getForce(i))) {
            for (int e = 0; e < custom->getNumExclusions(); ++e) {
                int a, b;
                custom->getExclusionParticles(e, a, b);
                missing.erase(std::minmax({a, b}));
            }
            for (auto const& [a, b] : missing) custom->addExclusion(a, b);
        } else if (auto* charges = dynamic_cast<OpenMM::NonbondedForce*>(&system.getForce(i))) {
            for (auto const& [a, b] : pairs) charges->addException(a, b, 0, 1, 0, true);
        }
    }
    return {fmt::format("no nonbonded forces within {} rigid {}", beads.rigid.size(),
                        beads.rigid.size() == 1 ? "body" : "bodies")};
}

/// Removes the forces outside of the groups that the scene names.
std::vector<std::string> remove_other_groups(System& system, std::vector<int> const& groups) {
    std::vector<std::string> notes;
    if (groups.empty()) return notes;
    for (int i = system.getNumForces() - 1; i >= 0; --i) {
        auto const& force = system.getForce(i);
        if (std::find(groups.begin(), groups.end(), force.getForceGroup()) != groups.end())
            continue;
        notes.insert(notes.begin(),
                     fmt::format("{} (group {}) left out by force_groups",
                                 scene::shown(force.getName()), force.getForceGroup()));
        system.removeForce(i);
    }
    return notes;
}

/// Puts every force into its own group and returns the names.
std::vector<std::string> name_terms(System& system) {
    std::vector<std::string> names;
    for (int i = 0; i < system.getNumForces(); ++i) {
        auto& force = system.getForce(i);
        names.push_back(force.getName());
        force.setForceGroup(i);
        if (auto* charges = dynamic_cast<OpenMM::NonbondedForce*>(&force))
            charges->setReciprocalSpaceForceGroup(-1);  // same group as the direct space
    }
    return names;
}

/// Notes the chains' net charges by the first force with charges; no note if no particle is
/// charged.
std::vector<std::string> note_charges(OpenMmModel const& model, BeadSystem const& beads) {
    for (int i = 0; i < model.system->getNumForces(); ++i) {
        std::vector<double> const charges = charges_of(model.system->getForce(i));
        if (std::ssize(charges) != beads.size()) continue;
        if (std::all_of(charges.begin(), charges.end(), [](double q) { return q == 0; })) continue;
        std::vector<double> of_bead(charges.size());
        for (std::size_t p = 0; p < charges.size(); ++p)
            of_bead[static_cast<std::size_t>(model.bead_of_particle[p])] = charges[p];
        return {fmt::format("{} ({})", charge_text(of_bead, beads),
                            model.terms[static_cast<std::size_t>(i)])};
    }
    return {};
}

/// Checks the boxes: a periodic System must have the scene's box. Notes a box that no force uses.
void settle_box(System& system, BeadSystem const& beads, std::vector<std::string>& notes) {
    bool const periodic = system.usesPeriodicBoundaryConditions();
    if (!periodic) {
        if (beads.box) notes.push_back("no force of the System uses the scene's box");
        return;
    }
    OpenMM::Vec3 edge[3];
    system.getDefaultPeriodicBoxVectors(edge[0], edge[1], edge[2]);
    bool same = beads.box.has_value();
    for (int i = 0; i < 3 && same; ++i)
        for (int j = 0; j < 3; ++j)
            same = same && std::abs(edge[i][j] - (i == j ? (*beads.box)[i] : 0)) <= same_length;
    if (!same)
        throw InputError("the System's forces are periodic and its box is not the scene's",
                         beads.scene_file + ": box.periodic",
                         fmt::format("give the System's, [{}, {}, {}]; it must be rectangular",
                                     edge[0][0], edge[1][1], edge[2][2]));
}

}  // namespace

OpenMmModel system_model(OpenMmSpec const& spec, BeadSystem const& beads) {
    std::string const where = openmm_key(beads.scene_file, "system");
    OpenMmModel model;
    std::vector<std::string> left_out;
    model.system = read_scene_system(spec, beads.scene_file, left_out);
    check_counts(*model.system, spec, beads);
    check_topology(*model.system, spec, beads);
    model.bead_of_particle = beads_of_particles(spec, beads);
    check_masses(*model.system, beads, model.bead_of_particle);

    std::vector<int> const particle_of_bead = particles_of_beads(model.bead_of_particle);
    LinkTable const links(beads, particle_of_bead);
    auto const add = [&](std::vector<std::string> const& notes) {
        model.notes.insert(model.notes.end(), notes.begin(), notes.end());
    };
    add({fmt::format("System {}", scene::shown_path(spec.system))});
    add(left_out);
    add(remove_constraints(*model.system, links, where));
    add(remove_other_groups(*model.system, spec.force_groups));
    add(remove_linked_bonds(*model.system, links, changes_of(spec).links, where));
    add(exclude_within_bodies(*model.system, beads, particle_of_bead));
    settle_box(*model.system, beads, model.notes);
    model.terms = name_terms(*model.system);
    add(note_charges(model, beads));
    return model;
}

}  // namespace catena
