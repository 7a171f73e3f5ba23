// Implements the comparison with what the host has free.
#include "plan/host_memory.hpp"

#include <fmt/format.h>

#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <limits>

#include "console/text.hpp"
#include "cuda/device/gpu.hpp"
#include "error.hpp"
#include "io/memory_limit.hpp"
#include "mpi/collectives.hpp"
#include "plan/describe.hpp"

namespace catena::command {
namespace {

/// Bytes that OpenMM takes for a bead at least. Its CPU platform took 1,500 to 1,700 for 300,000 to
/// 3,000,000 beads of CALVADOS 2.
constexpr double openmm_bytes = 1000;

/// Returns the number that follows `key` in a file of lines such as "MemAvailable: 123 kB". An
/// empty key stands for a file of one number. Returns nothing if there is none ("max").
std::optional<double> number_in(std::string const& path, std::string const& key = "") {
    std::ifstream file(path);
    double number = 0;
    for (std::string word; key.empty() || file >> word;) {
        if (word != key) continue;
        if (file >> number) return number;
        break;
    }
    return std::nullopt;
}

/// Names of a control group's files in one version of control groups.
struct GroupFiles {
    char const *most, *used, *cached;
};
constexpr GroupFiles version_1{"/memory.limit_in_bytes", "/memory.usage_in_bytes",
                               "total_inactive_file"},
    version_2{"/memory.max", "/memory.current", "inactive_file"};

/// Returns what the control group in `folder` allows beyond what it uses. Cached files count as
/// free.
double free_in_group(std::string const& folder, GroupFiles const& files) {
    auto const most = number_in(folder + files.most);
    if (!most) return std::numeric_limits<double>::infinity();
    double const used = number_in(folder + files.used).value_or(0),
                 cached = number_in(folder + "/memory.stat", files.cached).value_or(0);
    return std::max(0.0, *most - used + cached);
}

/// Returns what the control group and those around it allow. `path`: "/job/step" or "/".
double least_of(std::string const& mounted, std::string path, GroupFiles const& files) {
    double least = std::numeric_limits<double>::infinity();
    while (true) {
        least = std::min(least, free_in_group(mounted + path, files));
        if (path.empty()) return least;
        path.resize(path.rfind('/'));
    }
}

/// Returns what the control groups of this process allow. Their file has lines
/// "number:controllers:path"; version 2 has "0::path". A container may see its own group as the
/// mounted one.
double free_in_groups(std::string const& root) {
    std::string const mounted = root + "sys/fs/cgroup";
    double least =
        std::min(least_of(mounted, "", version_2), least_of(mounted + "/memory", "", version_1));
    std::ifstream file(root + "proc/self/cgroup");
    for (std::string line; std::getline(file, line);) {
        std::size_t const first = line.find(':'), second = line.find(':', first + 1);
        if (second == std::string::npos || line.compare(second + 1, 1, "/") != 0) continue;
        std::string const controllers = "," + line.substr(first + 1, second - first - 1) + ",",
                          path = line.substr(second + 1);
        if (controllers == ",,") least = std::min(least, least_of(mounted, path, version_2));
        if (controllers.find(",memory,") != std::string::npos)
            least = std::min(least, least_of(mounted + "/memory", path, version_1));
    }
    return least;
}

/// Returns what `ulimit -v` allows this process beyond the address space that it has taken.
double free_in_limit() {
    rlimit limit{};
    if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
        return std::numeric_limits<double>::infinity();
    double const taken = 1024 * number_in("/proc/self/status", "VmSize:").value_or(0);
    return std::max(0.0, static_cast<double>(limit.rlim_cur) - taken);
}

/// True if the chains are, or may be, computed on a GPU.
bool may_use_gpu(Backend backend) {
    return uses_gpu(backend) || (backend == Backend::automatic && cuda::why_not().empty());
}

/// Returns the bytes that OpenMM takes at least on one of the ranks.
double forces_of_rank(Scene const& scene, int ranks) {
    return scene.forces.openmm ? openmm_bytes * static_cast<double>(scene.bodies()) / ranks : 0;
}

/// Returns the one that lacks more.
HostMemory worse(HostMemory const& a, HostMemory const& b) {
    return b.needed * a.free > a.needed * b.free ? b : a;
}

}  // namespace

std::optional<double> free_host_memory(std::string const& root) {
    auto const available = number_in(root + "proc/meminfo", "MemAvailable:");
    if (!available) return std::nullopt;
    return std::min(1024 * *available, free_in_groups(root));
}

std::string HostMemory::note() const {
    if (by_ulimit)
        return fmt::format(
            "a run needs at least {} of memory in a process, `ulimit -v` leaves {}: raise it, or "
            "take more ranks or fewer chains",
            bytes_text(needed), bytes_text(free));
    return fmt::format(
        "a run needs at least {} of memory on a host, {} are free: the system may "
        "kill it without a message; take more hosts or fewer chains",
        bytes_text(needed), bytes_text(free));
}

void refuse_replicas_beyond_memory(Scene const& first, int ranks, int on_host) {
    Memory const one = memory_of(first, ranks);
    double of_rank = one.scene;
    if (!may_use_gpu(first.solver.backend))
        of_rank += one.state + one.solver + forces_of_rank(first, ranks);
    of_rank *= static_cast<double>(first.replicas);
    double const needed = is_limited_by_ulimit() ? of_rank : of_rank * on_host;
    if (needed <= static_cast<double>(memory_limit())) return;
    throw InputError(
        fmt::format("{} replicas need at least {} of memory {}, and only {}", first.replicas,
                    bytes_text(needed), is_limited_by_ulimit() ? "in a process" : "on a host",
                    available_memory()),
        first.file + ": replicas", "make fewer replicas, or run on more hosts");
}

std::optional<HostMemory> lacking_memory(Scene const& scene, Communicator const& communicator) {
    // The scene itself has been read: it is no longer part of what is free.
    Memory const memory = memory_of(scene, communicator.size());
    double const of_rank =
        memory.state + memory.solver + forces_of_rank(scene, communicator.size());
    HostMemory own{0, 1};
    if (auto const free = free_host_memory(); free && !may_use_gpu(scene.solver.backend))
        own = worse({of_rank * communicator.ranks_on_host(), *free},
                    {of_rank, free_in_limit(), true});
    HostMemory worst = own;
    for (HostMemory const& each : all_gathered(communicator, own)) worst = worse(worst, each);
    if (worst.needed <= worst.free) return std::nullopt;
    return worst;
}

}  // namespace catena::command
