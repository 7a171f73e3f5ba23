// Scans along chains (dca/stages.hpp, plan_scan) on a GPU: a block climbs its part of the tree in its shared memory and descends there. A
// host compiler takes it too, where tests/support/cuda_on_host.hpp stands before it.
#pragma once

#include <algorithm>

#include "cuda/cluster.cuh"
#include "cuda/run_parts.cuh"
#include "cuda/runs_view.hpp"
#include "dca/stages.hpp"

namespace catena::cuda::kernels {

using dca::most_of_scan;

/// A stage of a scan on a device.
struct DeviceScanStage {
    unsigned blocks = 0;
    int levels = 0, width = 0;
    RunsView runs = {};  // the items; none where they are not
    std::int32_t const* slot = nullptr;
    dca::ScanMerge const* merges = nullptr;
    dca::ScanTop const* tops = nullptr;
    dca::ScanBlock const* block = nullptr;
    std::int32_t const* level_end = nullptr;
};

/// A block's part of it. On the way up a joined value takes the inboard one's place and that the outboard one's, on the way down what lies
/// before a segment takes its place.
template <class Scan>
class BlockOfScan {
    using Value = typename Scan::Value;
    using Values = PackedRecords<Value>;

  public:
    /// Numbers that it needs.
    static __host__ __device__ int size(DeviceScanStage const& stage) {
        return static_cast<int>(Values::size(stage.width)) + stage.width + (stage.levels + 1) / 2;
    }
    /// Reads the lists, and what lies before what is complete where that is `known`: nothing waits for these later. A thread an item.
    __device__ BlockOfScan(DeviceScanStage const& stage, Scan const& scan, double* memory, bool known)
        : stage_(stage),
          scan_(scan),
          values_{memory},
          merges_(reinterpret_cast<dca::ScanMerge*>(memory + Values::size(stage.width))),
          level_end_(reinterpret_cast<std::int32_t*>(merges_ + stage.width)) {
        dca::ScanBlock const here = stage.block[blockIdx.x];
        std::int64_t const item = here.item.begin + threadIdx.x, merge = here.merge.begin + threadIdx.x, top = here.top.begin + threadIdx.x;
        has_item_ = item < here.item.end;
        has_top_ = top < here.top.end;
        if (has_item_) slot_ = stage.slot[item];
        if (has_item_ && stage.runs) run_ = stage.runs[item];
        if (has_top_) top_ = stage.tops[top];
        if (merge < here.merge.end) merges_[threadIdx.x] = stage.merges[merge];
        if (static_cast<int>(threadIdx.x) < stage.levels)
            level_end_[threadIdx.x] = stage.level_end[static_cast<std::int64_t>(blockIdx.x) * stage.levels + threadIdx.x];
        if (known) learn();
    }
    /// What lies before what is complete.
    __device__ void learn() {
        if (has_top_) before_top_ = scan_.before(top_.slot);
    }

    __device__ void climb() const {
        if (has_item_) values_.store(place(), stage_.runs ? scan_.of_run(run_) : scan_.whole(slot_));
        CATENA_NO_UNROLL
        for (int l = 0; l < stage_.levels; ++l)
            at_merge(l, [&](dca::ScanMerge const& m) {
                Value const inboard = values_.load(m.inboard), joined = scan_.joined(inboard, values_.load(m.outboard));
                values_.store(m.inboard, joined);
                values_.store(m.outboard, inboard);
            });
        __syncthreads();
    }
    /// What other stages make more of, and what the way down by a launch of its own needs.
    __device__ void put() const {
        if (has_item_) scan_.set_whole(slot_, values_.load(place()));
        put_tops();
    }
    __device__ void put_tops() const {
        if (has_top_) scan_.set_whole(top_.slot, values_.load(top_.place));
    }
    __device__ void take() const {
        if (has_item_) values_.store(place(), scan_.whole(slot_));
        __syncthreads();
    }
    /// Precondition: what lies before the block was known.
    __device__ void descend() const {
        if (has_top_) values_.store(top_.place, before_top_);
        CATENA_NO_UNROLL
        for (int l = stage_.levels - 1; l >= 0; --l)
            at_merge(l, [&](dca::ScanMerge const& m) {
                values_.store(m.outboard, scan_.joined(values_.load(m.inboard), values_.load(m.outboard)));
            });
        __syncthreads();
        if (has_item_) scan_.set_before(slot_, values_.load(place()));
    }

  private:
    static __device__ int place() { return static_cast<int>(threadIdx.x); }
    /// After all threads have met.
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

/// Blocks that share a multiprocessor: more find no registers for larger values.
template <class Scan>
constexpr int scans_at_once = sizeof(typename Scan::Value) <= 8 * sizeof(double) ? 2 : 1;
template <class Scan>
__global__ void __launch_bounds__(most_of_scan, scans_at_once<Scan>) climb_scan(DeviceScanStage stage, Scan scan) {
    wait_for_launch();
    BlockOfScan<Scan> const block(stage, scan, shared_numbers, false);
    block.climb();
    block.put();
}
template <class Scan>
__global__ void __launch_bounds__(most_of_scan) turn_scan(DeviceScanStage stage, Scan scan) {
    wait_for_launch();
    BlockOfScan<Scan> const block(stage, scan, shared_numbers, true);
    block.climb();
    block.descend();
}
/// Of one block, and then action(k) for every body k: by one cluster.
template <class Scan, class Action>
__global__ void __launch_bounds__(most_of_scan) turn_scan_then(DeviceScanStage stage, Scan scan, std::int64_t count, Action action) {
    wait_for_launch();
    if (blockIdx.x == 0) {
        BlockOfScan<Scan> const block(stage, scan, shared_numbers, true);
        block.climb();
        block.descend();
    }
    meet_cluster();
    std::int64_t const threads = static_cast<std::int64_t>(gridDim.x) * blockDim.x;
    for (std::int64_t i = thread(); i < gpu_order::padded(count); i += threads)
        if (std::int64_t const k = gpu_order::body(i); k < count) action(k);
}
/// Of one block, with exchange() and the one block of `top` in between, as turn().
template <class Scan, class Exchange>
__global__ void __launch_bounds__(most_of_scan) turn_shared_scan(DeviceScanStage stage, DeviceScanStage top, Exchange exchange, Scan scan) {
    wait_for_launch();
    BlockOfScan<Scan> block(stage, scan, shared_numbers, false);
    BlockOfScan<Scan> const above(top, scan, shared_numbers + BlockOfScan<Scan>::size(stage), true);
    block.climb();
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
template <class Scan>
__global__ void __launch_bounds__(most_of_scan, scans_at_once<Scan>) descend_scan(DeviceScanStage stage, Scan scan) {
    wait_for_launch();
    BlockOfScan<Scan> const block(stage, scan, shared_numbers, true);
    block.take();
    block.descend();
}

inline unsigned threads_of_scan(DeviceScanStage const& stage) { return static_cast<unsigned>((stage.width + 31) / 32 * 32); }
/// Of turn_scan_then(), of most_of_scan threads each.
inline unsigned blocks_of_turn(std::int64_t count) {
    return static_cast<unsigned>(std::min<std::int64_t>(most_in_cluster, (count - 1) / most_of_scan + 1));
}

}  // namespace catena::cuda::kernels
