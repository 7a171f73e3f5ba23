// Implements the description of the build and the hardware.
#include "report/version.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "cuda/device/gpu.hpp"
#include "force/openmm_force.hpp"
#include "io/output.hpp"
#include "math/simd_level.hpp"
#include "measure/hardware.hpp"
#include "mpi/communicator.hpp"
#include "structure/mmcif_file.hpp"

namespace catena::command {

namespace {

/// Returns the levels of --simd that this processor can run, widest first.
std::string simd_names() {
    std::vector<char const*> names;
    for (SimdLevel const level : simd_levels()) names.insert(names.begin(), name_of(level));
    return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::string version() { return CATENA_VERSION; }

nlohmann::ordered_json version_json() {
    return {{"catena", version()},     {"compiler", compiler_name()},
            {"flags", CATENA_FLAGS},   {"instruction_set", instruction_set()},
            {"simd", simd_names()},    {"mpi", message_passing_library()},
            {"openmp", CATENA_OPENMP}, {"openmm", openmm_version()},
            {"hdf5", hdf5_version()},  {"gemmi", scene::gemmi_version()},
            {"cuda", cuda::version()}};
}

nlohmann::ordered_json hardware_json() {
    nlohmann::ordered_json hardware{{"processor", processor_name()},
                                    {"hardware_threads", processor_threads()},
                                    {"gpu", nullptr}};
    if (cuda::why_not().empty()) hardware["gpu"] = cuda::device_name();
    return hardware;
}

std::string hardware_text() {
    std::string const gpu = cuda::why_not().empty() ? ", " + cuda::device_name() : "";
    return fmt::format("{} threads on {}{}", processor_threads(), processor_name(), gpu);
}

std::string version_text() {
    std::string text =
        fmt::format("catena {} ({}, {})\n", version(), compiler_name(), instruction_set());
    nlohmann::ordered_json const all = version_json();
    for (auto const& [label, key] : {std::pair{"SIMD", "simd"},
                                     {"MPI", "mpi"},
                                     {"OpenMP", "openmp"},
                                     {"OpenMM", "openmm"},
                                     {"HDF5", "hdf5"},
                                     {"gemmi", "gemmi"},
                                     {"CUDA", "cuda"}})
        text += fmt::format("  {:<8}{}\n", label, all.at(key).get<std::string>());
    return text;
}

}  // namespace catena::command
