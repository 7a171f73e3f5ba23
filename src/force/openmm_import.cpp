#include "force/openmm_import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "error.hpp"
#include "force/openmm_model.hpp"
#include "force/pdb_topology.hpp"

namespace catena {

namespace {

/// Lengths of the bonds and constraints between particle p - 1 and p, by p.
std::map<int, double> lengths_to_neighbours(OpenMM::System const& system) {
    std::map<int, double> lengths;
    int a, b;
    double length, k;
    auto const note = [&] {
        if (std::abs(a - b) == 1) lengths[std::max(a, b)] = length;
    };
    for (int i = 0; i < system.getNumForces(); ++i) {
        auto const* bonds = dynamic_cast<OpenMM::HarmonicBondForce const*>(&system.getForce(i));
        for (int j = 0; bonds != nullptr && j < bonds->getNumBonds(); ++j) {
            bonds->getBondParameters(j, a, b, length, k);
            note();
        }
    }
    for (int i = 0; i < system.getNumConstraints(); ++i) {  // these hold exactly, so they have the last word
        system.getConstraintParameters(i, a, b, length);
        note();
    }
    return lengths;
}

ImportedChain import_chain(PdbChain const& from, int first, OpenMM::System const& system, std::map<int, double> const& lengths,
                           std::string const& where) {
    ImportedChain chain{from.name, from.residue, {}, from.position, {}};
    for (int k = 0; k < static_cast<int>(from.size()); ++k) {
        chain.mass.push_back(system.getParticleMass(first + k));
        auto const link = lengths.find(first + k);
        if (k > 0 && link == lengths.end())
            throw InputError(
                fmt::format("particles {} and {} (from 0) are joined by no harmonic bond and no constraint", first + k - 1, first + k),
                fmt::format("{}, chain {}, body {}", where, from.name, k + 1),
                "join neighbours in a chain, or end the chain between them in the topology (TER)");
        chain.length.push_back(k > 0 ? link->second : 0);
    }
    return chain;
}

}  // namespace

ImportedSystem import_openmm_system(std::string const& system_file, std::string const& topology, std::string const& scene_file) {
    std::string const where = openmm_key(scene_file, "system");
    auto const system = read_openmm_system(system_file, where);
    refuse_movers(*system, where);
    auto const chains = read_pdb_topology(topology, openmm_key(scene_file, "topology"));
    std::size_t atoms = 0;
    for (auto const& chain : chains) atoms += chain.size();
    if (static_cast<int>(atoms) != system->getNumParticles())
        throw InputError(fmt::format("the topology has {} atoms and the System {} particles", atoms, system->getNumParticles()),
                         openmm_key(scene_file, "topology"), "give one atom a particle, in the System's order");

    ImportedSystem imported;
    auto const lengths = lengths_to_neighbours(*system);
    int first = 0;
    for (auto const& chain : chains) {
        imported.chains.push_back(import_chain(chain, first, *system, lengths, where));
        first += static_cast<int>(chain.size());
    }
    imported.periodic = system->usesPeriodicBoundaryConditions();
    OpenMM::Vec3 a, b, c;
    system->getDefaultPeriodicBoxVectors(a, b, c);
    imported.box = {{a[0], b[1], c[2]}};
    return imported;
}

}  // namespace catena
