// Version of the program, contents of its build, and the hardware it runs on.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace catena::command {

/// Returns the version number.
std::string version();
/// Returns several lines: the version, the compiler, and the libraries of the build.
std::string version_text();
/// Returns {"catena", "compiler", "flags", "instruction_set", "simd", "mpi", "openmp", "openmm",
/// "hdf5", "cuda"}.
nlohmann::ordered_json version_json();
/// Returns {"processor", "hardware_threads", "gpu"}, the hardware that times are measured on. "gpu"
/// is null if no GPU can be used.
nlohmann::ordered_json hardware_json();
/// Returns for example "2 threads on AMD EPYC 7B13, NVIDIA H200".
std::string hardware_text();

}  // namespace catena::command
