// Implements the topology of a State.
#include "foreign/start_topology.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "error.hpp"
#include "io/output.hpp"
#include "io/output_file.hpp"
#include "scene/node.hpp"
#include "systems/import.hpp"
#include "systems/pdb_topology.hpp"

namespace catena::foreign {

namespace {

/// Chains and residues of the named topology, or chains of the System's bonds.
Topology chains_of(Files const& files, BondedChains const& bonded) {
    Topology topology;
    std::int64_t first = 0;
    auto const add = [&](std::string const& name, std::int64_t count) {
        topology.chains.push_back({name, first, count, true, false});
        first += count;
    };
    if (files.topology.empty()) {
        for (std::int64_t const count : bonded.sizes)
            add(std::to_string(topology.chains.size() + 1), count);
        topology.residue.assign(static_cast<std::size_t>(first), "UNK");
        return topology;
    }
    for (PdbChain const& chain : read_pdb_topology(files.topology, files.topology)) {
        add(chain.name, static_cast<std::int64_t>(chain.size()));
        topology.residue.insert(topology.residue.end(), chain.residue.begin(), chain.residue.end());
    }
    return topology;
}

}  // namespace

std::string write_start(Files const& files, OpenMmSpec const& spec, std::string const& folder) {
    std::string const state = scene::shown_path(files.state);
    BondedChains const bonded = chains_by_bonds(spec, files.system);
    Topology topology = chains_of(files, bonded);
    Frame frame;
    frame.positions = read_openmm_state(files.state, state);
    for (auto const& [count, what] :
         {std::pair{frame.positions.size(), "State"}, {topology.residue.size(), "topology"}})
        if (count != bonded.mass.size())
            throw InputError(fmt::format("the {} has {} particles and the System {}", what, count,
                                         bonded.mass.size()),
                             state, "name files of the same system");
    topology.title = name_of(files);
    topology.mass = bonded.mass;
    topology.box = bonded.box;
    make_output_folder(folder);
    write_topology(folder, topology, frame);
    return (std::filesystem::path(folder) / "topology.pdb").string();
}

}  // namespace catena::foreign
