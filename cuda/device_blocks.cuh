// A block of whole chains on a GPU: its threads do all that a step asks for on them, in one launch.
#pragma once

#include <algorithm>

#include "cuda/kernels.cuh"

namespace catena::cuda {

/// As HostBlock, which says what its members promise. All threads of a block must come to each of them.
struct DeviceBlock {
    kernels::DeviceStage stage;
    dca::Range const *body = nullptr, *tip = nullptr;

    /// Neighbouring threads at neighbouring places.
    template <class Action>
    __device__ void each_body(Action const& action) const {
        dca::Range const own = body[blockIdx.x];
        auto constexpr steps = static_cast<std::uint32_t>(gpu_order::steps);
        std::int64_t const first = own.begin / steps;
        auto const rows = static_cast<std::uint32_t>((own.end + steps - 1) / steps - first);
        for (std::uint32_t i = threadIdx.x; i < rows * steps; i += blockDim.x) {
            std::int64_t const k = (first + i % rows) * steps + i / rows;
            if (own.begin <= k && k < own.end) action(k);
        }
        __syncthreads();
    }
    template <class Action>
    __device__ void each_tip(Action const& action) const {
        dca::Range const own = tip[blockIdx.x];
        for (std::int64_t i = own.begin + threadIdx.x; i < own.end; i += blockDim.x) action(i);
        __syncthreads();
    }
    template <class Sweep>
    __device__ void climb(Sweep const& sweep) const {
        kernels::climb_stage(stage, sweep);
        __syncthreads();
    }
    template <class Sweep>
    __device__ void climb_and_descend(Sweep const& sweep) const {
        kernels::climb_stage(stage, sweep);
        __syncthreads();
        kernels::descend_stage(stage, sweep);
        __syncthreads();
    }
};

namespace kernels {

constexpr int threads_of_block = 256;
template <class Action>
__global__ void __launch_bounds__(threads_of_block) each_block(DeviceBlock block, Action action) {
    action(block);
}

}  // namespace kernels

class DeviceBlocks {
  public:
    /// Longer chains are better dealt out to many blocks, sweep by sweep.
    static constexpr std::int64_t longest_chain = 4096;

    explicit DeviceBlocks(ChainGroup const& group) : runs_(group.schedule.runs) {
        dca::BlockPlan const plan = dca::plan_blocks(group.schedule, last_bodies(group.tips), width(group.schedule));
        std::vector<dca::Merge> all;
        for (auto const& level : group.schedule.levels) all.insert(all.end(), level.begin(), level.end());
        merges_ = Buffer<dca::Merge>(all);
        roots_ = Buffer<dca::Root>(plan.roots);
        for (auto const* ranges : {&plan.stage.run, &plan.stage.merge, &plan.stage.root, &plan.body, &plan.tip})
            ranges_.emplace_back(*ranges);
        block_ = {{plan.stage.levels, ranges_[0].data(), ranges_[1].data(), ranges_[2].data(), runs_.data(), merges_.data(), roots_.data()},
                  ranges_[3].data(),
                  ranges_[4].data()};
        count_ = static_cast<unsigned>(plan.blocks());
    }
    unsigned count() const { return count_; }
    DeviceBlock const& block() const { return block_; }

  private:
    /// Runs of a block: as many as its threads walk at once, but first every multiprocessor gets some.
    static std::int64_t width(dca::Schedule const& schedule) {
        constexpr std::int64_t blocks = 256, at_once = kernels::threads_of_block / dca::parts_of_run;
        return std::clamp<std::int64_t>(std::ssize(schedule.runs) / blocks, 1, at_once);
    }
    Buffer<dca::Run> runs_;
    Buffer<dca::Merge> merges_;
    Buffer<dca::Root> roots_;
    std::vector<Buffer<dca::Range>> ranges_;
    DeviceBlock block_;
    unsigned count_ = 0;
};

}  // namespace catena::cuda
