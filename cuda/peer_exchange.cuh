// Exchanges between ranks by the memory of each other's GPUs (peer_memory.hpp).
#pragma once

#include <algorithm>
#include <cuda/atomic>
#include <memory>
#include <vector>

#include "cuda/peer_memory.hpp"
#include "dca/tree.hpp"

namespace catena::cuda {

/// Who takes part in an exchange: each of `peer` gets this rank's `sent` numbers, and of its own `received[p]` are taken, which are numbers
/// first[p], first[p] + 1, ... of all. Both of a pair call at the same time, if only to receive nothing. The rank itself may be one.
struct PeerCall {
    PeerBoxes boxes;
    int peers = 0, sent = 0;
    int peer[most_peers] = {};
    std::int64_t first[most_peers] = {};
    int received[most_peers] = {};

    explicit operator bool() const { return peers > 0; }
    void add(int rank, std::int64_t first_number, int count) {
        peer[peers] = rank;
        first[peers] = first_number;
        received[peers++] = count;
    }
};

/// A rank's ways to other ranks' GPUs; none by default.
class Peers {
  public:
    Peers() = default;
    /// Collective.
    explicit Peers(Communicator const& communicator) : memory_(PeerMemory::connect(communicator)) {
        if (memory_) of_bodies_ = memory_->boxes(most_of_a_body);
    }
    explicit operator bool() const { return memory_ != nullptr; }
    /// A body's numbers to one rank and from one; a negative rank means nobody.
    template <int numbers>
    PeerCall to_and_from(int to, int source) const {
        static_assert(numbers <= most_of_a_body);
        PeerCall call{of_bodies_};
        call.sent = numbers;
        if (to >= 0) call.add(to, 0, to == source ? numbers : 0);
        if (source >= 0 && source != to) call.add(source, 0, numbers);
        return call;
    }
    /// `width` numbers of every shared unit, to all. All ranks ask for the same ones in the same order.
    PeerCall among_all(dca::Schedule const& schedule, int width) const {
        PeerCall call;
        if (!memory_ || schedule.shared.empty()) return call;
        std::vector<int> numbers(static_cast<std::size_t>(memory_->ranks()), 0);
        for (dca::SharedUnit const& unit : schedule.shared) numbers[static_cast<std::size_t>(unit.owner)] += width;
        std::int64_t first = 0;
        for (int rank = 0; rank < memory_->ranks(); ++rank) {
            int const own = numbers[static_cast<std::size_t>(rank)];
            call.add(rank, first, own);
            if (rank == memory_->rank()) call.sent = own;
            first += own;
        }
        call.boxes = memory_->boxes(*std::max_element(numbers.begin(), numbers.end()));
        return call;
    }

  private:
    std::shared_ptr<PeerMemory> memory_;
    PeerBoxes of_bodies_;
};

namespace kernels {

constexpr int threads_of_exchange = 256;

/// One block. numbers.show(i): number i to be sent; numbers.take(i, value): number i of all. A box is filled anew only after its owner has
/// said, by filling the other one, that it was read.
template <class Numbers>
__global__ void exchange(PeerCall call, Numbers numbers) {
    PeerBoxes const& boxes = call.boxes;
    __shared__ unsigned long long times[most_peers];
    int const t = static_cast<int>(threadIdx.x);
    if (t < call.peers) times[t] = *boxes.exchanged(call.peer[t]) + 1;
    __syncthreads();
    for (int i = t; i < call.sent; i += threads_of_exchange) {
        double const value = numbers.show(i);
        for (int p = 0; p < call.peers; ++p) boxes.box(call.peer[p], boxes.rank, times[p])[i] = value;
    }
    __syncthreads();
    if (t < call.peers) {
        using Counter = ::cuda::atomic_ref<unsigned long long, ::cuda::thread_scope_system>;
        Counter(*boxes.filled(call.peer[t], boxes.rank)).store(times[t], ::cuda::std::memory_order_release);
        Counter const theirs(*boxes.filled(boxes.rank, call.peer[t]));
        while (theirs.load(::cuda::std::memory_order_acquire) < times[t]) {
        }
        *boxes.exchanged(call.peer[t]) = times[t];
    }
    __syncthreads();
    for (int p = 0; p < call.peers; ++p)
        for (int i = t; i < call.received[p]; i += threads_of_exchange)
            numbers.take(call.first[p] + i, __ldcg(boxes.box(boxes.rank, call.peer[p], times[p]) + i));
}

/// Of a body on its way into another rank's halo.
struct BodyNumbers {
    double const* from;
    double* to;
    __device__ double show(std::int64_t i) const { return from[i * gpu_order::lanes]; }
    __device__ void take(std::int64_t i, double value) const { to[i * gpu_order::lanes] = value; }
};

}  // namespace kernels
}  // namespace catena::cuda
