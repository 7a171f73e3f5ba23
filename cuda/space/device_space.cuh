// The Space of a GPU: one kernel per loop, all on one stream. Its members behave as
// dca/host_space.hpp specifies.
#pragma once

#include <algorithm>
#include <optional>

#include "cuda/exchange/peer_exchange.cuh"
#include "cuda/space/device_access.cuh"
#include "cuda/space/device_blocks.cuh"
#include "cuda/space/device_model.cuh"
#include "cuda/space/device_records.cuh"
#include "cuda/space/device_scan.cuh"
#include "cuda/space/device_tree.cuh"
#include "dca/host_space.hpp"

namespace catena::cuda {

/// Space whose arrays are in the memory of the current GPU.
class DeviceSpace : public DeviceAccess, public SharedModels<DeviceModel, ModelArrays> {
  public:
    /// Loops return before they are complete; wait() waits for them.
    static constexpr bool answers_at_once = false;
    /// Makes a space with a stream of its own, which copies share (DeviceAccess). The executor must
    /// outlive all copies.
    explicit DeviceSpace(Executor const& on_host) : on_host_(&on_host) {}
    /// Makes a space with direct connections to other ranks' GPUs, if possible. Collective.
    DeviceSpace(Executor const& on_host, Communicator const& communicator) : DeviceSpace(on_host) {
        peers_ = Peers(communicator);
    }
    /// Returns the executor of the work that remains on the host.
    Executor const& on_host() const { return *on_host_; }

    // Types of data in the GPU's memory; HostSpace describes each of them.

    template <class T>
    using Array = Buffer<T>;
    template <class T>
    using HostArray = PinnedBuffer<T>;
    template <int D>
    using FieldOf = DeviceField<D>;
    using Directions = DeviceDirections;
    template <class T>
    using List = Buffer<T>;
    template <int D>
    using Fixed = FixedField<D>;
    using Model = DeviceModel;
    template <class T, dca::Order order>
    using Records = DeviceRecords<T, order>;
    using ScanTree = DeviceScan;
    using Tree = DeviceTree;
    using Blocks = DeviceBlocks;
    /// True if blocks exist for handles with K directions: links and beads on links only.
    template <int K>
    static constexpr bool has_blocks = K == 1;
    /// True if blocks are teams of threads.
    template <int K>
    static constexpr bool has_teams = has_blocks<K>;
    /// True if every chain fits in the registers of one block and no chain has a jointed tip.
    bool pays_by_blocks(ChainGroup const& group) const {
        return !group.ends.has_tips() &&
               std::all_of(group.pieces.begin(), group.pieces.end(), [](dca::Piece const& piece) {
                   return piece.count <= DeviceBlocks::longest_chain;
               });
    }
    /// Calls action(team) in one launch, one block of threads per team of chains.
    template <class Action>
    void each_block(Blocks const& blocks, Action const& action) const {
        if (blocks.count() == 0) return;
        kernels::
            each_team<<<blocks.count(), static_cast<unsigned>(blocks.threads()),
                        kernels::DeviceTeam<Action::K>::shared_bytes(blocks.threads()), stream()>>>(
                blocks.teams(), action);
        started();
    }
    /// Performs the inward pass of a scan.
    template <class Scan>
    void climb(ScanTree const& tree, Scan const& scan) const {
        tree.climb(scan, stream());
    }
    /// Performs the outward pass of a scan.
    template <class Scan>
    void descend(ScanTree const& tree, Scan const& scan) const {
        tree.descend(scan, stream());
    }
    /// Performs both passes of a scan.
    template <class Scan>
    void climb_and_descend(ScanTree const& tree, Scan const& scan) const {
        tree.climb_and_descend(scan, stream());
    }
    /// Performs the inward pass of a sweep (assembly).
    template <class Sweep>
    void climb(Tree const& tree, Sweep const& sweep) const {
        tree.climb(sweep, stream());
    }
    /// Performs the outward pass of a sweep (disassembly).
    template <class Sweep>
    void descend(Tree const& tree, Sweep const& sweep) const {
        tree.descend(sweep, stream());
    }
    /// Performs both passes of a sweep.
    template <class Sweep>
    void climb_and_descend(Tree const& tree, Sweep const& sweep) const {
        tree.climb_and_descend(sweep, stream());
    }
    /// True if so few items leave the GPU with idle threads.
    static bool has_threads_to_spare(std::int64_t items) {
        return items <= most_items_with_threads_to_spare;
    }
    /// Exchanges one body's numbers with neighbouring ranks. Collective.
    template <int D>
    void exchange(Communicator const& communicator, BodyExchange<D> const& e) const {
        exchange(communicator, e, kernels::Nothing{});
    }
    /// Exchanges one body's numbers with neighbouring ranks, after first(0) on the GPU. Collective.
    template <int D, class First>
    void exchange(Communicator const& communicator, BodyExchange<D> const& e,
                  First const& first) const {
        if (!e) return;
        if (!peers_) {
            if constexpr (!std::is_same_v<First, kernels::Nothing>) for_each(1, first);
            return exchange_by_host(*this, communicator, e);
        }
        communicator.tally(traffic_of(e));
        exchange(peers_.to_and_from<D>(e.to, e.source), numbers_of(e), {}, first);
    }
    /// Participants of a direct exchange; false if GPUs are not connected.
    using Direct = PeerCall;
    /// Plans exchanges of `width` numbers per shared frontier unit, and `beside` numbers of bodies.
    Direct connect(dca::Schedule const& schedule, int width, int beside) const {
        return peers_.among_all(schedule, width, beside);
    }
    /// Exchanges `numbers` of the shared frontier, and bodies in addition, directly between GPUs.
    /// Collective.
    template <class Numbers, int... D>
    void exchange(Direct const& direct, Numbers const& numbers,
                  BodyExchange<D> const&... beside) const {
        exchange(direct, numbers, along(beside...), kernels::Nothing{});
    }
    /// Performs both passes of a sweep over a tree that ranks share, with the exchange between them
    /// in one launch. Returns false, and does nothing, if one launch is not enough.
    template <class Sweep>
    bool shared_passes(Direct const& direct, typename Sweep::ShownNumbers const& numbers,
                       Tree const& tree, Tree const& top, Sweep const& sweep) const {
        return shared_passes_by(
            kernels::ExchangeByBlock<typename Sweep::ShownNumbers>{direct, numbers, {}}, tree, top,
            sweep);
    }
    /// Performs the same for a scan.
    template <class Numbers, class Scan, int... D>
    bool shared_passes(Direct const& direct, Numbers const& numbers, ScanTree const& tree,
                       ScanTree const& top, Scan const& scan,
                       BodyExchange<D> const&... beside) const {
        return shared_passes_by(
            kernels::ExchangeByBlock<Numbers>{direct, numbers, along(beside...)}, tree, top, scan);
    }
    /// Returns the time of one action, s, for each of `repeat` repetitions of `chained` consecutive
    /// actions. They are launched as one CUDA graph, unless the action involves the host
    /// (`asks_host`).
    template <class Action>
    std::vector<double> time_chained(int chained, int repeat, bool asks_host,
                                     Action const& action) const {
        auto const all = [&] {
            for (int i = 0; i < chained; ++i) action();
        };
        if (peers_) peers_.meet_next(shared_stream());
        std::optional<Graph> graph;
        if (!asks_host) graph.emplace(stream(), all);
        Event start(Event::For::clock), end(Event::For::clock);
        std::vector<double> seconds;
        for (int r = -1; r < repeat; ++r) {  // repetition -1 is a warm-up
            start.record(stream());
            graph ? graph->launch(stream()) : all();
            end.record(stream());
            end.wait();
            if (r >= 0) seconds.push_back(end.seconds_since(start) / chained);
        }
        return seconds;
    }
    /// The host's thread that drives the GPU.
    int threads() const { return 1; }

  private:
    /// Largest number of items for which threads remain idle.
    static constexpr std::int64_t most_items_with_threads_to_spare = 16384;
    /// Enqueues the kernel of a direct exchange, ordered after other exchanges.
    template <class Numbers, class First>
    void exchange(Direct const& direct, Numbers const& numbers, kernels::BodiesBeside const& beside,
                  First const& first) const {
        peers_.meet_next(shared_stream());
        kernels::exchange<<<1, kernels::threads_of_exchange, 0, stream()>>>(direct, numbers, beside,
                                                                            first);
        started();
    }
    /// Returns the description of bodies that are sent together with the frontier's numbers.
    template <int... D>
    static kernels::BodiesBeside along(BodyExchange<D> const&... beside) {
        static_assert(sizeof...(D) <= kernels::BodiesBeside::most);
        kernels::BodiesBeside all;
        (all.add(beside ? D : 0, beside.source, numbers_of(beside)), ...);
        return all;
    }
    /// Returns the addresses of a body's numbers that are sent and received.
    template <int D>
    static kernels::BodyNumbers numbers_of(BodyExchange<D> const& e) {
        return {number_of(e.from, e.i), number_of(e.into, e.j)};
    }
    /// Throws ComputationError if the last launch failed.
    static void started() { check(cudaGetLastError(), "start a kernel"); }
    /// Performs both passes of a sweep or a scan with `exchange`, ordered after other exchanges.
    template <class AnyTree, class Sweep, class Numbers>
    bool shared_passes_by(kernels::ExchangeByBlock<Numbers> const& exchange, AnyTree const& tree,
                          AnyTree const& top, Sweep const& sweep) const {
        return tree.shared_passes(sweep, ExchangeInTurn<Numbers>{peers_, shared_stream(), exchange},
                                  top, stream());
    }

    /// Executor of the work that remains on the host.
    Executor const* on_host_;
    /// Direct connections to other ranks' GPUs; none by default.
    Peers peers_;
};

}  // namespace catena::cuda
