#include "cuda/gpu_path.hpp"
#include "cuda/kernels.cuh"
#include "cuda/pair_share.hpp"
#include "cuda/peer_exchange.cuh"

namespace catena::cuda {
namespace {

/// Neighbours in messages are taken by neighbouring threads.
template <class Action>
__global__ void in_turn(std::int64_t count, Action action) {
    std::int64_t const i = std::int64_t{blockIdx.x} * blockDim.x + threadIdx.x;
    if (i < count) action(i);
}
template <class Action>
void each(std::int64_t count, Action const& action, cudaStream_t stream) {
    if (count == 0) return;
    int constexpr threads = 256;
    in_turn<<<static_cast<unsigned>((count + threads - 1) / threads), threads, 0, stream>>>(count, action);
    check(cudaGetLastError(), "start a kernel");
}

struct NoNumbers {
    __device__ double show(std::int64_t) const { return 0; }
    __device__ void take(std::int64_t, double) const {}
};

}  // namespace

void put(std::int64_t count, ArrivedBeads const& arrived, cudaStream_t stream) { each(count, arrived, stream); }
void send(std::int64_t count, SentPositions const& sent, cudaStream_t stream) { each(3 * count, sent, stream); }
void take(std::int64_t count, ArrivedPositions const& arrived, cudaStream_t stream) { each(3 * count, arrived, stream); }
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
    PeerCall call{boxes};
    for (int rank = 0; rank < boxes.ranks; ++rank)
        if (rank != boxes.rank) call.add(rank, 0, 0);
    kernels::exchange<<<1, kernels::threads_of_exchange, 0, stream>>>(call, NoNumbers{});
    check(cudaGetLastError(), "start a kernel");
}

}  // namespace catena::cuda
