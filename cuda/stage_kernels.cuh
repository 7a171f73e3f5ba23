// A sweep's stages (dca/stages.hpp) on a GPU. A host compiler takes it too, where tests/support/cuda_on_host.hpp stands before it.
#pragma once

#include "cuda/merge_teams.cuh"
#include "dca/stages.hpp"

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
    dca::StageBlock const* block = nullptr;
    std::int32_t const* level_end = nullptr;  // of every block and level
    double* kept = nullptr;                   // of every block, its segments' memory: StageRecords::kept numbers a place
};

/// Whether lanes of a warp share a merge: larger segments and biases at once find no registers in one.
template <class Sweep>
constexpr bool merges_by_teams = false;
template <class Sweep>
    requires requires(Sweep const& sweep) { sweep.matrices(), sweep.biases(); }
constexpr bool merges_by_teams<Sweep> = (Sweep::K > dca::most_directions_of_a_thread);
/// Threads of a stage's block at most; of one that turns, where few blocks have a GPU to themselves.
template <class Sweep>
constexpr int threads_of = merges_by_teams<Sweep> ? 128 : Sweep::Sweeps::in_stage.threads;
template <class Sweep>
constexpr int threads_of_turn = merges_by_teams<Sweep> ? 256 : threads_of<Sweep>;
/// And blocks that share a multiprocessor where a stage's memory lets them.
template <class Sweep>
constexpr int blocks_of_stage = merges_by_teams<Sweep> ? 4 : 1;
/// Threads where so many are planned for a merge each, and there may be so many. Teams always take all.
template <class Sweep>
constexpr int threads_for(int planned, int most) {
    return merges_by_teams<Sweep> ? most : planned;
}

/// action(i) for a block's i of a range.
template <class Action>
__device__ void each_of(dca::Range const& range, Action const& action) {
    for (std::int64_t i = range.begin + threadIdx.x; i < range.end; i += blockDim.x) action(i);
}

/// How segments, nodes and forces lie in a stage's shared memory: a node in the place of a segment.
template <class Sweep>
struct RecordsOfStage {
    using Segments = SharedRecords<typename Sweep::Segment>;
    using Nodes = SharedRecords<typename Sweep::Sweeps::Node>;
    using Forces = SharedRecords<typename Sweep::Sweeps::State>;
    static_assert(!Sweep::keeps_nodes || Nodes::numbers <= Segments::numbers);
    template <class Records>
    static __device__ Records at(double* memory, int count) {
        return {memory, Records::pitch_for(count)};
    }
};
template <class Sweep>
    requires merges_by_teams<Sweep>
struct RecordsOfStage<Sweep> {
    static_assert(MergeTeam<Sweep>::of_place == Sweep::Sweeps::in_stage.kept);
    using Segments = typename MergeTeam<Sweep>::Segments;
    using Nodes = typename MergeTeam<Sweep>::Nodes;
    using Forces = typename MergeTeam<Sweep>::Forces;
    template <class Records>
    static __device__ Records at(double* memory, int /*count*/) {
        return {memory};
    }
};

/// A block's part of a stage, in its shared memory: its lists, which are read once, and the segments and forces at its places. A sweep
/// that keeps nodes, or whose merges go by teams, has those there as well, each in the place of the outboard segment that it was made of.
template <class Sweep>
class BlockOfStage {
    using Segment = typename Sweep::Segment;
    using Node = typename Sweep::Sweeps::Node;
    using Records = RecordsOfStage<Sweep>;
    using Segments = typename Records::Segments;
    using Nodes = typename Records::Nodes;
    using Forces = typename Records::Forces;
    static constexpr bool by_teams = merges_by_teams<Sweep>;
    static_assert(sizeof(dca::StageMerge) == 3 * sizeof(double));

  public:
    /// Numbers that it needs, of `threads` threads.
    static __host__ __device__ int size(DeviceStage const& stage, int of_threads) {
        return before_parts(stage) + (stage.runs ? static_cast<int>(Segments::size(of_threads)) : 0);
    }
    __device__ BlockOfStage(DeviceStage const& stage, Sweep const& sweep, double* memory)
        : stage_(stage),
          sweep_(sweep),
          segments_(Records::template at<Segments>(memory, stage.width)),
          nodes_(Records::template at<Nodes>(memory, stage.width)),
          forces_(Records::template at<Forces>(memory + Segments::size(stage.width), stage.forces)),
          merges_(reinterpret_cast<dca::StageMerge*>(forces_.origin + Forces::size(stage.forces))),
          slot_or_next_(reinterpret_cast<std::int64_t*>(merges_ + stage.width)),
          here_(reinterpret_cast<dca::StageBlock*>(slot_or_next_ + stage.width)),
          level_end_(reinterpret_cast<std::int32_t*>(here_ + 1)),
          parts_(memory + before_parts(stage)) {}
    /// First of all; before anything else the block's threads must meet.
    __device__ void take_lists() const {
        dca::StageBlock const here = stage_.block[blockIdx.x];
        if (threadIdx.x == 0) *here_ = here;
        for (auto l = static_cast<int>(threadIdx.x); l < stage_.levels; l += static_cast<int>(blockDim.x))
            level_end_[l] = stage_.level_end[static_cast<std::int64_t>(blockIdx.x) * stage_.levels + l];
        each_of(here.merge, [&](std::int64_t i) { merges_[i - here.merge.begin] = stage_.merges[i]; });
        each_of(here.item, [&](std::int64_t i) {
            dca::StageItem const& item = stage_.items[i];
            slot_or_next_[i - here.item.begin] = stage_.runs ? item.next : item.slot;
        });
    }

    /// `part`: of the thread's bodies, where items are runs. `and_down`: the way down is the same launch's.
    template <bool and_down>
    __device__ void climb(typename Sweep::Part& part) const {
        take_items<and_down>(part);
        CATENA_NO_UNROLL
        for (int l = 0; l < stage_.levels; ++l) {
            __syncthreads();
            if constexpr (by_teams)
                each_merge_of_team(
                    l, [&](auto const& team, dca::StageMerge const& m, bool works) { team.join(sweep_, m, works, segments_, nodes_); });
            else
                each_merge(l, [&](dca::StageMerge const& m) { join(m); });
        }
        __syncthreads();
        if constexpr (by_teams)
            for (std::int64_t i = here_->up.begin; i < here_->up.end; ++i) give(stage_.segments_up[i]);
        else
            each_of(here_->up, [&](std::int64_t i) {
                dca::Handed const up = stage_.segments_up[i];
                sweep_.store(up.at, segments_.load(up.place));
            });
        each_of(here_->root, [&](std::int64_t i) {
            dca::StageRoot const closed = stage_.roots[i];
            sweep_.close(closed.root, segments_.load(closed.place));
        });
    }
    /// Between a climb and a descent of their own.
    __device__ void put_nodes() const {
        if constexpr (by_teams)
            copy(segments_.origin, kept());
        else if constexpr (Sweep::keeps_nodes)
            each_merge([&](dca::StageMerge const& m) { sweep_.keep(m.joint, nodes_.load(m.outboard)); });
    }
    __device__ void take_nodes() const {
        if constexpr (by_teams)
            copy(kept(), segments_.origin);
        else if constexpr (Sweep::keeps_nodes)
            each_merge([&](dca::StageMerge const& m) { nodes_.store(m.outboard, sweep_.node(m.joint)); });
    }
    /// After a climb in the same launch, which left `part`, or alone (null); then loops are unrolled, as many blocks use the instructions.
    template <bool alone>
    __device__ void descend(typename Sweep::Part const* part) const {
        each_of(here_->down, [&](std::int64_t i) {
            dca::Handed const down = stage_.forces_down[i];
            forces_.store(down.place, sweep_.s.forces.load(down.at));
        });
        CATENA_NO_UNROLL
        for (int l = stage_.levels - 1; l >= 0; --l) {
            __syncthreads();
            if constexpr (by_teams)
                each_merge_of_team(
                    l, [&](auto const& team, dca::StageMerge const& m, bool works) { team.go_down(m, works, nodes_, forces_); });
            else
                each_merge(l, [&](dca::StageMerge const& m) { go_down(m); });
        }
        __syncthreads();
        if (!by_teams && stage_.runs)
            descend_runs<alone>(part);
        else
            each_of(here_->item, [&](std::int64_t i) {
                if (dca::StageItem const item = stage_.items[i]; !item.given)
                    sweep_.s.forces.store(item.joint, forces_.load(place_of_item(i)));
            });
    }

  private:
    static __host__ __device__ int before_parts(DeviceStage const& stage) {
        return static_cast<int>(Segments::size(stage.width) + Forces::size(stage.forces)) + 4 * stage.width +
               static_cast<int>(sizeof(dca::StageBlock) / sizeof(double)) + (stage.levels + 1) / 2;
    }
    // Sweeps whose merges go by teams leave stages with runs to others (StageWalk).
    template <bool alone>
    __device__ void descend_runs(typename Sweep::Part const* part) const {
        if constexpr (!by_teams)
            descend_some_runs<alone, !alone, false>(
                stage_.runs, here_->item.begin, here_->item.end, sweep_, parts_, part,
                [&](dca::Run const&, std::int64_t i) { return forces_.load(place_of_item(i)); },
                [&](dca::Run const&, std::int64_t i) { return forces_.load(static_cast<int>(slot_or_next_[place_of_item(i)])); });
    }
    __device__ void join(dca::StageMerge const& m) const {
        Segment const inboard = segments_.load(m.inboard), outboard = segments_.load(m.outboard);
        if constexpr (Sweep::keeps_nodes) {
            Node node;
            segments_.store(m.inboard, sweep_.joined(inboard, outboard, {m.joint, m.restricted}, node));
            nodes_.store(m.outboard, node);
        } else {
            segments_.store(m.inboard, sweep_.joined(inboard, outboard, {m.joint, m.restricted}));
        }
    }
    __device__ void go_down(dca::StageMerge const& m) const {
        Node node;
        if constexpr (Sweep::keeps_nodes)
            node = nodes_.load(m.outboard);
        else
            node = sweep_.node(m.joint);
        forces_.store(m.outboard, sweep_.force(node, forces_.load(m.inboard), forces_.load(m.next)));
    }
    __device__ int place_of_item(std::int64_t i) const { return static_cast<int>(i - here_->item.begin); }
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
        for (auto i = static_cast<int>(threadIdx.x); i < level_end_[stage_.levels - 1]; i += static_cast<int>(blockDim.x))
            action(merges_[i]);
    }
    /// action(team, merge, works) by the block's teams.
    template <class Action>
    __device__ void each_merge_of_team(int level, Action const& action) const {
        MergeTeam<Sweep> const team;
        team.each(level == 0 ? 0 : level_end_[level - 1], level_end_[level],
                  [&](int i, bool works) { action(team, works ? merges_[i] : dca::StageMerge{}, works); });
    }
    /// A number a warp, an item a lane.
    __device__ void take_segments() const {
        constexpr int at_once = 9;  // memory is far
        int const warp = static_cast<int>(threadIdx.x) / 32, warps = static_cast<int>(blockDim.x) / 32;
        auto const items = static_cast<int>(here_->item.end - here_->item.begin);
        for (int place = static_cast<int>(threadIdx.x) % 32; place < items; place += 32) {
            std::int64_t const slot = slot_or_next_[place];
            move_numbers<at_once>(
                warp, Segments::numbers, warps, [&](int n) { return sweep_.s.number_of_segment(slot, n); },
                [&](int n, double number) { segments_.number(place, n) = number; });
        }
    }
    __device__ void give(dca::Handed const& up) const {
        for (auto n = static_cast<int>(threadIdx.x); n < Segments::numbers; n += static_cast<int>(blockDim.x))
            sweep_.s.number_of_segment(up.at, n) = segments_.number(up.place, n);
    }
    __device__ double* kept() const { return stage_.kept + blockIdx.x * Segments::size(stage_.width); }
    /// Of all segments' memory.
    __device__ void copy(double const* from, double* to) const {
        move_numbers<8>(
            static_cast<int>(threadIdx.x), static_cast<int>(Segments::size(stage_.width)), static_cast<int>(blockDim.x),
            [&](int i) { return from[i]; }, [&](int i, double number) { to[i] = number; });
    }
    template <bool and_down>
    __device__ void take_items(typename Sweep::Part& part) const {
        if constexpr (by_teams)
            take_segments();
        else if (!stage_.runs)
            each_of(here_->item, [&](std::int64_t i) {
                int const place = place_of_item(i);
                segments_.store(place, sweep_.load(slot_or_next_[place]));
            });
        else
            climb_some_runs<and_down>(stage_.runs, here_->item.begin, here_->item.end, sweep_, parts_, part,
                                      [&](std::int64_t i, Segment const& segment) { segments_.store(place_of_item(i), segment); });
    }

    DeviceStage const& stage_;
    Sweep const& sweep_;
    Segments segments_;
    Nodes nodes_;
    Forces forces_;
    dca::StageMerge* merges_;
    std::int64_t* slot_or_next_;  // of every item: a run's place of the force after it, another's slot
    dca::StageBlock* here_;
    std::int32_t* level_end_;
    double* parts_;
};

template <class Sweep>
__global__ void __launch_bounds__(threads_of<Sweep>, blocks_of_stage<Sweep>) climb(DeviceStage stage, Sweep sweep) {
    BlockOfStage<Sweep> const block(stage, sweep, shared_numbers);
    block.take_lists();
    __syncthreads();
    wait_for_launch();
    typename Sweep::Part part;
    block.template climb<false>(part);
    block.put_nodes();
}
template <class Sweep>
__global__ void __launch_bounds__(threads_of<Sweep>, blocks_of_stage<Sweep>) descend(DeviceStage stage, Sweep sweep) {
    BlockOfStage<Sweep> const block(stage, sweep, shared_numbers);
    block.take_lists();
    __syncthreads();
    wait_for_launch();
    block.take_nodes();
    block.template descend<true>(nullptr);
}
/// Up and down again: two stages, the upper one of one block, by one cluster of blocks, or the lower one alone. The same instructions do
/// both.
template <class Sweep>
__global__ void __launch_bounds__(threads_of_turn<Sweep>) turn(DeviceStage lower, DeviceStage upper, Sweep sweep) {
    double* const memory[] = {shared_numbers, shared_numbers + BlockOfStage<Sweep>::size(lower, static_cast<int>(blockDim.x))};
    CATENA_NO_UNROLL
    for (int up = 0; up < 2; ++up) {
        DeviceStage const stage = up == 0 ? lower : upper;
        if (blockIdx.x < stage.blocks) BlockOfStage<Sweep>(stage, sweep, up == 0 ? memory[0] : memory[1]).take_lists();
    }
    __syncthreads();
    wait_for_launch();
    typename Sweep::Part part;  // of the lower stage's
    CATENA_NO_UNROLL
    for (int up = 0; up < 2; ++up) {
        DeviceStage const stage = up == 0 ? lower : upper;
        if (blockIdx.x < stage.blocks) BlockOfStage<Sweep>(stage, sweep, up == 0 ? memory[0] : memory[1]).template climb<true>(part);
        meet_cluster();
    }
    CATENA_NO_UNROLL
    for (int up = 1; up >= 0; --up) {
        DeviceStage const stage = up == 0 ? lower : upper;
        if (blockIdx.x < stage.blocks) BlockOfStage<Sweep>(stage, sweep, up == 0 ? memory[0] : memory[1]).template descend<false>(&part);
        if (up == 1) meet_cluster();
    }
}
/// Blocks of `threads` that share a multiprocessor: links want few registers, and many to hide that memory is far.
template <class Sweep>
constexpr int blocks_at_once = Sweep::Sweeps::K == 1 ? 4 : 1;
/// Whether a thread takes a whole run on the way up: larger handles would have most of them wait for one that joins the parts.
template <class Sweep>
constexpr bool whole_runs = Sweep::Sweeps::K > 1;
template <class Sweep>
__global__ void __launch_bounds__(threads, blocks_at_once<Sweep>) climb_runs(dca::Run const* runs, std::int64_t count, Sweep sweep) {
    wait_for_launch();
    if constexpr (whole_runs<Sweep>) {
        if (std::int64_t const i = thread(); i < count) climb_run(sweep, runs[i]);
    } else {
        typename Sweep::Part part;
        climb_some_runs<false>(runs, static_cast<std::int64_t>(blockIdx.x) * (threads / dca::parts_of_run), count, sweep, shared_numbers,
                               part, [&](std::int64_t i, typename Sweep::Segment const& segment) { sweep.store(runs[i].slot, segment); });
    }
}
template <class Sweep>
__global__ void __launch_bounds__(threads, blocks_at_once<Sweep>) descend_runs(dca::Run const* runs, std::int64_t count, Sweep sweep) {
    wait_for_launch();
    if constexpr (dca::takes_whole_runs<Sweep>) {
        if (std::int64_t const i = thread(); i < count) descend_run(sweep, runs[i]);
    } else {
        descend_some_runs<true, false, true>(
            runs, static_cast<std::int64_t>(blockIdx.x) * (blockDim.x / dca::parts_of_run), count, sweep, shared_numbers, nullptr,
            [&](dca::Run const& run, std::int64_t) { return sweep.s.forces.load(run.body); },
            [&](dca::Run const& run, std::int64_t) { return sweep.s.forces.load(run.next); });
    }
}

struct RunsGrid {
    std::int64_t runs = 0;
    unsigned blocks = 0, threads = 0;
    std::size_t shared_bytes = 0;
};
/// Threads of whole groups of 32 runs, which walk side by side.
inline RunsGrid grid_of_runs(std::int64_t runs, int threads_of_run, int threads_of_block) {
    std::int64_t const wanted = (runs + 31) / 32 * 32 * threads_of_run;
    return {runs, static_cast<unsigned>((wanted + threads_of_block - 1) / threads_of_block), static_cast<unsigned>(threads_of_block), 0};
}
/// Threads of a block of whole runs: a warp, so that few runs spread over a GPU.
template <class Sweep>
constexpr int threads_of_whole_runs = dca::takes_whole_runs<Sweep> ? 32 : threads;
template <class Sweep>
RunsGrid grid_of_climb(std::int64_t runs) {
    RunsGrid grid =
        whole_runs<Sweep> ? grid_of_runs(runs, 1, threads_of_whole_runs<Sweep>) : grid_of_runs(runs, dca::parts_of_run, threads);
    if (!whole_runs<Sweep>) grid.shared_bytes = sizeof(double) * SharedRecords<typename Sweep::Segment>::size(threads);
    return grid;
}
/// Of a GPU whose blocks may share so many bytes.
template <class Sweep>
RunsGrid grid_of_descent(std::int64_t runs, std::size_t most_shared_bytes) {
    if constexpr (dca::takes_whole_runs<Sweep>) return grid_of_runs(runs, 1, threads_of_whole_runs<Sweep>);
    auto const bytes = [](int of_block) { return sizeof(double) * numbers_of_descent<Sweep>(of_block); };
    int of_block = threads;
    while (of_block > 32 && bytes(of_block) > most_shared_bytes) of_block /= 2;
    RunsGrid grid = grid_of_runs(runs, dca::parts_of_run, of_block);
    grid.shared_bytes = bytes(of_block);
    return grid;
}

}  // namespace catena::cuda::kernels
