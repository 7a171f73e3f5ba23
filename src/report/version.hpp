#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace catena::command {

std::string version();
/// Several lines: catena, compiler, and what is in the build.
std::string version_text();
/// {"catena", "compiler", "instruction_set", "simd", "mpi", "openmp", "openmm", "hdf5", "cuda"}
nlohmann::ordered_json version_json();
/// {"processor", "hardware_threads", "gpu"}: what a time was measured on; "gpu" is null where none
/// can be used.
nlohmann::ordered_json hardware_json();
/// "2 threads on AMD EPYC 7B13, NVIDIA H200"
std::string hardware_text();

}  // namespace catena::command
