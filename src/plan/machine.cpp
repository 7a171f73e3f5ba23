// Implements the description of this machine: arrangements, identity and measurements.
#include "plan/machine.hpp"

#include <sys/stat.h>

#include <algorithm>

#include "cuda/device/gpu.hpp"
#include "cuda/space/memory.hpp"
#include "force/openmm_force.hpp"
#include "measure/hardware.hpp"

namespace catena::plan {
namespace {

/// Identifies the running executable by size and time, so that another build gets a cache file of
/// its own.
std::string build() {
    struct stat file{};
    if (::stat("/proc/self/exe", &file) != 0) return "unknown";
    return std::to_string(file.st_size) + " bytes of " + std::to_string(file.st_mtim.tv_sec) + "." +
           std::to_string(file.st_mtim.tv_nsec);
}

/// Returns 2, 4, 8, ... and `all`; returns `all` alone if the user asked for that number.
std::vector<int> numbers_of_threads(int all, bool asked) {
    std::vector<int> numbers;
    for (int threads = 2; threads < all && !asked; threads *= 2) numbers.push_back(threads);
    if (all > 1) numbers.push_back(all);
    return numbers;
}

/// Returns the bytes on the GPU for chains of a family. They are counted for a chain of at most
/// 16384 bodies and scaled in proportion to the length.
double gpu_memory_of(Family const& family, std::int64_t bodies) {
    std::int64_t constexpr largest = 16384;
    std::int64_t const counted = std::min(bodies, largest);
    Scene const scene = sample(family, counted);
    auto const alone = serial_communicator();
    auto const groups = make_groups(scene, family.axes, family.handles, false, *alone);
    double const bytes = static_cast<double>(
        cuda::memory_needed(*groups.front(), scene, Backend::cuda, *alone).sum());
    return bytes * static_cast<double>(bodies) / static_cast<double>(counted);
}

/// Calls `use` with the system of a sample chain of the family.
template <class Use>
auto with_sample(Family const& family, std::int64_t bodies, Arrangement const& arrangement,
                 Use const& use) {
    Scene const scene = arranged(sample(family, bodies), arrangement);
    auto const alone = serial_communicator();
    ChainSystem system(scene, family.axes, *alone);
    return use(system);
}

/// Returns how many of the rank's cores other programs leave free just now.
int spare_cores(Communicator const& communicator) {
    int const ranks = communicator.ranks_on_host(), others = std::max(0, tasks_running() - ranks);
    return std::clamp((processor_threads() - others) / ranks, 1, cores_of_rank(communicator));
}

}  // namespace

/// Collects arrangements and measuring functions for the cores of this rank.
Machine this_machine(Communicator const& communicator, int threads) {
    int const cores = cores_of_rank(communicator);
    Machine m;
    m.threads = openmp_is_built() ? (threads > 0 ? threads : cores) : 1;
    if (m.threads > 1 && threads == 0)
        // A number of threads that the user asked for is used as it is.
        m.spare = spare_cores(communicator);
    m.no_gpu = cuda::why_not();
    m.alike.push_back({Backend::segments, 1});
    for (int const number : numbers_of_threads(m.threads, threads > 0))
        m.alike.push_back({Backend::openmp, number});
    if (m.no_gpu.empty()) m.alike.push_back({Backend::cuda, m.threads});
    m.others.push_back({Backend::serial, 1});
    m.identity = processor_name() + ", " + std::to_string(cores) + " of " +
                 std::to_string(processor_threads()) + " threads, " +
                 std::to_string(communicator.ranks_on_host()) + " ranks; " +
                 (m.no_gpu.empty() ? cuda::device_name() : "no GPU") + "; catena " +
                 CATENA_VERSION + ", " + compiler_name() + ", " + instruction_set() + ", simd " +
                 name_of(best_simd_level()) + ", " + build();
    m.measure = [](Family const& family, std::int64_t bodies, Arrangement const& arrangement) {
        return with_sample(family, bodies, arrangement,
                           [](ChainSystem& system) { return measure_phases(system); });
    };
    m.measure_drifts = [](Family const& family, std::int64_t bodies,
                          Arrangement const& arrangement) {
        return with_sample(family, bodies, arrangement,
                           [](ChainSystem& system) { return measure_drifts(system); });
    };
    m.measure_levels = [](Family const& family, std::int64_t bodies, Place place, int of_host) {
        auto const executor = openmp_is_built() ? openmp_executor(of_host) : serial_executor();
        return measure_level_costs(
            family, bodies, place == Place::gpu ? cuda::make_levels : dca::host_levels(*executor));
    };
    m.gpu_memory = gpu_memory_of;
    m.openmm_on_gpu = [] {
        auto const platforms = openmm_platforms();
        return std::find(platforms.begin(), platforms.end(), "CUDA") != platforms.end();
    };
    m.free_gpu_memory = [&communicator] {
        return static_cast<double>(cuda::free_memory(communicator));
    };
    return m;
}

void without_gpu(Machine& machine, std::string const& reason) {
    if (machine.no_gpu.empty()) machine.no_gpu = reason;
    std::erase_if(machine.alike, [](Arrangement const& a) { return uses_gpu(a.backend); });
}

}  // namespace catena::plan
