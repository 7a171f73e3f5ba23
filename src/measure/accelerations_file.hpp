// `catena solve --accelerations FILE`: accelerations and forces of any number of bodies as CSV,
// HDF5 or JSON, chosen by the file's ending. inputs/keys/output.md describes the contents.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "measure/solution.hpp"

namespace catena {

/// Throws InputError for an ending other than .csv, .h5, .hdf5 and .json, for a file that exists
/// and is not regular, and for HDF5 in a build without it.
void require_accelerations_writer(std::string const& file);
/// Writes the solution. Throws as require_accelerations_writer() does, and ComputationError that
/// names file and cause.
void write_accelerations(std::string const& file, Scene const&, Solution const&);

/// Adds "joint_accelerations", "bead_accelerations", "bead_forces", "joint_forces", "tip_forces"
/// and, if there are cross-links, "crosslink_tensions". Joint accelerations have one entry per
/// body: a number, a list, or {"alpha", "acceleration"}.
void add_solution(nlohmann::ordered_json&, Scene const&, Solution const&);

/// Returns what holds body k of the chain: the type of its inboard joint, "bead" or "body on
/// links".
char const* joint_name(ChainSpec const&, std::size_t k);

/// Throws InputError "built without HDF5" in a build without it.
void require_accelerations_hdf5(std::string const& file);
/// Writes /accelerations and /joint_forces (both flat), /offsets ([bodies + 1][2], first entry of
/// each body in either array), /tip_forces ([tips][6]), /tip_chains ([tips], from 0) and, if there
/// are cross-links, /crosslink_tensions, in the order of the scene.
void write_accelerations_hdf5(std::string const& file, Solution const&);

}  // namespace catena
