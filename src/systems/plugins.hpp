// Loading of OpenMM's platforms that are separate libraries.
#pragma once

#include <string>
#include <vector>

namespace catena {

/// Name of the file of platform CUDA, which needs the driver of a GPU.
inline constexpr char const* cuda_plugin = "libOpenMMCUDA.so";

/// Loads the CPU and CUDA plugins at the first call. They are searched in OPENMM_PLUGIN_DIR, then
/// next to libOpenMM.so, then in OpenMM's default folder. The default folder compiled into a wheel
/// is not where the wheel is installed. Its other plugins do not load everywhere, so that files are
/// named one by one. Returns the errors, one line per file.
std::vector<std::string> const& load_openmm_plugins();

}  // namespace catena
