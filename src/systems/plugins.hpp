// OpenMM's platforms that are libraries of their own.
#pragma once

#include <string>
#include <vector>

namespace catena {

/// Loads the CPU and CUDA plugins at the first call: those in OPENMM_PLUGIN_DIR, else those that
/// lie beside libOpenMM.so. A wheel's default folder is not where the wheel is, and its other
/// plugins do not load everywhere, so files are named one by one. Returns what did not load, one
/// line a file.
std::vector<std::string> const& load_openmm_plugins();

}  // namespace catena
