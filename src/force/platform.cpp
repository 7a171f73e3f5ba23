// Choice of OpenMM's platform and its properties.
#include "force/platform.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "error.hpp"
#include "mpi/thread_limit.hpp"
#include "systems/model.hpp"
#include "systems/plugins.hpp"

namespace catena {

namespace {

// A thread of platform CPU pays for this many beads.
std::int64_t constexpr beads_per_thread = 500;

std::vector<std::string> platforms_present() {
    std::vector<std::string> names;
    for (int i = 0; i < OpenMM::Platform::getNumPlatforms(); ++i)
        names.push_back(OpenMM::Platform::getPlatform(i).getName());
    return names;
}

bool contains(std::vector<std::string> const& names, std::string const& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// Returns the failures that concern a run. The CUDA plugin cannot be loaded without a GPU's
/// driver, which is a failure only if the chains are on a GPU.
std::vector<std::string> failures_of_run(std::vector<std::string> failures, bool on_gpu) {
    if (!on_gpu)
        std::erase_if(failures, [](std::string const& failure) {
            return failure.find(cuda_plugin) != std::string::npos;
        });
    return failures;
}

std::string refused_plugins(std::vector<std::string> const& failures) {
    return failures.empty() ? "" : fmt::format(" (not loaded: {})", fmt::join(failures, "; "));
}

}  // namespace

int useful_threads(BeadSystem const& beads, Communicator const& communicator) {
    return static_cast<int>(
        std::min<std::int64_t>(1 + beads.size() / beads_per_thread, cores_of_rank(communicator)));
}

OpenMmPlatform choose_platform(OpenMmSpec const& spec, BeadSystem const& beads,
                               Communicator const& communicator, int device) {
    auto const& failures = load_openmm_plugins();
    auto const present = platforms_present();
    bool const on_gpu = device >= 0;
    std::string const name = !spec.platform.empty()                ? spec.platform
                             : on_gpu && contains(present, "CUDA") ? "CUDA"
                             : contains(present, "CPU")            ? "CPU"
                                                                   : "Reference";
    if (!contains(present, name))
        throw InputError(
            fmt::format("OpenMM {} has no platform {}", OpenMM::Platform::getOpenMMVersion(), name),
            openmm_key(beads.scene_file, "platform"),
            fmt::format("use one of {}{}", fmt::join(present, ", "), refused_plugins(failures)));
    if (!spec.precision.empty() && spec.precision != "single" && spec.precision != "mixed" &&
        spec.precision != "double")
        throw InputError(fmt::format("`{}` is not a precision of OpenMM", spec.precision),
                         openmm_key(beads.scene_file, "precision"), "use single, mixed or double");

    OpenMmPlatform chosen;
    chosen.not_loaded = failures_of_run(failures, on_gpu);
    chosen.platform = &OpenMM::Platform::getPlatformByName(name);
    auto const known = chosen.platform->getPropertyNames();
    auto const set = [&](char const* property, std::string const& value) {
        if (contains(known, property)) chosen.properties[property] = value;
    };
    if (name == "CPU") {
        require_possible_threads(spec.threads, openmm_key(beads.scene_file, "threads"));
        chosen.threads = spec.threads > 0 ? spec.threads : useful_threads(beads, communicator);
        set("Threads", std::to_string(chosen.threads));
    } else if (!chosen.on_cpu()) {
        set("Precision", spec.precision.empty() ? "mixed" : spec.precision);
        int const gpu = spec.device >= 0 || name != "CUDA" ? spec.device : device;
        if (gpu >= 0) set("DeviceIndex", std::to_string(gpu));
    }
    set("DeterministicForces", "true");
    return chosen;
}

std::vector<std::string> openmm_platforms() {
    load_openmm_plugins();
    return platforms_present();
}

std::string openmm_version() { return "OpenMM " + OpenMM::Platform::getOpenMMVersion(); }

}  // namespace catena
