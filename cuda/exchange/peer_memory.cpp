// Implements the mapping of GPU memory between ranks by CUDA's interprocess handles.
#include "cuda/exchange/peer_memory.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <string>
#include <utility>

#include "cuda/device/gpu.hpp"
#include "mpi/collectives.hpp"
#include "mpi/gpu_exchange.hpp"
#include "neighbours/device_path.hpp"

namespace catena::cuda {
namespace {

/// True on all ranks if `here` is true on every rank. Collective.
bool agreed(Communicator const& communicator, bool here) {
    return communicator.sum(here ? 0 : 1) == 0;
}

bool equal(cudaUUID_t const& a, cudaUUID_t const& b) { return std::memcmp(&a, &b, sizeof(a)) == 0; }

/// True if this GPU can reach the other ranks' GPUs. GPUs that this process does not see count as
/// reachable.
bool reaches(int device, std::vector<cudaUUID_t> const& others) {
    int count = 0;
    check(cudaGetDeviceCount(&count), "report the number of devices");
    for (int other = 0; other < count; ++other) {
        cudaDeviceProp gpu{};
        check(cudaGetDeviceProperties(&gpu, other), "report its properties");
        bool const asked = std::any_of(others.begin(), others.end(), [&](cudaUUID_t const& uuid) {
            return equal(uuid, gpu.uuid);
        });
        int can = 1;
        if (asked && other != device)
            check(cudaDeviceCanAccessPeer(&can, device, other), "report the GPUs that it reaches");
        if (can == 0) return false;
    }
    return true;
}

/// Returns the identifiers of all ranks' GPUs, independent of how each process numbers them.
/// Collective.
std::vector<cudaUUID_t> gpus_of_ranks(Communicator const& communicator) {
    int device = 0;
    cudaDeviceProp gpu{};
    check(cudaGetDevice(&device), "report its number");
    check(cudaGetDeviceProperties(&gpu, device), "report its properties");
    return all_gathered(communicator, gpu.uuid);
}

/// Returns the largest number of ranks that have the same GPU.
int most_alike(std::vector<cudaUUID_t> const& all) {
    std::ptrdiff_t most = 0;
    for (cudaUUID_t const& gpu : all)
        most = std::max(most, std::count_if(all.begin(), all.end(), [&](cudaUUID_t const& other) {
                            return equal(gpu, other);
                        }));
    return static_cast<int>(most);
}

/// True if all ranks are on one host, each on its own GPU, and every visible GPU of a rank can be
/// reached.
bool apart_on_one_host(Communicator const& communicator) {
    if (communicator.ranks_on_host() != communicator.size() || communicator.size() > most_peers)
        return false;
    std::vector<cudaUUID_t> const all = gpus_of_ranks(communicator);
    int device = 0;
    check(cudaGetDevice(&device), "report its number");
    return most_alike(all) == 1 && reaches(device, all);
}

// Size of the memory in doubles: 16 MiB. The widest segments of all ranks' shared units use most of
// it.
constexpr std::int64_t capacity = 1 << 21;

/// Returns the number of the current CUDA context, or 0 if the driver does not tell. Numbers are
/// unique, also among contexts that have been destroyed.
unsigned long long context_number() {
    using Ask = int (*)(void* context, unsigned long long* number);
    static auto const ask = [] {
        void* const driver = dlopen("libcuda.so.1", RTLD_LAZY | RTLD_NOLOAD);
        return driver ? reinterpret_cast<Ask>(dlsym(driver, "cuCtxGetId")) : nullptr;
    }();
    unsigned long long number = 0;
    return ask && ask(nullptr, &number) == 0 ? number : 0;
}

/// Mapped memory that no object uses at present. A mapping can be used only in the context that
/// made it, and ends with it; OpenMM's contexts are short-lived.
struct Spare {
    unsigned long long context;
    std::vector<double*> base;
};
std::vector<Spare>& spares() {
    static auto* const list = new std::vector<Spare>;  // outlives the objects that return memory
    return *list;
}

/// Returns mapped memory of the current context for reuse; empty unless every rank has some.
/// Collective.
std::vector<double*> take_spare(Communicator const& communicator) {
    unsigned long long const here = context_number();
    auto const ranks = static_cast<std::size_t>(communicator.size());
    auto const found = std::find_if(spares().begin(), spares().end(), [&](Spare const& spare) {
        return here != 0 && spare.context == here && spare.base.size() == ranks;
    });
    if (!agreed(communicator, found != spares().end())) return {};
    std::vector<double*> base = std::move(found->base);
    spares().erase(found);
    return base;
}

/// Allocates memory on every rank and maps it. Returns each rank's memory as seen here, or nothing
/// if some rank cannot reach another. Collective.
std::vector<double*> mapped(Communicator const& communicator) {
    void* own = nullptr;
    check(cudaMalloc(&own, capacity * sizeof(double)), "allocate memory");
    std::vector<double*> base;
    for (void* const there : map_each_others(communicator, own))
        base.push_back(static_cast<double*>(there));
    if (base.empty()) cudaFree(own);
    return base;
}

}  // namespace

bool gpus_may_write_to_each_other(Communicator const& communicator) {
    return communicator.size() > 1 && communicator.may_be_passed_by() &&
           gpu_exchange_choice(variable_of_first_rank(communicator, "CATENA_GPU_EXCHANGE")) !=
               GpuExchange::host &&
           agreed(communicator, apart_on_one_host(communicator));
}

int most_ranks_of_a_gpu(Communicator const& communicator) {
    return most_alike(gpus_of_ranks(communicator));
}

bool gpus_are_alike(Communicator const& communicator) {
    int device = 0;
    cudaDeviceProp gpu{};
    check(cudaGetDevice(&device), "report its number");
    check(cudaGetDeviceProperties(&gpu, device), "report its properties");
    std::vector<char> const all = all_gathered_alike(communicator, gpu.name);
    bool alike = true;
    for (std::size_t r = 0; r < all.size(); r += sizeof(gpu.name))
        alike = alike && std::strcmp(gpu.name, all.data() + r) == 0;
    return agreed(communicator, alike);
}

std::vector<void*> map_each_others(Communicator const& communicator, void* own) {
    cudaIpcMemHandle_t handle{};
    bool const shown = cudaIpcGetMemHandle(&handle, own) == cudaSuccess;
    std::vector<cudaIpcMemHandle_t> const all = all_gathered(communicator, handle);
    std::vector<void*> base;
    bool opened = agreed(communicator, shown);
    for (std::size_t r = 0; opened && r < all.size(); ++r) {
        void* there = own;
        if (static_cast<int>(r) != communicator.rank())
            opened =
                cudaIpcOpenMemHandle(&there, all[r], cudaIpcMemLazyEnablePeerAccess) == cudaSuccess;
        if (opened) base.push_back(there);
    }
    cudaGetLastError();  // otherwise the next call would report this error
    if (agreed(communicator, opened)) return base;
    unmap(base, communicator.rank());
    communicator.barrier();
    return {};
}

void unmap(std::vector<void*> const& base, int own_rank) {
    for (std::size_t r = 0; r < base.size(); ++r)
        if (static_cast<int>(r) != own_rank) cudaIpcCloseMemHandle(base[r]);
}

std::shared_ptr<PeerMemory> PeerMemory::connect(Communicator const& communicator) {
    if (!gpus_may_write_to_each_other(communicator)) return nullptr;
    std::vector<double*> base = take_spare(communicator);
    if (base.empty()) base = mapped(communicator);
    if (base.empty()) return nullptr;
    // All earlier work in the reused memory must have ended on all ranks.
    check(cudaDeviceSynchronize(), "finish its work");
    communicator.barrier();
    double* const own = base[static_cast<std::size_t>(communicator.rank())];
    check(cudaMemset(own, 0, capacity * sizeof(double)), "clear memory");
    check(cudaDeviceSynchronize(), "clear memory");
    communicator.barrier();
    return std::shared_ptr<PeerMemory>(new PeerMemory(communicator.rank(), base));
}

PeerMemory::PeerMemory(int rank, std::vector<double*> base)
    : rank_(rank),
      ranks_(static_cast<int>(base.size())),
      context_(context_number()),
      base_(std::move(base)) {}
PeerMemory::~PeerMemory() { spares().push_back({context_, base_}); }

PeerBoxes PeerMemory::boxes(int width) {
    PeerBoxes boxes;
    boxes.rank = rank_;
    boxes.ranks = ranks_;
    boxes.width = width;
    std::int64_t const numbers = PeerBoxes::numbers(ranks_, width);
    if (used_ + numbers > capacity)
        throw ComputationError("what GPUs exchange takes more than " +
                               std::to_string(8 * capacity) + " bytes");
    for (std::size_t r = 0; r < base_.size(); ++r) boxes.base[r] = base_[r] + used_;
    used_ += (numbers + 15) / 16 * 16;
    return boxes;
}

}  // namespace catena::cuda
