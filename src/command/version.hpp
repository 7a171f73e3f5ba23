#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace catena::command {

std::string version();
/// Several lines: catena, compiler, and what is in the build.
std::string version_text();
/// {"catena", "compiler", "instruction_set", "mpi", "openmp", "openmm", "hdf5", "cuda"}
nlohmann::ordered_json version_json();

}  // namespace catena::command
