// The Space of a GPU: one kernel per loop, all on one stream. Its members behave as
// dca/host_space.hpp specifies.
#pragma once

#include <algorithm>
#include <cstring>
#include <memory>
#include <optional>

#include "cuda/device/launch.cuh"
#include "cuda/exchange/peer_exchange.cuh"
#include "cuda/space/device_blocks.cuh"
#include "cuda/space/device_model.cuh"
#include "cuda/space/device_records.cuh"
#include "cuda/space/device_scan.cuh"
#include "cuda/space/device_tree.cuh"
#include "cuda/space/kernels.cuh"
#include "dca/host_space.hpp"

namespace catena::cuda {

/// Space whose arrays are in the memory of the current GPU.
class DeviceSpace : public SharedModels<DeviceModel, ModelArrays> {
  public:
    /// Loops return before they are complete; wait() waits for them.
    static constexpr bool answers_at_once = false;
    /// Makes a space with a stream of its own. Copies share the stream and the memory for answers,
    /// so that only one thread at a time may call largest() or get(). The executor must outlive all
    /// copies.
    explicit DeviceSpace(Executor const& on_host)
        : on_host_(&on_host),
          stream_(std::make_shared<Stream>()),
          answer_(std::make_shared<Buffer<unsigned long long>>(1)),
          letter_(std::make_shared<PinnedBuffer<double>>(most_of_a_body)) {}
    /// Makes a space with direct connections to other ranks' GPUs, if possible. Collective.
    DeviceSpace(Executor const& on_host, Communicator const& communicator) : DeviceSpace(on_host) {
        peers_ = Peers(communicator);
    }
    /// Returns the executor of the work that remains on the host.
    Executor const& on_host() const { return *on_host_; }
    cudaStream_t stream() const { return stream_->get(); }

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
    /// Calls action(k) for k < count.
    template <class Action>
    void for_each(std::int64_t count, Action const& action) const {
        if (count == 0) return;
        launch({blocks(gpu_order::padded(count)), kernels::threads}, stream(),
               kernels::for_each<Action>, count, action);
    }
    /// Calls action(item) for each item.
    template <class T, class Action>
    void over(Buffer<T> const& items, Action const& action) const {
        if (items.size() == 0) return;
        auto const count = static_cast<std::int64_t>(items.size());
        launch({blocks(count), kernels::threads}, stream(), kernels::over<T, Action>, items.data(),
               count, action);
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
    /// Returns the largest |value(i)|, i < count, or NaN if a value is NaN. Waits.
    template <class Value>
    double largest(std::int64_t count, Value const& value) const {
        if (count == 0) return 0;
        set_answer(0);
        launch({blocks(count), kernels::threads}, stream(), kernels::largest<Value>, count,
               answer_->data(), value);
        unsigned long long const bits = get(answer_->data());
        double found;
        std::memcpy(&found, &bits, sizeof(found));
        return found;
    }

    /// Returns the value at `place` in the GPU's memory. Waits.
    template <class T>
    T get(T const* place) const {
        T value;
        check(cudaMemcpyAsync(&value, place, sizeof(T), cudaMemcpyDeviceToHost, stream()),
              "return a value");
        wait();
        return value;
    }
    /// Writes a value to `place` in the GPU's memory. Waits.
    template <class T>
    void put(T* place, T const& value) const {
        check(cudaMemcpyAsync(place, &value, sizeof(T), cudaMemcpyHostToDevice, stream()),
              "receive a value");
        wait();  // `value` may go out of scope
    }
    /// Returns the numbers of body k. Waits.
    template <int D>
    Vector<double, D> get(ConstView<D> field, std::int64_t k) const {
        static_assert(D <= most_of_a_body);
        for_each(D, kernels::TakeBody{number_of(field, k), letter_->data()});
        wait();
        Vector<double, D> value;
        std::copy_n(letter_->data(), D, value.data);
        return value;
    }
    /// Writes the numbers of body k.
    template <int D>
    void put(View<D> field, std::int64_t k, Vector<double, D> const& value) const {
        for_each(D, kernels::PutBody<D>{number_of(field, k), value});
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
    /// Returns a copy of the field on the host. Waits.
    template <int D>
    Field<D> read(DeviceField<D> const& field) const {
        Field<D> host(field.size());
        field.download(host.view(), stream());
        wait();
        return host;
    }
    DirectionsField read(DeviceDirections const& directions) const {
        DirectionsField host(directions.size(), directions.directions());
        directions.download(host.view(), stream());
        wait();
        return host;
    }
    /// Overwrites the field with the host's values. Waits.
    void write(DeviceDirections& directions, DirectionsField const& host) const {
        directions.upload(host.view(), stream());
        wait();
    }
    /// Calls change(view) on a host copy of the field and writes it back. Waits.
    template <int D, class Edit>
    void edit(DeviceField<D>& field, Edit const& change) const {
        give_back(field, read(field), change);
    }
    /// Calls all(view) on a field of zeros on the host and writes it to the GPU. Waits.
    template <int D, class Set>
    void set(DeviceField<D>& field, Set const& all) const {
        give_back(field, Field<D>(field.size()), all);
    }
    /// Host copy of a field, in pinned memory if it is large.
    template <int D>
    struct Mirror {
        Field<D> field;
        PinnedPages pages = {};  // pins the field's memory
    };
    /// Copies the field to its mirror and returns the mirror's view. Waits.
    template <int D>
    View<D> pull(DeviceField<D>& field, Mirror<D>& mirror) const {
        if (mirror.field.size() != field.size()) {
            mirror.pages = PinnedPages();
            mirror.field = Field<D>(field.size());
            mirror.pages = PinnedPages(mirror.field.storage());
        }
        field.download(mirror.field.view(), stream());
        wait();
        return mirror.field.view();
    }
    /// Enqueues the copy of the mirror to the field.
    template <int D>
    void push(DeviceField<D>& field, Mirror<D> const& mirror) const {
        field.upload(mirror.field.view(), stream());
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
        if (peers_) peers_.meet_next(stream_);
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
    /// Waits until all work of the stream is complete.
    void wait() const { stream_->wait(); }
    /// The host's thread that drives the GPU.
    int threads() const { return 1; }

  private:
    /// Largest number of items for which threads remain idle.
    static constexpr std::int64_t most_items_with_threads_to_spare = 16384;
    /// Returns the address of body k's first number in the GPU's memory.
    template <class Real, int D>
    static Real* number_of(FieldView<Real, D> const& field, std::int64_t k) {
        return field.origin + gpu_order::first_number(k, field.pitch);
    }
    /// Enqueues the kernel of a direct exchange, ordered after other exchanges.
    template <class Numbers, class First>
    void exchange(Direct const& direct, Numbers const& numbers, kernels::BodiesBeside const& beside,
                  First const& first) const {
        peers_.meet_next(stream_);
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
    /// Returns the number of blocks for `count` threads.
    static unsigned blocks(std::int64_t count) {
        return static_cast<unsigned>((count + kernels::threads - 1) / kernels::threads);
    }
    /// Sets all bytes of the answer to `byte`.
    void set_answer(int byte) const {
        check(cudaMemsetAsync(answer_->data(), byte, sizeof(unsigned long long), stream()),
              "be queried");
    }
    /// Applies `change` to a host field and uploads it.
    template <int D, class Change>
    void give_back(DeviceField<D>& field, Field<D> host, Change const& change) const {
        change(host.view());
        field.upload(std::as_const(host).view(), stream());
        wait();
    }
    /// Throws ComputationError if the last launch failed.
    static void started() { check(cudaGetLastError(), "start a kernel"); }
    /// Performs both passes of a sweep or a scan with `exchange`, ordered after other exchanges.
    template <class AnyTree, class Sweep, class Numbers>
    bool shared_passes_by(kernels::ExchangeByBlock<Numbers> const& exchange, AnyTree const& tree,
                          AnyTree const& top, Sweep const& sweep) const {
        return tree.shared_passes(sweep, ExchangeInTurn<Numbers>{peers_, stream_, exchange}, top,
                                  stream());
    }

    /// Executor of the work that remains on the host.
    Executor const* on_host_;
    std::shared_ptr<Stream> stream_;
    std::shared_ptr<Buffer<unsigned long long>> answer_;  // memory for the answer of largest()
    std::shared_ptr<PinnedBuffer<double>> letter_;        // memory for the answer of get()
    /// Direct connections to other ranks' GPUs; none by default.
    Peers peers_;
};

}  // namespace catena::cuda
