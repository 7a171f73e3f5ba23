// Scans along chains (tree/stages.hpp, plan_scan) on a GPU. A block performs both passes of its
// part of the tree in shared memory. tests/support/cuda_on_host.hpp, included first, makes this
// file compile on the host.
#pragma once

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
    /// not wait for them. The block has one thread per item.
    __device__ BlockOfScan(DeviceScanStage const& stage, Scan const& scan, double* memory,
                           bool known)
        : stage_(stage),
          scan_(scan),
          values_{memory},
          merges_(reinterpret_cast<dca::ScanMerge*>(memory + Values::size(stage.width))),
          level_end_(reinterpret_cast<std::int32_t*>(merges_ + stage.width)) {
        dca::ScanBlock const here = stage.block[blockIdx.x];
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
                stage.level_end[static_cast<std::int64_t>(blockIdx.x) * stage.levels + threadIdx.x];
        if (known) learn();
    }
    /// Reads the values before complete segments.
    __device__ void learn() {
        if (has_top_) before_top_ = scan_.before(top_.slot);
    }

    /// Performs the inward pass.
    __device__ void climb() const {
        if (has_item_)
            values_.store(place(), stage_.runs ? scan_.of_run(run_) : scan_.whole(slot_));
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
/// Kernel of both passes of one block, with exchange() between ranks and the one block of their
/// `top` between the passes, as both_passes() does.
template <class Scan, class Exchange>
__global__ void __launch_bounds__(most_of_scan)
    shared_passes_of_scan(DeviceScanStage stage, DeviceScanStage top, Exchange exchange,
                          Scan scan) {
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
