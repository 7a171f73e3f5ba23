// Implements the topology of a State.
#include "foreign/start_topology.hpp"

#include <fmt/format.h>

#include <cmath>
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

constexpr double box_digits = 1e-4;  // nm

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

/// Throws InputError if the State's box, as a barostat leaves it, is not the System's.
void refuse_another_box(Vec3 const& own, Vec3 const& systems, std::string const& state) {
    for (std::size_t k = 0; k < 3; ++k)
        if (std::abs(own[k] - systems[k]) > box_digits)
            throw InputError(
                fmt::format("the State's box is {:.6g} x {:.6g} x {:.6g} nm, the System's {:.6g} x "
                            "{:.6g} x {:.6g} nm",
                            own[0], own[1], own[2], systems[0], systems[1], systems[2]),
                state,
                "serialise the System again after system.setDefaultPeriodicBoxVectors("
                "*state.getPeriodicBoxVectors())");
}

}  // namespace

std::string write_start(Files const& files, OpenMmSpec const& spec, std::string const& folder) {
    std::string const state = scene::shown_path(files.state);
    BondedChains const bonded = chains_by_bonds(spec, files.system);
    Topology topology = chains_of(files, bonded);
    Frame frame;
    OpenMmState const start = read_openmm_state(files.state, state);
    if (bonded.box) refuse_another_box(start.box, *bonded.box, state);
    frame.positions = start.positions;
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
