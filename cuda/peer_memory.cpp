#include "cuda/peer_memory.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <span>

#include "cuda/solver.hpp"

namespace catena::cuda {
namespace {

/// Rank 0's CATENA_GPU_EXCHANGE: launchers bring variables to other hosts only when told to.
bool wanted(Communicator const& communicator) {
    char text[16] = {};
    if (char const* const own = std::getenv("CATENA_GPU_EXCHANGE")) std::strncpy(text, own, sizeof(text) - 1);
    communicator.broadcast(std::as_writable_bytes(std::span(text)));
    if (text[0] != 0 && std::strcmp(text, "host") != 0 && std::strcmp(text, "direct") != 0)
        throw InputError("`" + std::string(text) + "` is no way for GPUs to exchange numbers", "CATENA_GPU_EXCHANGE", "use direct or host");
    return std::strcmp(text, "host") != 0;
}

bool agreed(Communicator const& communicator, bool here) { return communicator.sum(here ? 0 : 1) == 0; }

/// Each rank on a GPU of its own.
bool alone_on_gpus(Communicator const& communicator) {
    return communicator.ranks_on_host() == communicator.size() && communicator.size() <= std::min(devices(), most_peers);
}

}  // namespace

std::shared_ptr<PeerMemory> PeerMemory::connect(Communicator const& communicator) {
    if (communicator.size() == 1 || !wanted(communicator) || !agreed(communicator, alone_on_gpus(communicator))) return nullptr;
    std::shared_ptr<PeerMemory> memory(new PeerMemory(communicator.rank(), communicator.size()));
    return memory->open(communicator) ? memory : nullptr;
}

PeerMemory::PeerMemory(int rank, int ranks) : rank_(rank), ranks_(ranks), own_(capacity), base_(static_cast<std::size_t>(ranks), nullptr) {}

PeerMemory::~PeerMemory() {
    for (double* const base : base_)
        if (base != nullptr && base != own_.data()) cudaIpcCloseMemHandle(base);
}

bool PeerMemory::open(Communicator const& communicator) {
    cudaIpcMemHandle_t handle{};
    bool shown = cudaIpcGetMemHandle(&handle, own_.data()) == cudaSuccess;
    if (!agreed(communicator, shown)) return static_cast<void>(cudaGetLastError()), false;
    std::vector<cudaIpcMemHandle_t> all(static_cast<std::size_t>(ranks_));
    std::vector<std::int64_t> const bytes(all.size(), sizeof(handle));
    communicator.all_gather(std::as_bytes(std::span(&handle, 1)), std::as_writable_bytes(std::span(all)), bytes);
    bool const opened = open_all(all);
    if (!opened) cudaGetLastError();  // what it left behind would fail the next call
    return agreed(communicator, opened);
}

bool PeerMemory::open_all(std::vector<cudaIpcMemHandle_t> const& handles) {
    for (int rank = 0; rank < ranks_; ++rank) {
        auto const r = static_cast<std::size_t>(rank);
        void* base = own_.data();
        if (rank != rank_ && cudaIpcOpenMemHandle(&base, handles[r], cudaIpcMemLazyEnablePeerAccess) != cudaSuccess) return false;
        base_[r] = static_cast<double*>(base);
    }
    return true;
}

PeerBoxes PeerMemory::boxes(int width) {
    PeerBoxes boxes;
    boxes.rank = rank_;
    boxes.ranks = ranks_;
    boxes.width = width;
    std::int64_t const numbers = PeerBoxes::numbers(ranks_, width);
    if (used_ + numbers > capacity) throw ComputationError("what GPUs exchange takes more than " + std::to_string(8 * capacity) + " bytes");
    for (std::size_t r = 0; r < base_.size(); ++r) boxes.base[r] = base_[r] + used_;
    used_ += (numbers + 15) / 16 * 16;
    return boxes;
}

}  // namespace catena::cuda
