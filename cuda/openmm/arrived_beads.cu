// Kernels that move positions and forces between OpenMM's arrays, those of layers and the inboxes
// of ranks.
#include <cuda/atomic>

#include "cuda/exchange/peer_exchange.cuh"
#include "cuda/openmm/gpu_layer.hpp"
#include "cuda/openmm/gpu_path.hpp"
#include "cuda/openmm/pair_share.hpp"
#include "cuda/space/kernels.cuh"

namespace catena::cuda {
namespace {

/// Runs action(i) for i in [0, count). Neighbouring threads take neighbouring elements of a
/// message.
template <class Action>
__global__ void in_turn(std::int64_t count, Action action) {
    std::int64_t const i = std::int64_t{blockIdx.x} * blockDim.x + threadIdx.x;
    if (i < count) action(i);
}
/// Launches in_turn() for `count` items on `stream`.
template <class Action>
void each(std::int64_t count, Action const& action, cudaStream_t stream) {
    if (count == 0) return;
    int constexpr threads = 256;
    in_turn<<<static_cast<unsigned>((count + threads - 1) / threads), threads, 0, stream>>>(count,
                                                                                            action);
    check(cudaGetLastError(), "start a kernel");
}

/// Barrier between ranks, one block per rank. It makes everything visible that ranks wrote before
/// it to the memory of any GPU.
__global__ void meet(PeerBoxes boxes) {
    int const rank = static_cast<int>(threadIdx.x);
    if (rank >= boxes.ranks || rank == boxes.rank) return;
    unsigned long long const times = *boxes.exchanged(rank) += 1;
    using Counter = ::cuda::atomic_ref<unsigned long long, ::cuda::thread_scope_system>;
    Counter(*boxes.came(rank, boxes.rank)).store(times, ::cuda::std::memory_order_release);
    Counter const theirs(*boxes.came(boxes.rank, rank));
    while (theirs.load(::cuda::std::memory_order_acquire) < times) {
    }
}

}  // namespace

void put(std::int64_t count, ArrivedBeads const& arrived, cudaStream_t stream) {
    each(count, arrived, stream);
}
template <class Number>
void copy(std::int64_t count, LayerPositions<Number> const& positions, cudaStream_t stream) {
    each(count, positions, stream);
}
template void copy(std::int64_t, LayerPositions<float> const&, cudaStream_t);
template void copy(std::int64_t, LayerPositions<double> const&, cudaStream_t);
void add(LayerForces const& forces, cudaStream_t stream) { each(3 * forces.count, forces, stream); }
void send(std::int64_t count, SentPositions const& sent, cudaStream_t stream) {
    each(3 * count, sent, stream);
}
void take(std::int64_t count, ArrivedPositions const& arrived, cudaStream_t stream) {
    each(3 * count, arrived, stream);
}
template <class Number>
void send(SentForces<Number> const& sent, cudaStream_t stream) {
    each(3 * sent.count(), sent, stream);
}
template <class Number>
void add(std::int64_t count, ReturnedForces<Number> const& returned, cudaStream_t stream) {
    each(3 * count, returned, stream);
}
template void send(SentForces<std::int64_t> const&, cudaStream_t);
template void send(SentForces<float> const&, cudaStream_t);
template void add(std::int64_t, ReturnedForces<std::int64_t> const&, cudaStream_t);
template void add(std::int64_t, ReturnedForces<float> const&, cudaStream_t);

void meet(PeerBoxes const& boxes, cudaStream_t stream) {
    meet<<<1, most_peers, 0, stream>>>(boxes);
    check(cudaGetLastError(), "start a kernel");
}

}  // namespace catena::cuda
