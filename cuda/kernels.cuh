// What runs on a GPU for DeviceSpace: loops, answers, and a sweep's stages. A launcher indexes, loads, calls and stores; the mathematics
// is in dca/.
#pragma once

#include "cuda/device_field.cuh"
#include "dca/stages.hpp"
#include "dca/tree_sweeps.hpp"

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

}  // namespace catena::cuda
