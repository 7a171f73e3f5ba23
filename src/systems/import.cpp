// Implements the import of chains and links from a System.
#include "systems/import.hpp"

#include <fmt/format.h>

#include <cmath>

#include "error.hpp"
#include "scene/node.hpp"
#include "systems/links.hpp"
#include "systems/model.hpp"
#include "systems/pdb_topology.hpp"

namespace catena {

namespace {

/// Imports one chain that begins with particle `first`, and adds its links to `links`.
ImportedChain import_chain(PdbChain const& from, int first, OpenMM::System const& system,
                           Joinings const& joinings, StiffLinks& links, std::string const& where) {
    ImportedChain chain{from.name, from.residue, {}, from.position, {}};
    for (int k = 0; k < static_cast<int>(from.size()); ++k) {
        int const p = first + k;
        chain.mass.push_back(system.getParticleMass(p));
        Joining const joining = k > 0 ? joinings.to_previous(p) : Joining{};
        if (k > 0 && !joining.holds())
            joinings.refuse_gap(
                p, first,
                fmt::format("{}, chain {}, body {}", where, scene::shown(from.name), k + 1));
        if (k > 0) links.add(p - 1, p, joining);
        chain.length.push_back(k > 0 ? joining.length : 0);
    }
    return chain;
}

/// True if the ends of a chain are joined at least half as stiffly as its first link. If that link
/// is a constraint, the bond between the ends must be stiff enough for a link.
bool closes(Joining const& ends, Joining const& link, double temperature) {
    if (std::isinf(link.stiffness))
        return ends.holds() && ends.spread(temperature) <= StiffLinks::softest;
    return ends.holds() && ends.stiffness >= 0.5 * link.stiffness;
}

/// Notes the chains whose ends are joined, in one sentence.
std::vector<std::string> note_rings(std::vector<PdbChain> const& chains, Joinings const& joinings,
                                    double temperature) {
    int first = 0, rings = 0;
    std::string name;
    for (PdbChain const& chain : chains) {
        int const size = static_cast<int>(chain.size()), last = first + size - 1;
        if (size > 2 &&
            closes(joinings.between(first, last), joinings.to_previous(first + 1), temperature) &&
            rings++ == 0)
            name = scene::shown(chain.name);
        first += size;
    }
    if (rings == 0) return {};
    return {
        fmt::format("{} into a ring by a harmonic bond, which stays a spring (write `chains` with "
                    "`tip: {{ring: {{type: link}}}}` for a "
                    "link).",
                    rings == 1 ? fmt::format("Chain {} is closed", name)
                               : fmt::format("{} chains are closed", rings))};
}

}  // namespace

SystemLinks read_system_links(OpenMmSpec const& spec, std::string const& scene_file) {
    std::string const where = openmm_key(scene_file, "system");
    auto const system = read_openmm_system(spec.system, where);
    SystemLinks links;
    links.notes = leave_movers_out(*system, spec.force_groups, where);
    links.periodic = system->usesPeriodicBoundaryConditions();
    Joinings const joinings(*system, where);
    links.to_previous.resize(static_cast<std::size_t>(system->getNumParticles()));
    for (int p = 1; p < system->getNumParticles(); ++p)
        links.to_previous[static_cast<std::size_t>(p)] = joinings.to_previous(p);
    return links;
}

ImportedSystem import_openmm_system(OpenMmSpec const& spec, std::string const& scene_file) {
    std::string const where = openmm_key(scene_file, "system");
    auto const system = read_openmm_system(spec.system, where);
    ImportedSystem imported;
    imported.notes = leave_movers_out(*system, spec.force_groups, where);
    auto const chains =
        read_pdb_topology(spec.topology, openmm_key(scene_file, "topology"), &imported.notes);
    std::size_t atoms = 0;
    for (auto const& chain : chains) atoms += chain.size();
    if (static_cast<int>(atoms) != system->getNumParticles())
        throw InputError(fmt::format("the topology has {} atoms and the System {} particles", atoms,
                                     system->getNumParticles()),
                         openmm_key(scene_file, "topology"),
                         "give one atom per particle, in the System's order");

    Joinings const joinings(*system, where);
    StiffLinks links(spec.temperature, where);
    int first = 0;
    for (auto const& chain : chains) {
        imported.chains.push_back(import_chain(chain, first, *system, joinings, links, where));
        first += static_cast<int>(chain.size());
    }
    for (auto const& notes : {links.notes(), note_rings(chains, joinings, spec.temperature)})
        imported.notes.insert(imported.notes.end(), notes.begin(), notes.end());
    imported.largest_spread = links.largest_spread();
    imported.periodic = system->usesPeriodicBoundaryConditions();
    OpenMM::Vec3 a, b, c;
    system->getDefaultPeriodicBoxVectors(a, b, c);
    imported.box = {{a[0], b[1], c[2]}};
    return imported;
}

}  // namespace catena
