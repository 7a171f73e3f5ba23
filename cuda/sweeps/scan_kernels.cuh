// Scans along chains (tree/stages.hpp, plan_scan) on a GPU. A block performs both passes of its
// part of the tree in shared memory. tests/support/cuda_on_host.hpp, included first, makes this
// file compile on the host.
#pragma once

#include <algorithm>

#include "cuda/device/cluster.cuh"
#include "cuda/sweeps/run_parts.cuh"
#include "cuda/sweeps/runs_view.hpp"
#include "tree/stages.hpp"

namespace catena::cuda::kernels {

using dca::most_of_scan;

/// Stage of a scan on a device.
struct DeviceScanStage {
    unsigned blocks = 0;
    int levels = 0, width = 0;           // `width`: most items of a block
    RunsView runs = {};                  // the items; empty if the items are stored values
    std::int32_t const* slot = nullptr;  // slot of every item
    dca::ScanMerge const* merges = nullptr;
    dca::ScanTop const* tops = nullptr;
    dca::ScanBlock const* block = nullptr;
    std::int32_t const* level_end = nullptr;
};

/// Scan whose runs' values are products of their bodies' steps (RevoluteScan). An action after the
/// scan may run before it for runs that begin at the ground.
template <class Scan>
concept goes_by_steps = requires(Scan const& scan, dca::Run const& run) {
    scan.step(run, 0);
    scan.begins_at_ground(run);
};

/// A block's part of a stage, in shared memory. In the inward pass a joined value takes the inboard
/// value's place, and the inboard value takes the outboard one's. In the outward pass a segment's
/// value is replaced by the value before it.
template <class Scan>
class BlockOfScan {
    using Value = typename Scan::Value;
    using Values = PackedRecords<Value>;

  public:
    /// Size of the memory in doubles.
    static __host__ __device__ int size(DeviceScanStage const& stage) {
        return static_cast<int>(Values::size(stage.width)) + stage.width + (stage.levels + 1) / 2;
    }
    /// Reads the lists, and the values before complete segments if `known`, so that later code does
    /// not wait for them. The block has one thread per item. `number`: number of the block in the
    /// stage.
    __device__ BlockOfScan(DeviceScanStage const& stage, Scan const& scan, double* memory,
                           bool known, unsigned number = blockIdx.x)
        : stage_(stage),
          scan_(scan),
          values_{memory},
          merges_(reinterpret_cast<dca::ScanMerge*>(memory + Values::size(stage.width))),
          level_end_(reinterpret_cast<std::int32_t*>(merges_ + stage.width)) {
        dca::ScanBlock const here = stage.block[number];
        std::int64_t const item = here.item.begin + threadIdx.x,
                           merge = here.merge.begin + threadIdx.x,
                           top = here.top.begin + threadIdx.x;
        has_item_ = item < here.item.end;
        has_top_ = top < here.top.end;
        if (has_item_) slot_ = stage.slot[item];
        if (has_item_ && stage.runs) run_ = stage.runs[item];
        if (has_top_) top_ = stage.tops[top];
        if (merge < here.merge.end) merges_[threadIdx.x] = stage.merges[merge];
        if (static_cast<int>(threadIdx.x) < stage.levels)
            level_end_[threadIdx.x] =
                stage.level_end[static_cast<std::int64_t>(number) * stage.levels + threadIdx.x];
        if (known) learn();
    }
    /// Reads the values before complete segments.
    __device__ void learn() {
        if (has_top_) before_top_ = scan_.before(top_.slot);
    }

    /// Performs the inward pass. `runs_are_known`: the runs' values are already stored.
    template <bool runs_are_known = false>
    __device__ void climb() const {
        if (has_item_)
            values_.store(place(),
                          !runs_are_known && stage_.runs ? scan_.of_run(run_) : scan_.whole(slot_));
        CATENA_NO_UNROLL
        for (int l = 0; l < stage_.levels; ++l)
            at_merge(l, [&](dca::ScanMerge const& m) {
                Value const inboard = values_.load(m.inboard),
                            joined = scan_.joined(inboard, values_.load(m.outboard));
                values_.store(m.inboard, joined);
                values_.store(m.outboard, inboard);
            });
        __syncthreads();
    }
    /// Stores values that other stages continue with, and that an outward pass in another launch
    /// needs.
    __device__ void put() const {
        if (has_item_) scan_.set_whole(slot_, values_.load(place()));
        put_tops();
    }
    /// Stores the values of segments that are complete in this block.
    __device__ void put_tops() const {
        if (has_top_) scan_.set_whole(top_.slot, values_.load(top_.place));
    }
    /// Reads the values back for an outward pass.
    __device__ void take() const {
        if (has_item_) values_.store(place(), scan_.whole(slot_));
        __syncthreads();
    }
    /// Performs the outward pass. Precondition: the values before complete segments were read.
    __device__ void descend() const {
        if (has_top_) values_.store(top_.place, before_top_);
        CATENA_NO_UNROLL
        for (int l = stage_.levels - 1; l >= 0; --l)
            at_merge(l, [&](dca::ScanMerge const& m) {
                values_.store(m.outboard,
                              scan_.joined(values_.load(m.inboard), values_.load(m.outboard)));
            });
        __syncthreads();
        if (has_item_) scan_.set_before(slot_, values_.load(place()));
    }

  private:
    static __device__ int place() { return static_cast<int>(threadIdx.x); }
    /// Calls action(merge) for the thread's merge of a level, after a barrier.
    template <class Action>
    __device__ void at_merge(int level, Action const& action) const {
        __syncthreads();
        int const i = (level == 0 ? 0 : level_end_[level - 1]) + static_cast<int>(threadIdx.x);
        if (i < level_end_[level]) action(merges_[i]);
    }

    DeviceScanStage const& stage_;
    Scan const& scan_;
    Values values_;
    dca::ScanMerge* merges_;
    std::int32_t* level_end_;
    bool has_item_, has_top_;
    std::int32_t slot_ = 0;
    dca::Run run_;
    dca::ScanTop top_;
    Value before_top_;
};

/// Number of blocks that share a multiprocessor; more blocks lack registers for larger values.
template <class Scan>
constexpr int scans_at_once = sizeof(typename Scan::Value) <= 8 * sizeof(double) ? 2 : 1;
/// Kernel of a stage's inward pass.
template <class Scan>
__global__ void __launch_bounds__(most_of_scan, scans_at_once<Scan>)
    climb_scan(DeviceScanStage stage, Scan scan) {
    wait_for_launch();
    BlockOfScan<Scan> const block(stage, scan, shared_numbers, false);
    block.climb();
    block.put();
}
/// Kernel of both passes of the last stage.
template <class Scan>
__global__ void __launch_bounds__(most_of_scan) turn_scan(DeviceScanStage stage, Scan scan) {
    wait_for_launch();
    BlockOfScan<Scan> const block(stage, scan, shared_numbers, true);
    block.climb();
    block.descend();
}
/// Action that calls action(item i) for index i.
template <class Item, class Action>
struct OfItem {
    Item const* items;
    Action action;
    __device__ void operator()(std::int64_t i) const { action(items[i]); }
};
/// True if an action is an OfItem.
template <class Action>
inline constexpr bool is_of_items = false;
template <class Item, class Action>
inline constexpr bool is_of_items<OfItem<Item, Action>> = true;
/// Calls action(k) for every body or item k < count, by all threads of the launch. Neighbouring
/// threads access neighbouring addresses.
template <bool of_items, class Action>
__device__ void for_all(std::int64_t count, Action const& action) {
    std::int64_t const threads = static_cast<std::int64_t>(gridDim.x) * blockDim.x,
                       end = of_items ? count : gpu_order::padded(count);
    for (std::int64_t i = thread(); i < end; i += threads)
        if (std::int64_t const k = of_items ? i : gpu_order::body(i); k < count) action(k);
}
/// Computes the values of a stage's runs by the blocks of a cluster, for a stage of one block.
/// First a thread computes the step of one body, then a thread combines the steps of one run.
template <class Scan>
class RunsByStep {
    static constexpr int bodies = static_cast<int>(dca::longest_run),
                         at_once = most_of_scan / bodies;
    using Steps = PackedRecords<typename Scan::Step>;

  public:
    /// Number of runs per block of the cluster.
    static __host__ __device__ int runs_of_block(DeviceScanStage const& stage, unsigned blocks) {
        return (stage.width + static_cast<int>(blocks) - 1) / static_cast<int>(blocks);
    }
    /// Size of the memory in doubles.
    static __host__ __device__ std::size_t size(DeviceScanStage const& stage, unsigned blocks) {
        return Steps::size((runs_of_block(stage, blocks) + at_once - 1) / at_once * most_of_scan);
    }
    __device__ RunsByStep(DeviceScanStage const& stage, Scan const& scan, double* memory)
        : stage_(stage),
          scan_(scan),
          steps_{memory},
          begin_(static_cast<int>(blockIdx.x) * runs_of_block(stage, gridDim.x)),
          end_(begin_ + runs_of_block(stage, gridDim.x)) {
        if (end_ > stage.width) end_ = stage.width;
    }
    /// Stores the values of the block's runs.
    __device__ void operator()() const {
        int const thread = static_cast<int>(threadIdx.x);
        CATENA_NO_UNROLL
        for (int i = thread / bodies; begin_ + i < end_; i += at_once) {
            dca::Run const run = stage_.runs[begin_ + i];
            if (thread % bodies < run.count)
                steps_.store(i * bodies + thread % bodies, scan_.step(run, thread % bodies));
        }
        __syncthreads();
        if (int const i = begin_ + thread; i < end_)
            scan_.set_whole(stage_.slot[i], whole(thread, static_cast<int>(stage_.runs[i].count)));
    }

  private:
    /// Combines the steps of run i.
    __device__ typename Scan::Value whole(int i, int count) const {
        auto const [rotation_of_first, omega_of_first, axes] = steps_.load(i * bodies);
        auto rotation = rotation_of_first;
        auto omega = omega_of_first;
        CATENA_NO_UNROLL
        for (int body = 1; body < count; ++body)
            Scan::go_on(rotation, omega, steps_.load(i * bodies + body));
        return Scan::ended(rotation, omega);
    }

    DeviceScanStage const& stage_;
    Scan const& scan_;
    Steps steps_;
    int begin_, end_;
};
/// Performs both passes of a stage of one block by one cluster, then action(i) for every item i, a
/// run of the stage. The first block calls turns() after the values of all runs are known.
template <class Scan, class Action, class Turns>
__device__ void turn_by_steps(DeviceScanStage const& stage, Scan const& scan, double* memory,
                              std::int64_t count, Action const& action, Turns const& turns) {
    static_assert(is_of_items<Action>);
    RunsByStep<Scan>(stage, scan, memory)();
    meet_cluster();
    if (blockIdx.x + 1 == gridDim.x)  // concurrently with the first block
        for (std::int64_t i = threadIdx.x; i < count; i += blockDim.x)
            if (scan.begins_at_ground(stage.runs[i])) action(i);
    if (blockIdx.x == 0) turns();
    meet_cluster();
    for_all<true>(count, [&](std::int64_t i) {
        if (!scan.begins_at_ground(stage.runs[i])) action(i);
    });
}
/// Kernel of both passes of a stage of one block, then action(k) for every body or item k, by one
/// cluster.
template <class Scan, class Action>
__global__ void __launch_bounds__(most_of_scan)
    turn_scan_then(DeviceScanStage stage, Scan scan, std::int64_t count, Action action) {
    wait_for_launch();
    if constexpr (goes_by_steps<Scan>) {
        // The block's lists are read while the runs' values are computed.
        BlockOfScan<Scan> const block(stage, scan, shared_numbers, true, 0);
        turn_by_steps(stage, scan, shared_numbers + BlockOfScan<Scan>::size(stage), count, action,
                      [&] {
                          block.template climb<true>();
                          block.descend();
                      });
    } else {
        if (blockIdx.x == 0) {
            BlockOfScan<Scan> const block(stage, scan, shared_numbers, true);
            block.climb();
            block.descend();
        }
        meet_cluster();
        for_all<is_of_items<Action>>(count, action);
    }
}
/// Number of blocks of that cluster, with most_of_scan threads each.
template <class Scan>
unsigned blocks_of_turn(DeviceScanStage const& stage, std::int64_t count) {
    std::int64_t const wanted =
        goes_by_steps<Scan> ? std::max(count, stage.width * dca::longest_run) : count;
    return static_cast<unsigned>(
        std::min<std::int64_t>(most_in_cluster, (wanted - 1) / most_of_scan + 1));
}
/// Size of a block's shared memory in doubles.
template <class Scan>
std::size_t numbers_of_turn(DeviceScanStage const& stage, unsigned blocks) {
    auto numbers = static_cast<std::size_t>(BlockOfScan<Scan>::size(stage));
    if constexpr (goes_by_steps<Scan>) numbers += RunsByStep<Scan>::size(stage, blocks);
    return numbers;
}
/// Performs both passes of one block, with exchange() and the one block of the top `above` between
/// the passes, as both_passes() does.
template <bool runs_are_known, class Scan, class Exchange>
__device__ void turn_shared_block(BlockOfScan<Scan>& block, BlockOfScan<Scan> const& above,
                                  Exchange const& exchange) {
    block.template climb<runs_are_known>();
    block.put_tops();
    __syncthreads();
    exchange();
    __syncthreads();
    above.climb();
    above.descend();
    __syncthreads();
    block.learn();
    block.descend();
}
/// Kernel of both passes with an exchange between ranks.
template <class Scan, class Exchange>
__global__ void __launch_bounds__(most_of_scan)
    shared_passes_of_scan(DeviceScanStage stage, DeviceScanStage top, Exchange exchange,
                          Scan scan) {
    wait_for_launch();
    BlockOfScan<Scan> block(stage, scan, shared_numbers, false);
    BlockOfScan<Scan> const above(top, scan, shared_numbers + BlockOfScan<Scan>::size(stage), true);
    turn_shared_block<false>(block, above, exchange);
}
/// Kernel of both passes with an exchange between ranks, then action(i) as in turn_scan_then().
template <class Scan, class Exchange, class Action>
__global__ void __launch_bounds__(most_of_scan)
    shared_passes_of_scan_then(DeviceScanStage stage, DeviceScanStage top, Exchange exchange,
                               Scan scan, std::int64_t count, Action action) {
    wait_for_launch();
    double* const of_top = shared_numbers + BlockOfScan<Scan>::size(stage);
    BlockOfScan<Scan> block(stage, scan, shared_numbers, false, 0);
    BlockOfScan<Scan> const above(top, scan, of_top, true, 0);
    turn_by_steps(stage, scan, of_top + BlockOfScan<Scan>::size(top), count, action,
                  [&] { turn_shared_block<true>(block, above, exchange); });
}
/// Kernel of a stage's outward pass.
template <class Scan>
__global__ void __launch_bounds__(most_of_scan, scans_at_once<Scan>)
    descend_scan(DeviceScanStage stage, Scan scan) {
    wait_for_launch();
    BlockOfScan<Scan> const block(stage, scan, shared_numbers, true);
    block.take();
    block.descend();
}

/// Number of threads of a stage's block.
inline unsigned threads_of_scan(DeviceScanStage const& stage) {
    return static_cast<unsigned>((stage.width + 31) / 32 * 32);
}

}  // namespace catena::cuda::kernels
