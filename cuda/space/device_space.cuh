// The Space of a GPU (dca/host_space.hpp says what its members promise): a kernel a loop, all on
// one stream.
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
#include "tree/scan_then.hpp"

namespace catena::cuda {

class DeviceSpace {
  public:
    static constexpr bool answers_at_once = false;
    /// Copies share the stream and the places for answers: one thread at a time asks largest() or
    /// get(). The executor must outlive them.
    explicit DeviceSpace(Executor const& on_host)
        : on_host_(&on_host),
          stream_(std::make_shared<Stream>()),
          answer_(std::make_shared<Buffer<unsigned long long>>(1)),
          letter_(std::make_shared<PinnedBuffer<double>>(most_of_a_body)) {}
    /// With ways to other ranks' GPUs, where there are any. Collective.
    DeviceSpace(Executor const& on_host, Communicator const& communicator) : DeviceSpace(on_host) {
        peers_ = Peers(communicator);
    }
    Executor const& on_host() const { return *on_host_; }
    cudaStream_t stream() const { return stream_->get(); }

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
    template <int K>
    static constexpr bool has_blocks = K == 1;
    template <int K>
    static constexpr bool has_teams = has_blocks<K>;
    /// Chains that find their place in one block's registers.
    bool pays_by_blocks(ChainGroup const& group) const {
        return !group.has_tips() &&
               std::all_of(group.pieces.begin(), group.pieces.end(), [](dca::Piece const& piece) {
                   return piece.count <= DeviceBlocks::longest_chain;
               });
    }
    template <class Action>
    void each_block(Blocks const& blocks, Action const& action) const {
        if (blocks.count() == 0) return;
        kernels::
            each_team<<<blocks.count(), static_cast<unsigned>(blocks.threads()),
                        kernels::DeviceTeam<Action::K>::shared_bytes(blocks.threads()), stream()>>>(
                blocks.teams(), action);
        started();
    }
    template <class Action>
    void for_each(std::int64_t count, Action const& action) const {
        if (count == 0) return;
        launch({blocks(gpu_order::padded(count)), kernels::threads}, stream(),
               kernels::for_each<Action>, count, action);
    }
    template <class T, class Action>
    void over(Buffer<T> const& items, Action const& action) const {
        if (items.size() == 0) return;
        auto const count = static_cast<std::int64_t>(items.size());
        launch({blocks(count), kernels::threads}, stream(), kernels::over<T, Action>, items.data(),
               count, action);
    }
    template <class Scan>
    void climb(ScanTree const& tree, Scan const& scan) const {
        tree.climb(scan, stream());
    }
    template <class Scan>
    void descend(ScanTree const& tree, Scan const& scan) const {
        tree.descend(scan, stream());
    }
    template <class Scan>
    void climb_and_descend(ScanTree const& tree, Scan const& scan) const {
        tree.climb_and_descend(scan, stream());
    }
    template <class Scan, class Action>
    void climb_and_descend(ScanTree const& tree, Scan const& scan, std::int64_t count,
                           Action const& action) const {
        if (tree.at_once(scan, count, action, stream())) return;
        climb_and_descend(tree, scan);
        for_each(count, action);
    }
    template <class Scan, class T, class Action>
    void climb_and_descend(ScanTree const& tree, Scan const& scan, Buffer<T> const& items,
                           Action const& action) const {
        auto const count = static_cast<std::int64_t>(items.size());
        if (count > 0 &&
            tree.at_once(scan, count, kernels::OfItem<T, Action>{items.data(), action}, stream()))
            return;
        climb_and_descend(tree, scan);
        over(items, action);
    }
    template <class Sweep>
    void climb(Tree const& tree, Sweep const& sweep) const {
        tree.climb(sweep, stream());
    }
    template <class Sweep>
    void descend(Tree const& tree, Sweep const& sweep) const {
        tree.descend(sweep, stream());
    }
    template <class Sweep>
    void climb_and_descend(Tree const& tree, Sweep const& sweep) const {
        tree.climb_and_descend(sweep, stream());
    }
    static bool has_threads_for_bodies(ScanTree const& tree) {
        return tree.has_threads_for_bodies();
    }
    static bool has_threads_to_spare(std::int64_t items) {
        return items <= most_items_with_threads_to_spare;
    }
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

    template <class T>
    T get(T const* place) const {
        T value;
        check(cudaMemcpyAsync(&value, place, sizeof(T), cudaMemcpyDeviceToHost, stream()),
              "give back a value");
        wait();
        return value;
    }
    template <class T>
    void put(T* place, T const& value) const {
        check(cudaMemcpyAsync(place, &value, sizeof(T), cudaMemcpyHostToDevice, stream()),
              "take a value");
        wait();  // the source may go
    }
    template <int D>
    Vector<double, D> get(ConstView<D> field, std::int64_t k) const {
        static_assert(D <= most_of_a_body);
        for_each(D, kernels::TakeBody{number_of(field, k), letter_->data()});
        wait();
        Vector<double, D> value;
        std::copy_n(letter_->data(), D, value.data);
        return value;
    }
    template <int D>
    void put(View<D> field, std::int64_t k, Vector<double, D> const& value) const {
        for_each(D, kernels::PutBody<D>{number_of(field, k), value});
    }
    template <int D>
    void exchange(Communicator const& communicator, BodyExchange<D> const& e) const {
        exchange(communicator, e, kernels::Nothing{});
    }
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
    using Direct = PeerCall;
    Direct connect(dca::Schedule const& schedule, int width, int beside) const {
        return peers_.among_all(schedule, width, beside);
    }
    template <class Numbers, int... D>
    void exchange(Direct const& direct, Numbers const& numbers,
                  BodyExchange<D> const&... beside) const {
        exchange(direct, numbers, along(beside...), kernels::Nothing{});
    }
    template <class Sweep>
    bool turn_shared(Direct const& direct, typename Sweep::ShownNumbers const& numbers,
                     Tree const& tree, Tree const& top, Sweep const& sweep) const {
        return turn_shared_by(
            kernels::ExchangeByBlock<typename Sweep::ShownNumbers>{direct, numbers, {}}, tree, top,
            sweep);
    }
    template <class Numbers, class Scan, int... D>
    bool turn_shared(Direct const& direct, Numbers const& numbers, ScanTree const& tree,
                     ScanTree const& top, Scan const& scan,
                     BodyExchange<D> const&... beside) const {
        return turn_shared_by(kernels::ExchangeByBlock<Numbers>{direct, numbers, along(beside...)},
                              tree, top, scan);
    }
    template <class Numbers, class Scan, class T, class Action, int... D>
    bool turn_shared(Direct const& direct, Numbers const& numbers, ScanTree const& tree,
                     ScanTree const& top, dca::ScanThen<Scan, Buffer<T>, Action> const& all,
                     BodyExchange<D> const&... beside) const {
        ExchangeInTurn<Numbers> const exchange{
            peers_, stream_, {direct, numbers, along(beside...)}};
        kernels::OfItem<T, Action> const action{all.items.data(), all.action};
        return tree.turn_shared(all.scan, exchange, top,
                                static_cast<std::int64_t>(all.items.size()), action, stream());
    }
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
    void write(DeviceDirections& directions, DirectionsField const& host) const {
        directions.upload(host.view(), stream());
        wait();
    }
    template <int D, class Edit>
    void edit(DeviceField<D>& field, Edit const& change) const {
        give_back(field, read(field), change);
    }
    template <int D, class Set>
    void set(DeviceField<D>& field, Set const& all) const {
        give_back(field, Field<D>(field.size()), all);
    }
    template <int D>
    struct Mirror {
        Field<D> field;
        PinnedPages pages = {};  // of the field
    };
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
    template <int D>
    void push(DeviceField<D>& field, Mirror<D> const& mirror) const {
        field.upload(mirror.field.view(), stream());
    }

    /// As one graph, unless the host has a part in it.
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
        for (int r = -1; r < repeat; ++r) {  // the first one warms up
            start.record(stream());
            graph ? graph->launch(stream()) : all();
            end.record(stream());
            end.wait();
            if (r >= 0) seconds.push_back(end.seconds_since(start) / chained);
        }
        return seconds;
    }
    void wait() const { stream_->wait(); }
    int threads() const { return 1; }

  private:
    static constexpr std::int64_t most_items_with_threads_to_spare = 16384;
    /// Where body k's first one stands in the GPU's memory.
    template <class Real, int D>
    static Real* number_of(FieldView<Real, D> const& field, std::int64_t k) {
        return field.origin + gpu_order::first_number(k, field.pitch);
    }
    template <class Numbers, class First>
    void exchange(Direct const& direct, Numbers const& numbers, kernels::BodiesBeside const& beside,
                  First const& first) const {
        peers_.meet_next(stream_);
        kernels::exchange<<<1, kernels::threads_of_exchange, 0, stream()>>>(direct, numbers, beside,
                                                                            first);
        started();
    }
    template <int... D>
    static kernels::BodiesBeside along(BodyExchange<D> const&... beside) {
        static_assert(sizeof...(D) <= kernels::BodiesBeside::most);
        kernels::BodiesBeside all;
        (all.add(beside ? D : 0, beside.source, numbers_of(beside)), ...);
        return all;
    }
    template <int D>
    static kernels::BodyNumbers numbers_of(BodyExchange<D> const& e) {
        return {number_of(e.from, e.i), number_of(e.into, e.j)};
    }
    static unsigned blocks(std::int64_t count) {
        return static_cast<unsigned>((count + kernels::threads - 1) / kernels::threads);
    }
    void set_answer(int byte) const {
        check(cudaMemsetAsync(answer_->data(), byte, sizeof(unsigned long long), stream()),
              "be asked");
    }
    template <int D, class Change>
    void give_back(DeviceField<D>& field, Field<D> host, Change const& change) const {
        change(host.view());
        field.upload(std::as_const(host).view(), stream());
        wait();
    }
    static void started() { check(cudaGetLastError(), "start a kernel"); }
    template <class AnyTree, class Sweep, class Numbers>
    bool turn_shared_by(kernels::ExchangeByBlock<Numbers> const& exchange, AnyTree const& tree,
                        AnyTree const& top, Sweep const& sweep) const {
        return tree.turn_shared(sweep, ExchangeInTurn<Numbers>{peers_, stream_, exchange}, top,
                                stream());
    }

    Executor const* on_host_;
    std::shared_ptr<Stream> stream_;
    std::shared_ptr<Buffer<unsigned long long>> answer_;  // of largest()
    std::shared_ptr<PinnedBuffer<double>> letter_;        // of get()
    Peers peers_;
};

}  // namespace catena::cuda
