// Implements the topology of a State.
#include "foreign/start_topology.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <tuple>

#include "error.hpp"
#include "io/output.hpp"
#include "io/output_file.hpp"
#include "scene/node.hpp"
#include "systems/import.hpp"
#include "systems/pdb_topology.hpp"

namespace catena::foreign {

namespace {

namespace fs = std::filesystem;

constexpr double box_digits = 1e-4;  // nm
/// Largest change of a coordinate by the digits of a PDB file that is accepted, nm. Its columns
/// hold three decimals of an angstrom up to 1000 nm, fewer beyond, and 0 in place of what is too
/// wide.
constexpr double most_rounding = 0.51e-2;
/// Changes up to here, nm, are those of binary numbers and deserve no note.
constexpr double noted_rounding = 1e-9;

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

/// Throws InputError for a coordinate that is not a finite number.
void refuse_not_finite(std::vector<Vec3> const& positions, std::string const& state) {
    for (std::size_t k = 0; k < positions.size(); ++k)
        for (double const coordinate : positions[k].data)
            if (!std::isfinite(coordinate))
                throw InputError(fmt::format("the position of particle {} is not finite", k + 1),
                                 state, "serialise a State of a run that went well");
}

/// Reads the written positions again. Returns their largest change, nm; throws InputError if the
/// file's columns are too narrow for one.
double rounding_of(std::string const& topology, std::vector<Vec3> const& positions,
                   std::string const& state) {
    double largest = 0;
    std::size_t k = 0;
    for (PdbChain const& chain : read_pdb_topology(topology, topology))
        for (Vec3 const& x : chain.position) {
            for (int i = 0; i < 3; ++i)
                largest = std::max(largest, std::abs(x[i] - positions[k][i]));
            if (++k; largest > most_rounding)
                throw InputError(
                    fmt::format("the position of particle {} does not fit into a PDB file", k),
                    state, "move the particles to the origin before you serialise the State");
        }
    return largest;
}

}  // namespace

WrittenStart write_start(Files const& files, OpenMmSpec const& spec, std::string const& folder) {
    std::string const state = scene::shown_path(files.state);
    BondedChains const bonded = chains_by_bonds(spec, files.system);
    Topology topology = chains_of(files, bonded);
    Frame frame;
    OpenMmState const start = read_openmm_state(files.state, state);
    if (bonded.box) refuse_another_box(start.box, *bonded.box, state);
    frame.positions = start.positions;
    for (auto const& [count, what, file] :
         {std::tuple{frame.positions.size(), "State", state},
          {topology.residue.size(), "topology", scene::shown_path(files.topology)}})
        if (count != bonded.mass.size())
            throw InputError(fmt::format("the {} has {} particles and the System {}", what, count,
                                         bonded.mass.size()),
                             file, "name files of the same system");
    refuse_not_finite(frame.positions, state);
    topology.title = name_of(files);
    topology.mass = bonded.mass;
    topology.box = bonded.box;
    make_output_folder(folder);
    write_topology(folder, topology, frame);
    WrittenStart written{(fs::path(folder) / "topology.pdb").string(), {}};
    std::string const name = scene::shown_path(fs::path(files.state).filename().string());
    if (start.has_velocities)
        written.notes.push_back(fmt::format(
            "The velocities of {} are not used: chains start with thermal velocities.", name));
    double const change = rounding_of(written.topology, frame.positions, state);
    if (change > noted_rounding)
        written.notes.push_back(
            fmt::format("The positions of {} are rounded to the digits of a PDB file, by at most "
                        "{:.1e} nm.",
                        name, change));
    return written;
}

}  // namespace catena::foreign
