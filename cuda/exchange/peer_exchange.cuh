// Exchanges between ranks by writing to the memory of each other's GPUs (peer_memory.hpp).
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "cuda/device/cluster.cuh"
#include "cuda/exchange/peer_memory.hpp"
#include "tree/tree.hpp"

namespace catena::cuda {

/// Participants of one exchange. Each rank in `peer` receives this rank's `sent` numbers. This rank
/// takes `received[p]` numbers from peer p: numbers first[p], first[p] + 1, ... of all numbers.
/// Both ranks of a pair call at the same time, even if one of them receives nothing.
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

/// Orders kernels in which ranks exchange: on one GPU they run one after the other, whatever their
/// streams. The order is that of the host's calls and the same on all ranks. Otherwise a kernel
/// that fills a GPU while it waits could block another kernel for which another GPU waits.
/// (Contexts are time-sliced on a GPU.)
class ExchangeOrder {
  public:
    /// Makes `stream` of context number `context` (PeerMemory) wait for the previous such kernel.
    /// While a stream is being captured, the previous kernel must have been on it as well.
    static void next(std::shared_ptr<Stream> const& stream, unsigned long long context) {
        static std::weak_ptr<Stream> last;
        static unsigned long long context_of_last = 0;
        if (auto const before = last.lock();
            before && before != stream && context_of_last == context) {
            Event so_far(Event::For::order);
            so_far.record(before->get());
            so_far.hold(stream->get());
        }
        last = stream;
        context_of_last = context;
    }
};

/// A rank's direct connections to other ranks' GPUs; none if default-constructed.
class Peers {
  public:
    Peers() = default;
    /// Connects to the other ranks, if they can be reached directly. Collective.
    explicit Peers(Communicator const& communicator) : memory_(PeerMemory::connect(communicator)) {
        if (memory_) of_bodies_ = memory_->boxes(most_of_a_body + 1);
    }
    explicit operator bool() const { return memory_ != nullptr; }
    /// Orders the next kernel of `stream` that uses the connections; that kernel must be enqueued
    /// right after the call. Precondition: there are connections.
    void meet_next(std::shared_ptr<Stream> const& stream) const {
        ExchangeOrder::next(stream, memory_->context());
    }
    /// Describes an exchange that sends a body's numbers to rank `to` and receives one from
    /// `source`. A negative rank means no rank.
    template <int numbers>
    PeerCall to_and_from(int to, int source) const {
        static_assert(numbers <= most_of_a_body);
        PeerCall call{of_bodies_};
        call.sent = numbers;
        if (to >= 0) call.add(to, 0, to == source ? numbers : 0);
        if (source >= 0 && source != to) call.add(source, 0, numbers);
        return call;
    }
    /// Describes an exchange of `width` numbers of every shared frontier unit among all ranks.
    /// There is room for up to `beside` numbers of bodies in addition. All ranks must request the
    /// same exchanges in the same order.
    PeerCall among_all(dca::Schedule const& schedule, int width, int beside) const {
        PeerCall call;
        if (!memory_ || schedule.shared.empty()) return call;
        std::vector<int> numbers(static_cast<std::size_t>(memory_->ranks()), 0);
        for (dca::FrontierUnit const& unit : schedule.shared)
            numbers[static_cast<std::size_t>(unit.owner)] += width;
        std::int64_t first = 0;
        for (int rank = 0; rank < memory_->ranks(); ++rank) {
            int const own = numbers[static_cast<std::size_t>(rank)];
            if (rank == memory_->rank())
                call.sent = own;
            else
                call.add(rank, first, own);
            first += own;
        }
        call.boxes = memory_->boxes(*std::max_element(numbers.begin(), numbers.end()) + beside + 1);
        return call;
    }

  private:
    std::shared_ptr<PeerMemory> memory_;
    PeerBoxes of_bodies_;
};

namespace kernels {

/// Block size of the exchange kernels.
constexpr int threads_of_exchange = 512;

/// Numbers of a body that are sent to another rank's halo, or received from there.
struct BodyNumbers {
    double const* from;
    double* to;
    __device__ double show(std::int64_t i) const { return from[i * gpu_order::lanes]; }
    __device__ void take(std::int64_t i, double value) const { to[i * gpu_order::lanes] = value; }
};
/// Bodies for neighbouring ranks' halos that are sent together with the numbers for all ranks. All
/// bodies that this rank receives come from one rank, `source`. A rank that has neighbours sends as
/// many numbers as they send.
struct BodiesBeside {
    static constexpr int most = 2;
    int count = 0, numbers = 0, source = -1;
    /// End of each body's range among all numbers.
    int end[most] = {};
    BodyNumbers body[most] = {};

    void add(int numbers_of_it, int from, BodyNumbers const& it) {
        end[count] = numbers += numbers_of_it;
        body[count++] = it;
        if (numbers_of_it > 0) source = from;
    }
    __device__ double show(int i) const {
        return i < end[0] ? body[0].show(i) : body[1].show(i - end[0]);
    }
    __device__ void take(int i, double value) const {
        BodyNumbers const& of = i < end[0] ? body[0] : body[1];
        of.take(i < end[0] ? i : i - end[0], value);
    }
};

/// Action that does nothing.
struct Nothing {
    __device__ void operator()(std::int64_t) const {}
};

/// Exchanges numbers with all peers. All threads of a block call it after a barrier; the block has
/// at least `peers` threads. numbers.show(i) returns number i to be sent; numbers.take(i, value)
/// stores number i of all. The last letter of a box is always sent. Its receiver then knows that
/// the sender has read the numbers of the previous exchange.
template <class Numbers>
__device__ void exchange_by_block(PeerCall const& call, Numbers const& numbers,
                                  BodiesBeside const& beside) {
    PeerBoxes const& boxes = call.boxes;
    int const t = static_cast<int>(threadIdx.x), threads = static_cast<int>(blockDim.x);
    auto const letters = [&](int at, int from, int p) {
        // Letters distinguish this many exchanges; number 0 is not used.
        unsigned long long const launches = 0xffffffff;
        unsigned long long const times = *boxes.exchanged(call.peer[p]) + 1;
        return LettersIn<PeerLetterBox>{
            reinterpret_cast<PeerLetterBox*>(boxes.box(at, from, times)), 1,
            static_cast<unsigned>(times % launches) + 1};
    };
    constexpr int at_once = 8;  // independent requests hide the latency of memory
    int const sent = call.sent + beside.numbers, last = boxes.width - 1;
    for (int first = t; first <= sent; first += at_once * threads) {
        double value[at_once];
        CATENA_UNROLL
        for (int j = 0; j < at_once; ++j) {
            int const i = first + j * threads;
            value[j] = i < call.sent ? numbers.show(i)
                       : i < sent    ? beside.show(i - call.sent)
                                     : 0.0;
        }
        for (int p = 0; p < call.peers; ++p) {
            auto const to = letters(call.peer[p], boxes.rank, p);
            CATENA_UNROLL
            for (int j = 0; j < at_once; ++j)
                if (int const i = first + j * threads; i <= sent)
                    to.put(0, i < sent ? i : last, value[j]);
        }
    }
    for (int p = 0; p < call.peers; ++p) {
        auto const came = letters(boxes.rank, call.peer[p], p);
        int const received = call.received[p],
                  end = received + (call.peer[p] == beside.source ? beside.numbers : 0);
        came.template take_some<at_once>(0, t, end, threads, [&](int i, double value) {
            if (i < received)
                numbers.take(call.first[p] + i, value);
            else
                beside.take(i - received, value);
        });
        if (t == 0) came.wait_for(0, last);
    }
    __syncthreads();
    if (t < call.peers) *boxes.exchanged(call.peer[t]) += 1;
}
/// Calls first(0) and then exchanges, in one block.
template <class Numbers, class First>
__global__ void __launch_bounds__(threads_of_exchange)
    exchange(PeerCall call, Numbers numbers, BodiesBeside beside, First first) {
    if (threadIdx.x == 0) first(0);
    __syncthreads();
    exchange_by_block(call, numbers, beside);
}
/// Exchange that kernels both_passes() and shared_passes_of_scan() perform between the two passes.
template <class Numbers>
struct ExchangeByBlock {
    PeerCall call;
    Numbers numbers;
    BodiesBeside beside;
    __device__ void operator()() const { exchange_by_block(call, numbers, beside); }
};

}  // namespace kernels

/// Exchange within a launch that is yet to be enqueued on a stream. next() is called just before
/// that launch and orders it after other exchanges (ExchangeOrder).
template <class Numbers>
struct ExchangeInTurn {
    Peers const& peers;
    std::shared_ptr<Stream> const& stream;
    kernels::ExchangeByBlock<Numbers> exchange;

    kernels::ExchangeByBlock<Numbers> const& next() const {
        peers.meet_next(stream);
        return exchange;
    }
};

}  // namespace catena::cuda
