// Locates and loads the module that knows OpenMM's CUDA platform, and opens OpenMM's arrays with
// it.
#include <dlfcn.h>

#include <filesystem>
#include <string>

#include "cuda/device/gpu.hpp"
#include "cuda/openmm/gpu_path.hpp"

namespace catena::cuda {
namespace {

namespace fs = std::filesystem;

/// Returns the folders searched for the module. They are the folder of the program or library that
/// holds this function, the library folder installed next to it, the installation folder of this
/// build, and its build folder.
std::vector<fs::path> module_folders() {
    std::vector<fs::path> folders;
    Dl_info here{};
    if (dladdr(reinterpret_cast<void const*>(&why_no_device_path), &here) != 0 &&
        here.dli_fname != nullptr) {
        std::error_code ignored;
        fs::path const folder = fs::weakly_canonical(here.dli_fname, ignored).parent_path();
        folders = {folder, folder.parent_path() / CATENA_LIBRARY_FOLDER};
    }
    for (char const* const folder : {CATENA_MODULE_FOLDERS}) folders.emplace_back(folder);
    return folders;
}

/// The loaded module, or the reason why there is none.
struct Module {
    ModuleEntry entry = nullptr;
    std::string why_not;
    ModuleSharesPairs shares_pairs = nullptr;
};

Module load() {
    if (!why_not().empty()) return {nullptr, why_not()};
    for (fs::path const& folder : module_folders()) {
        std::error_code ignored;
        if (!fs::exists(folder / module_file, ignored)) continue;
        void* const library = dlopen((folder / module_file).c_str(), RTLD_NOW | RTLD_LOCAL);
        void* const entry = library ? dlsym(library, module_entry) : nullptr;
        if (entry)
            return {reinterpret_cast<ModuleEntry>(entry), "",
                    reinterpret_cast<ModuleSharesPairs>(dlsym(library, module_shares_pairs))};
        char const* const reason = dlerror();
        return {nullptr, reason ? reason : std::string(module_file) + " has no entry"};
    }
    return {nullptr, std::string(module_file) +
                         " is not there: this build found no headers of OpenMM's CUDA platform"};
}

Module const& module() {
    static Module const loaded = load();
    return loaded;
}

}  // namespace

std::string const& why_no_device_path() { return module().why_not; }

std::string why_pairs_cannot_be_shared() {
    return module().shares_pairs && module().shares_pairs()
               ? ""
               : "the pair kernel of this OpenMM cannot be restricted to a share of pairs";
}

int chosen_device() {
    int device = 0;
    check(cudaGetDevice(&device), "report its number");
    return device;
}

std::unique_ptr<OpenMmOnDevice> on_device(OpenMM::Context& context) {
    return std::unique_ptr<OpenMmOnDevice>(module().entry(context));
}

}  // namespace catena::cuda
