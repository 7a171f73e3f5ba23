// A sweep's stages (dca/stages.hpp) on a GPU. A host compiler takes it too, where tests/support/cuda_on_host.hpp stands before it.
#pragma once

#include "dca/stages.hpp"
#include "dca/tree_sweeps.hpp"

namespace catena::cuda::kernels {

constexpr int threads = 128;  // that many find registers for merges of every K

/// A stage of a sweep (dca/stages.hpp) on a device.
struct DeviceStage {
    unsigned blocks = 0;
    int levels = 0;
    int width = 0, forces = 0;
    dca::Run const* runs = nullptr;  // the items; null where they are none
    dca::StageItem const* items = nullptr;
    dca::StageMerge const* merges = nullptr;
    dca::StageRoot const* roots = nullptr;
    dca::Handed const *segments_up = nullptr, *forces_down = nullptr;
    dca::Range const *item = nullptr, *merge = nullptr, *root = nullptr, *up = nullptr, *down = nullptr;  // of every block
};

__device__ inline std::int64_t thread() { return static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x; }

template <class Sweep>
constexpr int threads_of = dca::stage_threads(Sweep::Sweeps::K);

extern __shared__ double shared_numbers[];

/// Records in a block's shared memory, number after number: neither neighbouring threads nor those a power of two apart meet in a bank.
template <class T>
struct SharedRecords {
    static constexpr int numbers = static_cast<int>(sizeof(T) / sizeof(double));
    static constexpr __host__ __device__ int pitch_for(int count) { return count + count / 16 + 1; }
    static constexpr __host__ __device__ std::size_t size(int count) { return static_cast<std::size_t>(numbers) * pitch_for(count); }
    double* origin;
    int pitch;
    __device__ void store(int i, T const& record) const {
        auto const values = __builtin_bit_cast(Numbers, record);
        double* const first = origin + i + i / 16;
        CATENA_UNROLL
        for (int n = 0; n < numbers; ++n) first[n * pitch] = values[n];
    }
    __device__ T load(int i) const {
        Numbers values;
        double const* const first = origin + i + i / 16;
        CATENA_UNROLL
        for (int n = 0; n < numbers; ++n) values[n] = first[n * pitch];
        return __builtin_bit_cast(T, values);
    }

  private:
    using Numbers = Vector<double, numbers>;
};

/// Thread t of a block does part t / lanes mod parts of run t mod lanes of the block's t / (lanes parts)-th group of `lanes` runs: a
/// warp's threads walk side by side.
struct RunPart {
    std::int64_t run;
    int part;
    __device__ RunPart(std::int64_t thread, int lanes)
        : run(thread / (lanes * dca::parts_of_run) * lanes + thread % lanes), part(static_cast<int>(thread / lanes % dca::parts_of_run)) {}
};
__device__ inline int lanes_of_block() {
    int const of_part = static_cast<int>(blockDim.x) / dca::parts_of_run;
    return of_part < 32 ? of_part : 32;
}

/// The segments of runs `first` + RunPart(...).run, as many as the block's threads do at once: take(run, segment) by one thread each. All
/// threads of a block must come here; `memory`: for a segment a thread.
template <class Sweep, class Take>
__device__ void climb_some_runs(dca::Run const* runs, std::int64_t first, std::int64_t end, Sweep const& sweep, double* memory,
                                Take const& take) {
    using Segment = typename Sweep::Segment;
    SharedRecords<Segment> const parts{memory, SharedRecords<Segment>::pitch_for(static_cast<int>(blockDim.x))};
    int const lanes = lanes_of_block();
    RunPart const mine(threadIdx.x, lanes);
    std::int64_t const i = first + mine.run;
    dca::Run run;
    if (i < end) run = runs[i];
    int const count = i < end ? dca::parts_of(run) : 0;
    Segment segment;
    if (mine.part < count) segment = sweep.part(run, mine.part);
    if (mine.part > 0 && mine.part < count) parts.store(static_cast<int>(threadIdx.x), segment);
    __syncthreads();
    if (mine.part == 0 && count > 0) {
        CATENA_NO_UNROLL
        for (int p = 1; p < count; ++p)
            segment = sweep.joined(segment, parts.load(static_cast<int>(threadIdx.x) + lanes * p), dca::begin_of(run, p));
        take(i, segment);
    }
    __syncthreads();
}

/// action(i) for a block's i of a range.
template <class Action>
__device__ void each_of(dca::Range const& range, Action const& action) {
    for (std::int64_t i = range.begin + threadIdx.x; i < range.end; i += blockDim.x) action(i);
}

/// A block's part of a stage, in its shared memory: its merges, which are read once, and the segments and forces at its places. A sweep
/// that keeps nodes has those there as well, each in the place of the outboard segment that it was made of.
template <class Sweep>
class BlockOfStage {
    using Segment = typename Sweep::Segment;
    using Directions = typename Sweep::Sweeps::Directions;
    using Node = typename Sweep::Sweeps::Node;
    using Segments = SharedRecords<Segment>;
    using Forces = SharedRecords<Directions>;
    static_assert(!Sweep::keeps_nodes || sizeof(Node) <= sizeof(Segment));
    static_assert(sizeof(dca::StageMerge) == 3 * sizeof(double));

  public:
    /// Numbers that it needs, of `threads` threads.
    static __host__ __device__ int size(DeviceStage const& stage, int of_threads) {
        return before_parts(stage) + (stage.runs ? static_cast<int>(Segments::size(of_threads)) : 0);
    }
    __device__ BlockOfStage(DeviceStage const& stage, Sweep const& sweep, double* memory)
        : stage_(stage),
          sweep_(sweep),
          items_(stage.item[blockIdx.x]),
          up_(stage.up[blockIdx.x]),
          down_(stage.down[blockIdx.x]),
          root_(stage.root[blockIdx.x]),
          segments_{memory, Segments::pitch_for(stage.width)},
          nodes_{memory, segments_.pitch},
          forces_{memory + Segments::size(stage.width), Forces::pitch_for(stage.forces)},
          merges_(reinterpret_cast<dca::StageMerge*>(forces_.origin + Forces::size(stage.forces))),
          level_end_(reinterpret_cast<int*>(merges_ + stage.width)),
          parts_(memory + before_parts(stage)) {}
    /// First of all.
    __device__ void take_merges() const {
        dca::Range const* const levels = stage_.merge + static_cast<std::int64_t>(blockIdx.x) * stage_.levels;
        if (stage_.levels == 0) return;
        std::int64_t const begin = levels[0].begin, end = levels[stage_.levels - 1].end;
        for (auto l = static_cast<int>(threadIdx.x); l < stage_.levels; l += static_cast<int>(blockDim.x))
            level_end_[l] = static_cast<int>(levels[l].end - begin);
        each_of({begin, end}, [&](std::int64_t i) { merges_[i - begin] = stage_.merges[i]; });
    }

    __device__ void climb() const {
        take_items();
        CATENA_NO_UNROLL
        for (int l = 0; l < stage_.levels; ++l) {
            __syncthreads();
            each_merge(l, [&](dca::StageMerge const& m) {
                Segment const inboard = segments_.load(m.inboard), outboard = segments_.load(m.outboard);
                if constexpr (Sweep::keeps_nodes) {
                    Node node;
                    segments_.store(m.inboard, sweep_.joined(inboard, outboard, m.joint, node));
                    nodes_.store(m.outboard, node);
                } else {
                    segments_.store(m.inboard, sweep_.joined(inboard, outboard, m.joint));
                }
            });
        }
        __syncthreads();
        each_of(up_, [&](std::int64_t i) {
            dca::Handed const up = stage_.segments_up[i];
            sweep_.store(up.at, segments_.load(up.place));
        });
        each_of(root_, [&](std::int64_t i) {
            dca::StageRoot const closed = stage_.roots[i];
            sweep_.close(closed.root, segments_.load(closed.place));
        });
    }
    /// Between a climb and a descent of their own.
    __device__ void put_nodes() const {
        if constexpr (Sweep::keeps_nodes) each_merge([&](dca::StageMerge const& m) { sweep_.keep(m.joint, nodes_.load(m.outboard)); });
    }
    __device__ void take_nodes() const {
        __syncthreads();
        if constexpr (Sweep::keeps_nodes) each_merge([&](dca::StageMerge const& m) { nodes_.store(m.outboard, sweep_.node(m.joint)); });
    }
    __device__ void descend() const {
        each_of(down_, [&](std::int64_t i) {
            dca::Handed const down = stage_.forces_down[i];
            forces_.store(down.place, sweep_.s.forces.load(down.at));
        });
        CATENA_NO_UNROLL
        for (int l = stage_.levels - 1; l >= 0; --l) {
            __syncthreads();
            each_merge(l, [&](dca::StageMerge const& m) {
                Node node;
                if constexpr (Sweep::keeps_nodes)
                    node = nodes_.load(m.outboard);
                else
                    node = sweep_.node(m.joint);
                forces_.store(m.outboard, sweep_.force(node, forces_.load(m.inboard), forces_.load(m.next)));
            });
        }
        __syncthreads();
        if (stage_.runs)
            descend_runs();
        else
            each_of(items_, [&](std::int64_t i) {
                if (dca::StageItem const item = stage_.items[i]; !item.given) sweep_.s.forces.store(item.joint, forces_.load(place_of_item(i)));
            });
    }

  private:
    static __host__ __device__ int before_parts(DeviceStage const& stage) {
        return static_cast<int>(Segments::size(stage.width) + Forces::size(stage.forces)) + 3 * stage.width + (stage.levels + 1) / 2;
    }
    __device__ int place_of_item(std::int64_t i) const { return static_cast<int>(i - items_.begin); }
    template <class Action>
    __device__ void each_merge(int level, Action const& action) const {
        CATENA_NO_UNROLL
        for (int i = (level == 0 ? 0 : level_end_[level - 1]) + static_cast<int>(threadIdx.x); i < level_end_[level];
             i += static_cast<int>(blockDim.x))
            action(merges_[i]);
    }
    template <class Action>
    __device__ void each_merge(Action const& action) const {
        if (stage_.levels == 0) return;
        for (auto i = static_cast<int>(threadIdx.x); i < level_end_[stage_.levels - 1]; i += static_cast<int>(blockDim.x)) action(merges_[i]);
    }
    __device__ void take_items() const {
        if (!stage_.runs)
            return each_of(items_, [&](std::int64_t i) { segments_.store(place_of_item(i), sweep_.load(stage_.items[i].slot)); });
        for (std::int64_t first = items_.begin; first < items_.end; first += blockDim.x / dca::parts_of_run)
            climb_some_runs(stage_.runs, first, items_.end, sweep_, parts_,
                            [&](std::int64_t i, Segment const& segment) { segments_.store(place_of_item(i), segment); });
    }
    __device__ void descend_runs() const {
        int const lanes = lanes_of_block();
        std::int64_t const groups = (items_.end - items_.begin + lanes - 1) / lanes;
        for (std::int64_t t = threadIdx.x; t < lanes * dca::parts_of_run * groups; t += blockDim.x) {
            RunPart const mine(t, lanes);
            std::int64_t const i = items_.begin + mine.run;
            if (i < items_.end)
                descend_part(sweep_, stage_.runs[i], mine.part, forces_.load(static_cast<int>(mine.run)),
                             forces_.load(stage_.items[i].next));
        }
    }

    DeviceStage const& stage_;
    Sweep const& sweep_;
    dca::Range items_, up_, down_, root_;
    Segments segments_;
    SharedRecords<Node> nodes_;
    Forces forces_;
    dca::StageMerge* merges_;
    int* level_end_;
    double* parts_;
};

template <class Sweep>
__global__ void __launch_bounds__(threads_of<Sweep>) climb(DeviceStage stage, Sweep sweep) {
    BlockOfStage<Sweep> const block(stage, sweep, shared_numbers);
    block.take_merges();
    block.climb();
    block.put_nodes();
}
template <class Sweep>
__global__ void __launch_bounds__(threads_of<Sweep>) descend(DeviceStage stage, Sweep sweep) {
    BlockOfStage<Sweep> const block(stage, sweep, shared_numbers);
    block.take_merges();
    block.take_nodes();
    block.descend();
}
constexpr int most_in_cluster = 8;  // any GPU that has clusters takes so many blocks
/// All blocks of a cluster have come here, and see what the others wrote before.
__device__ inline void meet_cluster() {
    __syncthreads();
#if !defined(__CUDACC__)
    sync_cluster();
#elif __CUDA_ARCH__ >= 900  // others are never asked to
    asm volatile("barrier.cluster.arrive.release.aligned;\n\tbarrier.cluster.wait.acquire.aligned;" ::: "memory");
#endif
}
/// Up and down again: two stages, the upper one of one block, by one cluster of blocks, or the lower one alone. The same instructions do
/// both.
template <class Sweep>
__global__ void __launch_bounds__(threads_of<Sweep>) turn(DeviceStage lower, DeviceStage upper, Sweep sweep) {
    double* const memory[] = {shared_numbers, shared_numbers + BlockOfStage<Sweep>::size(lower, static_cast<int>(blockDim.x))};
    CATENA_NO_UNROLL
    for (int up = 0; up < 2; ++up) {
        DeviceStage const stage = up == 0 ? lower : upper;
        if (blockIdx.x < stage.blocks) {
            BlockOfStage<Sweep> const block(stage, sweep, up == 0 ? memory[0] : memory[1]);
            block.take_merges();
            block.climb();
        }
        meet_cluster();
    }
    CATENA_NO_UNROLL
    for (int up = 1; up >= 0; --up) {
        DeviceStage const stage = up == 0 ? lower : upper;
        if (blockIdx.x < stage.blocks) BlockOfStage<Sweep>(stage, sweep, up == 0 ? memory[0] : memory[1]).descend();
        if (up == 1) meet_cluster();
    }
}
/// Blocks of `threads` that share a multiprocessor: links want few registers, and many to hide that memory is far.
template <class Sweep>
constexpr int blocks_at_once = Sweep::Sweeps::K == 1 ? 4 : 1;
template <class Sweep>
__global__ void __launch_bounds__(threads, blocks_at_once<Sweep>) climb_runs(dca::Run const* runs, std::int64_t count, Sweep sweep) {
    climb_some_runs(runs, static_cast<std::int64_t>(blockIdx.x) * (threads / dca::parts_of_run), count, sweep, shared_numbers,
                    [&](std::int64_t i, typename Sweep::Segment const& segment) { sweep.store(runs[i].slot, segment); });
}
template <class Sweep>
__global__ void __launch_bounds__(threads, blocks_at_once<Sweep>) descend_runs(dca::Run const* runs, std::int64_t count, Sweep sweep) {
    if (RunPart const mine(thread(), 32); mine.run < count) {
        dca::Run const run = runs[mine.run];
        descend_part(sweep, run, mine.part, sweep.s.forces.load(run.body), sweep.s.forces.load(run.next));
    }
}

}  // namespace catena::cuda::kernels
