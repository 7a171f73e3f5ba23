// The Space of a GPU (dca/host_space.hpp says what its members promise): a kernel a loop, all on one stream.
#pragma once

#include <algorithm>
#include <cstring>
#include <memory>

#include "cuda/device_model.cuh"
#include "dca/host_space.hpp"
#include "dca/stages.hpp"

namespace catena::cuda {

namespace kernels {

constexpr int threads = 128;  // that many find registers for merges of every K

/// A stage of a sweep (dca/stages.hpp), and where its items are.
struct DeviceStage {
    int levels = 0;
    dca::Range const *run = nullptr, *merge = nullptr, *root = nullptr;  // `run`: null where there are none
    dca::Run const* runs = nullptr;
    dca::Merge const* merges = nullptr;
    dca::Root const* roots = nullptr;
};

__device__ inline std::int64_t thread() { return static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x; }

/// Neighbouring threads at neighbouring places.
template <class Action>
__global__ void for_each(std::int64_t count, Action action) {
    if (std::int64_t const k = gpu_order::body(thread()); k < count) action(k);
}
template <class Item, class Action>
__global__ void over(Item const* items, std::int64_t count, Action action) {
    if (std::int64_t const i = thread(); i < count) action(items[i]);
}

constexpr int most_in_one_block = 256;
/// Levels that fit into one block each, one after the other: offset[l] to offset[l + 1], from level `first` on in steps of `step`.
template <class Item, class Action>
__global__ void small_levels(Item const* items, std::int64_t const* offset, int first, int count, int step, Action action) {
    for (int l = 0; l < count; ++l) {
        std::int64_t const begin = offset[first + l * step], end = offset[first + l * step + 1];
        if (begin + threadIdx.x < end) action(items[begin + threadIdx.x]);
        __syncthreads();
    }
}

/// Threads of a block that climbs a tree: so many find registers.
constexpr int threads_for(int directions) { return directions <= 3 ? 256 : 128; }
template <class Sweep>
constexpr int threads_of = threads_for(Sweep::Sweeps::K);

/// One record a thread, in a block's shared memory: number after number, so that neighbouring threads do not meet in a bank.
template <class T>
struct SharedRecords {
    static constexpr int numbers = static_cast<int>(sizeof(T) / sizeof(double));
    static constexpr std::size_t bytes(int of_threads) { return numbers * sizeof(double) * static_cast<std::size_t>(of_threads); }
    double* origin;
    __device__ void store(unsigned at, T const& record) const {
        auto const values = __builtin_bit_cast(Numbers, record);
        CATENA_UNROLL
        for (int n = 0; n < numbers; ++n) origin[n * blockDim.x + at] = values[n];
    }
    __device__ T load(unsigned at) const {
        Numbers values;
        CATENA_UNROLL
        for (int n = 0; n < numbers; ++n) values[n] = origin[n * blockDim.x + at];
        return __builtin_bit_cast(T, values);
    }

  private:
    using Numbers = Vector<double, numbers>;
};
extern __shared__ double shared_numbers[];

/// Thread t of a block does part t / 32 mod parts of run t mod 32 of the block's t / (32 parts)-th group of 32: a warp's threads walk
/// side by side.
struct RunPart {
    std::int64_t run;
    int part;
    __device__ explicit RunPart(std::int64_t thread)
        : run(thread / (32 * dca::parts_of_run) * 32 + thread % 32), part(static_cast<int>(thread / 32 % dca::parts_of_run)) {}
};

/// Runs `first` + RunPart(...).run, as many as the block's threads do at once. All threads of a block must come here.
template <class Sweep>
__device__ void climb_some_runs(dca::Run const* runs, std::int64_t first, std::int64_t end, Sweep const& sweep) {
    SharedRecords<typename Sweep::Segment> const parts{shared_numbers};
    RunPart const mine(threadIdx.x);
    std::int64_t const i = first + mine.run;
    dca::Run run;
    if (i < end) run = runs[i];
    int const count = i < end ? dca::parts_of(run) : 0;
    typename Sweep::Segment segment;
    if (mine.part < count) segment = sweep.part(run, mine.part);
    if (mine.part > 0 && mine.part < count) parts.store(threadIdx.x, segment);
    __syncthreads();
    if (mine.part == 0 && count > 0) {
        for (int p = 1; p < count; ++p) segment = sweep.joined(segment, parts.load(threadIdx.x + 32 * p), dca::begin_of(run, p));
        sweep.store(run.slot, segment);
    }
    __syncthreads();
}

/// What a thread has of a level, fetched before the level is reached.
template <class Item>
struct Ahead {
    dca::Range range;
    Item item;
    __device__ Ahead(dca::Range const* ranges, int level, Item const* items) : range{0, 0} {
        if (level < 0) return;
        range = ranges[level];
        if (std::int64_t const i = range.begin + threadIdx.x; i < range.end) item = items[i];
    }
    template <class Action>
    __device__ void each(Item const* items, Action const& action) const {
        std::int64_t i = range.begin + threadIdx.x;
        if (i < range.end) action(item);
        for (i += blockDim.x; i < range.end; i += blockDim.x) action(items[i]);
    }
};

template <class Sweep>
__device__ void climb_stage(DeviceStage const& stage, Sweep const& sweep) {
    dca::Range const* const levels = stage.merge + blockIdx.x * stage.levels;
    if (stage.run) {
        dca::Range const runs = stage.run[blockIdx.x];
        for (std::int64_t first = runs.begin; first < runs.end; first += blockDim.x / dca::parts_of_run)
            climb_some_runs(stage.runs, first, runs.end, sweep);
    }
    Ahead<dca::Merge> next(levels, stage.levels > 0 ? 0 : -1, stage.merges);
    for (int l = 0; l < stage.levels; ++l) {
        Ahead<dca::Merge> const now = next;
        next = Ahead<dca::Merge>(levels, l + 1 < stage.levels ? l + 1 : -1, stage.merges);
        __syncthreads();
        now.each(stage.merges, [&](dca::Merge const& m) { climb_merge(sweep, m); });
    }
    __syncthreads();
    dca::Range const roots = stage.root[blockIdx.x];
    for (std::int64_t i = roots.begin + threadIdx.x; i < roots.end; i += blockDim.x) sweep.close(stage.roots[i]);
}
template <class Sweep>
__device__ void descend_stage(DeviceStage const& stage, Sweep const& sweep) {
    dca::Range const* const levels = stage.merge + blockIdx.x * stage.levels;
    using Node = typename Sweep::Node;
    constexpr bool nodes_ahead = Sweep::Sweeps::K <= 3;  // registers
    Ahead<dca::Merge> next(levels, stage.levels - 1, stage.merges);
    for (int l = stage.levels - 1; l >= 0; --l) {
        Ahead<dca::Merge> const now = next;
        next = Ahead<dca::Merge>(levels, l - 1, stage.merges);
        if constexpr (nodes_ahead) {
            Node node;
            if (now.range.begin + threadIdx.x < now.range.end) node = sweep.node(now.item.joint);
            __syncthreads();
            if (now.range.begin + threadIdx.x < now.range.end) descend_merge(sweep, now.item, node);
            for (std::int64_t i = now.range.begin + threadIdx.x + blockDim.x; i < now.range.end; i += blockDim.x)
                descend_merge(sweep, stage.merges[i], sweep.node(stage.merges[i].joint));
        } else {
            __syncthreads();
            now.each(stage.merges, [&](dca::Merge const& m) { descend_merge(sweep, m, sweep.node(m.joint)); });
        }
    }
    if (!stage.run) return;
    __syncthreads();
    dca::Range const runs = stage.run[blockIdx.x];
    std::int64_t const tiles = (runs.end - runs.begin + 31) / 32;
    for (std::int64_t t = threadIdx.x; t < 32 * dca::parts_of_run * tiles; t += blockDim.x)
        if (RunPart const mine(t); runs.begin + mine.run < runs.end) descend_part(sweep, stage.runs[runs.begin + mine.run], mine.part);
}
template <class Sweep>
__global__ void __launch_bounds__(threads_of<Sweep>) climb(DeviceStage stage, Sweep sweep) {
    climb_stage(stage, sweep);
}
template <class Sweep>
__global__ void __launch_bounds__(threads_of<Sweep>) descend(DeviceStage stage, Sweep sweep) {
    descend_stage(stage, sweep);
}
template <class Sweep>
__global__ void __launch_bounds__(threads_of<Sweep>) turn(DeviceStage stage, Sweep sweep) {
    climb_stage(stage, sweep);
    __syncthreads();
    descend_stage(stage, sweep);
}
template <class Sweep>
__global__ void __launch_bounds__(threads) climb_runs(dca::Run const* runs, std::int64_t count, Sweep sweep) {
    climb_some_runs(runs, static_cast<std::int64_t>(blockIdx.x) * (threads / dca::parts_of_run), count, sweep);
}
template <class Sweep>
__global__ void __launch_bounds__(threads) descend_runs(dca::Run const* runs, std::int64_t count, Sweep sweep) {
    if (RunPart const mine(thread()); mine.run < count) descend_part(sweep, runs[mine.run], mine.part);
}

template <class Predicate>
__global__ void first_that(std::int64_t count, unsigned long long* found, Predicate predicate) {
    if (std::int64_t const i = thread(); i < count && predicate(i)) atomicMin(found, static_cast<unsigned long long>(i));
}
/// Doubles from 0 on have the order of their bits, and a NaN is above them all.
template <class Value>
__global__ void largest(std::int64_t count, unsigned long long* found, Value value) {
    unsigned long long mine = 0;
    if (std::int64_t const i = thread(); i < count) mine = static_cast<unsigned long long>(__double_as_longlong(fabs(value(i))));
    for (int lane = 16; lane > 0; lane /= 2) {
        unsigned long long const other = __shfl_down_sync(0xffffffffu, mine, lane);
        mine = other > mine ? other : mine;
    }
    if (threadIdx.x % 32 == 0 && mine > 0) atomicMax(found, mine);
}

}  // namespace kernels

class DeviceSpace {
  public:
    static constexpr bool answers_at_once = false;
    /// Copies share the stream and the place for answers: one thread at a time asks first() or largest().
    DeviceSpace() : stream_(std::make_shared<Stream>()), answer_(std::make_shared<Buffer<unsigned long long>>(1)) {}
    cudaStream_t stream() const { return stream_->get(); }

    template <class T>
    using Array = Buffer<T>;
    template <int D>
    using FieldOf = DeviceField<D>;
    using Directions = DeviceDirections;
    template <class T>
    using List = Buffer<T>;
    template <int D>
    using Fixed = FixedField<D>;
    using Model = DeviceModel;
    template <class T>
    class Levels {
      public:
        explicit Levels(std::vector<std::vector<T>> const& levels) : offset_{0} {
            std::vector<T> all;
            for (std::vector<T> const& level : levels) {
                all.insert(all.end(), level.begin(), level.end());
                offset_.push_back(std::ssize(all));
            }
            items_ = Buffer<T>(all);
            device_offset_ = Buffer<std::int64_t>(offset_);
        }
        int count() const { return static_cast<int>(offset_.size()) - 1; }
        std::int64_t size(int level) const { return offset_[level + 1] - offset_[level]; }
        T const* begin(int level) const { return items_.data() + offset_[level]; }
        T const* items() const { return items_.data(); }
        std::int64_t const* offset() const { return device_offset_.data(); }

      private:
        std::vector<std::int64_t> offset_;
        Buffer<T> items_;
        Buffer<std::int64_t> device_offset_;
    };
    template <class T, dca::Order order>
    class Records {
      public:
        explicit Records(std::int64_t count)
            : pitch_(order == dca::Order::by_body ? gpu_order::padded(count) : (count + 31) / 32 * 32),
              numbers_(static_cast<std::size_t>(pitch_ * dca::RecordsView<T, order>::numbers)) {}
        dca::RecordsView<T, order> view() { return {numbers_.data(), pitch_}; }

      private:
        std::int64_t pitch_;
        Buffer<double> numbers_;
    };
    class Tree {
      public:
        Tree(std::vector<dca::Run> const& runs, std::vector<std::vector<dca::Merge>> const& levels, std::vector<dca::Root> const& roots,
             std::int64_t slots, int directions)
            : runs_(runs) {
            dca::StagePlan const plan = dca::plan_stages(runs, levels, roots, slots, kernels::threads_for(directions));
            std::vector<dca::Merge> all;
            for (auto const& level : levels) all.insert(all.end(), level.begin(), level.end());
            merges_ = Buffer<dca::Merge>(all);
            roots_ = Buffer<dca::Root>(plan.roots);
            runs_apart_ = plan.runs_apart;
            for (dca::Stage const& stage : plan.stages) {
                blocks_.push_back(static_cast<unsigned>(stage.blocks()));
                for (auto const* ranges : {&stage.run, &stage.merge, &stage.root}) ranges_.emplace_back(*ranges);
                auto const* ranges = &ranges_[ranges_.size() - 3];
                stages_.push_back({stage.levels, ranges[0].data(), ranges[1].data(), ranges[2].data(), runs_.data(), merges_.data(), roots_.data()});
            }
        }

      private:
        friend class DeviceSpace;
        Buffer<dca::Run> runs_;
        Buffer<dca::Merge> merges_;
        Buffer<dca::Root> roots_;
        std::vector<Buffer<dca::Range>> ranges_;
        std::vector<kernels::DeviceStage> stages_;
        std::vector<unsigned> blocks_;
        bool runs_apart_ = false;
    };

    template <class Action>
    void for_each(std::int64_t count, Action const& action) const {
        if (count == 0) return;
        kernels::for_each<<<blocks(gpu_order::padded(count)), kernels::threads, 0, stream()>>>(count, action);
        started();
    }
    template <class T, class Action>
    void over(Buffer<T> const& items, Action const& action) const {
        over(items.data(), static_cast<std::int64_t>(items.size()), action);
    }
    template <class T, class Action>
    void climb(Levels<T> const& levels, Action const& action) const {
        for (int l = 0; l < levels.count();) l += some_levels(levels, l, 1, action);
    }
    template <class T, class Action>
    void descend(Levels<T> const& levels, Action const& action) const {
        for (int l = levels.count() - 1; l >= 0;) l -= some_levels(levels, l, -1, action);
    }
    template <class Sweep>
    void climb(Tree const& tree, Sweep const& sweep) const {
        climb_runs(tree, sweep);
        for (std::size_t i = 0; i < tree.stages_.size(); ++i) climb_stage(tree, i, sweep);
    }
    template <class Sweep>
    void descend(Tree const& tree, Sweep const& sweep) const {
        for (std::size_t i = tree.stages_.size(); i-- > 0;) descend_stage(tree, i, sweep);
        descend_runs(tree, sweep);
    }
    template <class Sweep>
    void climb_and_descend(Tree const& tree, Sweep const& sweep) const {
        if (tree.stages_.empty()) return;
        std::size_t const last = tree.stages_.size() - 1;
        climb_runs(tree, sweep);
        for (std::size_t i = 0; i < last; ++i) climb_stage(tree, i, sweep);
        launch(kernels::turn<Sweep>, tree.blocks_[last], kernels::threads_of<Sweep>, sweep, tree.stages_[last], sweep);
        for (std::size_t i = last; i-- > 0;) descend_stage(tree, i, sweep);
        descend_runs(tree, sweep);
    }
    template <class Predicate>
    std::int64_t first(std::int64_t count, Predicate const& predicate) const {
        if (count == 0) return 0;
        set_answer(0xff);  // above every index
        kernels::first_that<<<blocks(count), kernels::threads, 0, stream()>>>(count, answer_->data(), predicate);
        started();
        unsigned long long const found = get(answer_->data());
        return found < static_cast<unsigned long long>(count) ? static_cast<std::int64_t>(found) : count;
    }
    template <class Value>
    double largest(std::int64_t count, Value const& value) const {
        if (count == 0) return 0;
        set_answer(0);
        kernels::largest<<<blocks(count), kernels::threads, 0, stream()>>>(count, answer_->data(), value);
        started();
        unsigned long long const bits = get(answer_->data());
        double found;
        std::memcpy(&found, &bits, sizeof(found));
        return found;
    }

    template <class T>
    T get(T const* place) const {
        T value;
        check(cudaMemcpyAsync(&value, place, sizeof(T), cudaMemcpyDeviceToHost, stream()), "give back a value");
        wait();
        return value;
    }
    template <class T>
    void put(T* place, T const& value) const {
        check(cudaMemcpyAsync(place, &value, sizeof(T), cudaMemcpyHostToDevice, stream()), "take a value");
        wait();  // the source may go
    }
    template <class T>
    T get(dca::RecordsView<T, dca::Order::plain> records, std::int64_t i) const {
        T record;
        copy_columns(reinterpret_cast<double*>(&record), 1, records.origin + i, records.pitch, 1, records.numbers, cudaMemcpyDeviceToHost, stream());
        wait();
        return record;
    }
    template <class T>
    void put(dca::RecordsView<T, dca::Order::plain> records, std::int64_t i, T const& record) const {
        copy_columns(records.origin + i, records.pitch, reinterpret_cast<double const*>(&record), 1, 1, records.numbers, cudaMemcpyHostToDevice, stream());
        wait();
    }
    template <int D>
    Vector<double, D> get(ConstView<D> field, std::int64_t k) const {
        Vector<double, D> value;
        copy_columns(value.data, 1, field.origin + gpu_order::place(k), field.pitch, 1, D, cudaMemcpyDeviceToHost, stream());
        wait();
        return value;
    }
    template <int D>
    void put(View<D> field, std::int64_t k, Vector<double, D> const& value) const {
        copy_columns(field.origin + gpu_order::place(k), field.pitch, value.data, 1, 1, D, cudaMemcpyHostToDevice, stream());
        wait();
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
    template <int D, class Edit>
    void edit(DeviceField<D>& field, Edit const& change) const {
        Field<D> host = read(field);
        change(host.view());
        field.upload(std::as_const(host).view(), stream());
        wait();
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

    /// As one graph.
    template <class Action>
    std::vector<double> time_chained(int chained, int repeat, Action const& action) const {
        Graph const graph(stream(), [&] {
            for (int i = 0; i < chained; ++i) action();
        });
        Event start(Event::For::clock), end(Event::For::clock);
        std::vector<double> seconds;
        for (int r = -1; r < repeat; ++r) {  // the first one warms up
            start.record(stream());
            graph.launch(stream());
            end.record(stream());
            end.wait();
            if (r >= 0) seconds.push_back(end.seconds_since(start) / chained);
        }
        return seconds;
    }
    void wait() const { stream_->wait(); }
    int threads() const { return 1; }

  private:
    static unsigned blocks(std::int64_t count) { return static_cast<unsigned>((count + kernels::threads - 1) / kernels::threads); }
    void set_answer(int byte) const { check(cudaMemsetAsync(answer_->data(), byte, sizeof(unsigned long long), stream()), "be asked"); }
    static void started() { check(cudaGetLastError(), "start a kernel"); }
    template <class T, class Action>
    void over(T const* items, std::int64_t count, Action const& action) const {
        if (count == 0) return;
        kernels::over<<<blocks(count), kernels::threads, 0, stream()>>>(items, count, action);
        started();
    }
    /// Level `first`, or as many from there on (in steps of `step`) as fit into one block each. Returns how many.
    template <class T, class Action>
    int some_levels(Levels<T> const& levels, int first, int step, Action const& action) const {
        int count = 0;
        std::int64_t widest = 0;
        for (int l = first; l >= 0 && l < levels.count() && levels.size(l) <= kernels::most_in_one_block; l += step, ++count)
            widest = std::max(widest, levels.size(l));
        if (count > 0 && widest == 0) return count;  // a rank may have none of a level's items
        if (count < 2) {
            over(levels.begin(first), levels.size(first), action);
            return 1;
        }
        auto const width = static_cast<unsigned>((widest + 31) / 32 * 32);
        kernels::small_levels<<<1, width, 0, stream()>>>(levels.items(), levels.offset(), first, count, step, action);
        started();
        return count;
    }
    /// A kernel whose threads keep a segment each in shared memory.
    template <class... Parameters, class Sweep, class... Arguments>
    void launch(void (*kernel)(Parameters...), unsigned blocks, int threads, Sweep const&, Arguments const&... arguments) const {
        std::size_t const bytes = kernels::SharedRecords<typename Sweep::Segment>::bytes(threads);
        constexpr std::size_t without_asking = 48 << 10;
        if (bytes > without_asking)
            check(cudaFuncSetAttribute(reinterpret_cast<void const*>(kernel), cudaFuncAttributeMaxDynamicSharedMemorySize, static_cast<int>(bytes)),
                  "have enough shared memory");
        kernel<<<blocks, static_cast<unsigned>(threads), bytes, stream()>>>(arguments...);
        started();
    }
    template <class Sweep>
    void climb_stage(Tree const& tree, std::size_t i, Sweep const& sweep) const {
        launch(kernels::climb<Sweep>, tree.blocks_[i], kernels::threads_of<Sweep>, sweep, tree.stages_[i], sweep);
    }
    template <class Sweep>
    void descend_stage(Tree const& tree, std::size_t i, Sweep const& sweep) const {
        kernels::descend<<<tree.blocks_[i], kernels::threads_of<Sweep>, 0, stream()>>>(tree.stages_[i], sweep);
        started();
    }
    template <class Sweep>
    void climb_runs(Tree const& tree, Sweep const& sweep) const {
        if (!tree.runs_apart_) return;
        auto const count = static_cast<std::int64_t>(tree.runs_.size());
        launch(kernels::climb_runs<Sweep>, blocks(count * dca::parts_of_run), kernels::threads, sweep, tree.runs_.data(), count, sweep);
    }
    template <class Sweep>
    void descend_runs(Tree const& tree, Sweep const& sweep) const {
        if (!tree.runs_apart_) return;
        auto const count = static_cast<std::int64_t>(tree.runs_.size());
        kernels::descend_runs<<<blocks((count + 31) / 32 * 32 * dca::parts_of_run), kernels::threads, 0, stream()>>>(tree.runs_.data(), count, sweep);
        started();
    }
    std::shared_ptr<Stream> stream_;
    std::shared_ptr<Buffer<unsigned long long>> answer_;  // of first() and largest()
};

}  // namespace catena::cuda
