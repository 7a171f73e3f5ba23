// Implements the search for plugins and their loading.
#include "systems/plugins.hpp"

#include <OpenMM.h>
#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <system_error>

namespace catena {

namespace {

namespace fs = std::filesystem;

/// Folders to search, in order of precedence.
std::vector<fs::path> plugin_folders() {
    std::vector<fs::path> folders;
    if (char const* named = std::getenv("OPENMM_PLUGIN_DIR")) folders.emplace_back(named);
    Dl_info library{};
    if (dladdr(reinterpret_cast<void const*>(&OpenMM::Platform::getOpenMMVersion), &library) != 0 &&
        library.dli_fname != nullptr) {
        std::error_code ignored;
        fs::path const folder = fs::weakly_canonical(library.dli_fname, ignored).parent_path();
        folders.push_back(folder / "plugins");
        folders.push_back(folder / "openmm" / "plugins");  // Debian
    }
    folders.emplace_back(OpenMM::Platform::getDefaultPluginsDirectory());
    return folders;
}

/// Loads each plugin from the first folder that has it; returns the errors.
std::vector<std::string> load_plugins() {
    std::vector<std::string> failures;
    auto const folders = plugin_folders();
    for (char const* name : {"libOpenMMCPU.so", "libOpenMMPME.so", cuda_plugin}) {
        auto const folder = std::find_if(folders.begin(), folders.end(), [&](fs::path const& f) {
            std::error_code ignored;
            return fs::exists(f / name, ignored);
        });
        // A missing plugin is no error: its platform is optional.
        if (folder == folders.end()) continue;
        try {
            OpenMM::Platform::loadPluginLibrary((*folder / name).string());
        } catch (std::exception const& e) {
            failures.emplace_back(e.what());
        }
    }
    return failures;
}

}  // namespace

std::vector<std::string> const& load_openmm_plugins() {
    static std::vector<std::string> const failures = load_plugins();
    return failures;
}

}  // namespace catena
