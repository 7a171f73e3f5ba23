// A block's part of a sweep's stage (tree/stages.hpp) on a GPU. tests/support/cuda_on_host.hpp,
// included first, makes this file compile on the host.
#pragma once

#include <algorithm>

#include "cuda/sweeps/merge_teams.cuh"
#include "cuda/sweeps/runs_view.hpp"
#include "tree/stage_encoding.hpp"

namespace catena::cuda::kernels {

/// Stage of a sweep (tree/stages.hpp) on a device.
struct DeviceStage {
    unsigned blocks = 0;
    int forces = 0;  // places for forces per block
    dca::StageLayout layout;
    RunsView runs = {};  // the items; empty if the items are stored segments
    dca::StageWord const* words = nullptr;
    dca::StageRoot const* roots = nullptr;
    /// Memory in which each block keeps its places between the passes: StageRecords::kept numbers
    /// per place.
    double* kept = nullptr;
    bool gathers = false;  // true if the stage only gathers segments for other ranks (dca::Stage)
};

/// True if several lanes of a warp share a merge. One lane lacks registers for larger segments
/// together with their biases.
template <class Sweep>
constexpr bool merges_by_teams = false;
template <class Sweep>
    requires requires(Sweep const& sweep) { sweep.matrices(), sweep.biases(); }
constexpr bool merges_by_teams<Sweep> = (Sweep::K > dca::most_directions_of_a_thread);
/// Largest number of threads of a stage's block, and of a block that performs both passes in one
/// launch. In the latter case few blocks have the GPU to themselves.
template <class Sweep>
constexpr int threads_of = merges_by_teams<Sweep> ? 128 : Sweep::Sweeps::in_stage.threads;
template <class Sweep>
constexpr int threads_of_turn = merges_by_teams<Sweep> ? 256 : threads_of<Sweep>;
/// Number of blocks that share a multiprocessor, if their shared memory allows it.
template <class Sweep>
constexpr int blocks_of_stage = merges_by_teams<Sweep> ? 4 : 1;
/// Returns the threads per block: `planned`, with one merge per thread, or `most` if teams merge.
template <class Sweep>
constexpr int threads_for(int planned, int most) {
    return merges_by_teams<Sweep> ? most : planned;
}

/// Calls action(i) for i of [0, count) by the threads of a block.
template <class Action>
__device__ void each_of(int count, Action const& action) {
    for (auto i = static_cast<int>(threadIdx.x); i < count; i += static_cast<int>(blockDim.x))
        action(i);
}
/// Layout of segments, nodes and forces in a stage's shared memory. A node takes the place of a
/// segment.
template <class Sweep>
struct RecordsOfStage {
    using Segments = PackedRecords<typename Sweep::Segment>;
    using Nodes =
        PackedRecords<typename Sweep::Sweeps::Node,
                      std::max(Segments::stride, numbers_of<typename Sweep::Sweeps::Node>)>;
    using Forces = PackedRecords<typename Sweep::Sweeps::State>;
    static_assert(!Sweep::keeps_nodes || Nodes::stride == Segments::stride);
};
/// Layout for sweeps whose merges use teams.
template <class Sweep>
    requires merges_by_teams<Sweep>
struct RecordsOfStage<Sweep> {
    static_assert(MergeTeam<Sweep>::of_place == Sweep::Sweeps::in_stage.kept);
    using Segments = typename MergeTeam<Sweep>::Segments;
    using Nodes = typename MergeTeam<Sweep>::Nodes;
    using Forces = typename MergeTeam<Sweep>::Forces;
};

/// A block's part of a stage in its shared memory: its words, read once, and the segments and
/// forces at its places. A sweep that keeps nodes, or whose merges go by teams, stores nodes there
/// too. Each takes the place of the outboard segment of its merge.
template <class Sweep>
class BlockOfStage {
    using Segment = typename Sweep::Segment;
    using Node = typename Sweep::Sweeps::Node;
    using Records = RecordsOfStage<Sweep>;
    using Segments = typename Records::Segments;
    using Nodes = typename Records::Nodes;
    using Forces = typename Records::Forces;
    static constexpr bool by_teams = merges_by_teams<Sweep>;

  public:
    /// Returns the size of the memory in doubles for a block of `of_threads` threads. It is even,
    /// so that another block's words may follow.
    static __host__ __device__ int size(DeviceStage const& stage, int of_threads) {
        int const all =
            before_parts(stage) + (stage.runs ? static_cast<int>(Segments::size(of_threads)) : 0);
        return all + all % 2;
    }
    /// `block`: number of the block in the stage; `memory`: its shared memory.
    __device__ BlockOfStage(DeviceStage const& stage, unsigned block, Sweep const& sweep,
                            double* memory)
        : stage_(stage),
          block_(block),
          sweep_(sweep),
          words_(stage_.layout, reinterpret_cast<dca::StageWord*>(memory)),
          segments_{memory + numbers_of_words(stage)},
          nodes_{segments_.origin},
          forces_{segments_.origin + Segments::size(stage.layout.items)},
          memory_(memory),
          parts_(memory + before_parts(stage)) {}
    /// Reads the block's words. It is called first; a barrier must follow.
    __device__ void take_words() const {
        int const count = stage_.layout.words();
        dca::StageWord const* const from = stage_.words + static_cast<std::int64_t>(block_) * count;
        auto* const to = reinterpret_cast<dca::StageWord*>(memory_);
        move_some<4>(
            static_cast<int>(threadIdx.x), count, static_cast<int>(blockDim.x),
            [&](int i) { return from[i]; },
            [&](int i, dca::StageWord const& word) { to[i] = word; });
    }

    /// Reads the items' segments, or eliminates the runs. `part`: the thread's bodies, if items are
    /// runs. `and_down`: the same launch performs the outward pass.
    template <bool and_down>
    __device__ void take_items(typename Sweep::Part& part) const {
        dca::BlockHead const& head = words_.head();
        if constexpr (by_teams)
            take_segments();
        else if (!stage_.runs)
            each_of(head.items,
                    [&](int i) { segments_.store(i, sweep_.load(words_.item(i).own_slot())); });
        else
            climb_some_runs<and_down>(
                stage_.runs, head.first_item, head.first_item + head.items, sweep_, parts_, part,
                [&](std::int64_t i, Segment const& segment) {
                    segments_.store(static_cast<int>(i - head.first_item), segment);
                });
    }
    /// Receives segments of blocks below by letters and reads the other items from memory.
    __device__ void take_items(Letters const& letters) const {
        int const items = words_.head().items;
        each_of(items, [&](int i) {
            dca::BlockItem const& item = words_.item(i);
            if (item.comes_by_letter()) return;
            if constexpr (by_teams)
                for (int n = 0; n < Segments::numbers; ++n)
                    segments_.number(i, n) = sweep_.s.number_of_segment(item.own_slot(), n);
            else
                segments_.store(i, sweep_.load(item.own_slot()));
        });
        // Neighbouring threads take neighbouring items; the remaining threads share the numbers of
        // an item.
        // Independent requests hide the latency of memory.
        constexpr int at_once = Segments::numbers > 16 ? 16 : 8;
        auto const all = static_cast<int>(blockDim.x), own = static_cast<int>(threadIdx.x);
        int side_by_side = 32;
        while (side_by_side < items && side_by_side < all) side_by_side *= 2;
        for (int i = own % side_by_side; i < items; i += side_by_side)
            if (words_.item(i).comes_by_letter())
                letters.take_some<at_once>(
                    i, own / side_by_side, Segments::numbers, all / side_by_side,
                    [&](int n, double number) { segments_.number(i, n) = number; });
    }
    /// Merges segments, level by level.
    __device__ void climb() const {
        CATENA_NO_UNROLL
        for (int l = 0; l < stage_.layout.levels; ++l) {
            __syncthreads();
            if constexpr (by_teams)
                each_merge_of_team(l, [&](auto const& team, dca::BlockMerge const& m, bool works) {
                    double *const inboard = segments_.record(m.inboard), *const outboard =
                                                                             segments_.record(
                                                                                 m.outboard);
                    team.join(sweep_, {m.joint, m.restricted}, works,
                              {inboard, outboard, inboard, outboard});
                });
            else
                each_merge(l, [&](dca::BlockMerge const& m) { join(m); });
        }
        __syncthreads();
    }
    /// Stores segments that other stages or ranks need.
    __device__ void send_segments() const {
        int const ups = words_.head().ups;
        if constexpr (by_teams)
            for (int i = 0; i < ups; ++i) give(words_.up(i));
        else
            each_of(ups, [&](int i) {
                sweep_.store(words_.up(i).at, segments_.load(words_.up(i).place));
            });
    }
    /// Sends segments to the block of the stage above.
    __device__ void send_segments(Letters const& letters) const {
        each_of(words_.head().ups * Segments::numbers, [&](int i) {
            dca::BlockHanded const& up = words_.up(i / Segments::numbers);
            int const n = i % Segments::numbers;
            letters.put(up.above, n, segments_.number(up.place, n));
        });
    }
    /// Computes the forces at the ends of chains whose tree is complete in this block.
    __device__ void close() const {
        dca::BlockHead const& head = words_.head();
        each_of(head.roots,
                [&](int i) { close(i == 0 ? head.root : stage_.roots[head.first_root + i]); });
    }
    /// Stores the nodes for an outward pass in another launch.
    __device__ void put_nodes() const {
        if constexpr (by_teams)
            copy(segments_.origin, kept());
        else if constexpr (Sweep::keeps_nodes)
            each_merge(
                [&](dca::BlockMerge const& m) { sweep_.keep(m.joint, nodes_.load(m.outboard)); });
    }
    /// Reads the nodes back.
    __device__ void take_nodes() const {
        if constexpr (by_teams)
            copy(kept(), segments_.origin);
        else if constexpr (Sweep::keeps_nodes)
            each_merge(
                [&](dca::BlockMerge const& m) { nodes_.store(m.outboard, sweep_.node(m.joint)); });
    }
    /// Reads the forces that come from stages above.
    __device__ void take_forces() const {
        each_of(words_.head().downs, [&](int i) { take_force(words_.down(i)); });
    }
    /// Receives forces from the block of the stage above and reads the others from memory.
    __device__ void take_forces(Letters const& letters) const {
        int const downs = words_.head().downs;
        each_of(downs, [&](int i) {
            if (dca::BlockHanded const& down = words_.down(i); down.above < 0) take_force(down);
        });
        each_of(downs * Forces::numbers, [&](int i) {
            dca::BlockHanded const& down = words_.down(i / Forces::numbers);
            int const n = i % Forces::numbers;
            if (down.above >= 0) forces_.number(down.place, n) = letters.wait_for(down.above, n);
        });
    }
    /// Sends forces to the blocks of the stage below.
    __device__ void give_forces(Letters const& letters) const {
        each_of(stage_.forces, [&](int place) {
            CATENA_UNROLL
            for (int n = 0; n < Forces::numbers; ++n)
                letters.put(place, n, forces_.number(place, n));
        });
    }
    /// Computes joint forces, from the highest level to the lowest.
    __device__ void descend() const {
        CATENA_NO_UNROLL
        for (int l = stage_.layout.levels - 1; l >= 0; --l) {
            __syncthreads();
            if constexpr (by_teams)
                each_merge_of_team(l, [&](auto const& team, dca::BlockMerge const& m, bool works) {
                    team.go_down(m, works, nodes_, forces_);
                });
            else
                each_merge(l, [&](dca::BlockMerge const& m) { go_down(m); });
        }
        __syncthreads();
    }
    /// Stores the items' forces, or performs the runs' outward pass. `part`: as left by
    /// take_items() in the same launch, or null if `alone`. Loops are unrolled if `alone`, because
    /// many blocks then use the instructions.
    template <bool alone>
    __device__ void give_items(typename Sweep::Part const* part) const {
        if (!by_teams && stage_.runs)
            descend_runs<alone>(part);
        else
            each_of(words_.head().items, [&](int i) {
                if (dca::BlockItem const& item = words_.item(i); !item.is_given())
                    sweep_.s.forces.store(item.joint, forces_.load(i));
            });
    }

  private:
    /// Size of the words in doubles.
    static __host__ __device__ int numbers_of_words(DeviceStage const& stage) {
        return stage.layout.words() * static_cast<int>(sizeof(dca::StageWord) / sizeof(double));
    }
    /// Size of the words, segments and forces in doubles; the memory of run parts follows.
    static __host__ __device__ int before_parts(DeviceStage const& stage) {
        return numbers_of_words(stage) +
               static_cast<int>(Segments::size(stage.layout.items) + Forces::size(stage.forces));
    }
    // Sweeps with merges by teams never process stages with runs here; StageWalk splits these
    // sweeps.
    template <bool alone>
    __device__ void descend_runs(typename Sweep::Part const* part) const {
        if constexpr (!by_teams) {
            dca::BlockHead const& head = words_.head();
            auto const place = [&](std::int64_t i) {
                return static_cast<int>(i - head.first_item);
            };
            descend_some_runs<alone, !alone, false>(
                stage_.runs, head.first_item, head.first_item + head.items, sweep_, parts_, part,
                [&](dca::Run const&, std::int64_t i) { return forces_.load(place(i)); },
                [&](dca::Run const&, std::int64_t i) {
                    return forces_.load(words_.next_of_run(place(i)));
                });
        }
    }
    /// Computes the forces at the ends of one chain.
    __device__ void close(dca::StageRoot const& closed) const {
        Segment const whole = segments_.load(closed.place);
        if constexpr (takes_factors<Sweep>)
            if (closed.root.tip == dca::TipTo::nothing)
                return sweep_.close_free({closed.root.first, closed.restricted}, whole,
                                         BranchlessFactorizer<false>{});
        sweep_.close(closed.root, whole);
    }
    __device__ void take_force(dca::BlockHanded const& down) const {
        forces_.store(down.place, sweep_.s.forces.load(down.at));
    }
    /// Merges two segments; the merged one takes the place of the inboard one.
    __device__ void join(dca::BlockMerge const& m) const {
        Segment const inboard = segments_.load(m.inboard), outboard = segments_.load(m.outboard);
        dca::JointAt const at{m.joint, m.restricted};
        if constexpr (Sweep::keeps_nodes) {
            Node node;
            segments_.store(m.inboard, joined_quickly(sweep_, inboard, outboard, at, node));
            nodes_.store(m.outboard, node);
        } else {
            segments_.store(m.inboard, sweep_.joined(inboard, outboard, at));
        }
    }
    /// Computes the force at a merge's joint.
    __device__ void go_down(dca::BlockMerge const& m) const {
        Node node;
        if constexpr (Sweep::keeps_nodes)
            node = nodes_.load(m.outboard);
        else
            node = sweep_.node(m.joint);
        forces_.store(m.outboard,
                      sweep_.force(node, forces_.load(m.inboard), forces_.load(m.next)));
    }
    /// Calls action(merge) for the merges of a level.
    template <class Action>
    __device__ void each_merge(int level, Action const& action) const {
        int const end = words_.end_of_level(level);
        CATENA_NO_UNROLL
        for (int i = words_.end_of_level(level - 1) + static_cast<int>(threadIdx.x); i < end;
             i += static_cast<int>(blockDim.x))
            action(words_.merge(i));
    }
    /// Calls action(merge) for the merges of all levels.
    template <class Action>
    __device__ void each_merge(Action const& action) const {
        each_of(words_.end_of_level(stage_.layout.levels - 1),
                [&](int i) { action(words_.merge(i)); });
    }
    /// Calls action(team, merge, works) for the merges of a level by the block's teams.
    template <class Action>
    __device__ void each_merge_of_team(int level, Action const& action) const {
        MergeTeam<Sweep> const team;
        team.each(words_.end_of_level(level - 1), words_.end_of_level(level),
                  [&](int i, bool works) { action(team, words_.merge(i), works); });
    }
    /// Reads the items' segments: one number per warp, one item per lane.
    __device__ void take_segments() const {
        constexpr int at_once = 9;  // independent requests hide the latency of memory
        int const warp = static_cast<int>(threadIdx.x) / 32,
                  warps = static_cast<int>(blockDim.x) / 32;
        for (int place = static_cast<int>(threadIdx.x) % 32; place < words_.head().items;
             place += 32) {
            std::int64_t const slot = words_.item(place).own_slot();
            move_some<at_once>(
                warp, Segments::numbers, warps,
                [&](int n) { return sweep_.s.number_of_segment(slot, n); },
                [&](int n, double number) { segments_.number(place, n) = number; });
        }
    }
    /// Stores a segment by all threads of the block.
    __device__ void give(dca::BlockHanded const& up) const {
        each_of(Segments::numbers, [&](int n) {
            sweep_.s.number_of_segment(up.at, n) = segments_.number(up.place, n);
        });
    }
    /// Address of the block's places in the stage's memory.
    __device__ double* kept() const {
        return stage_.kept + block_ * Segments::size(stage_.layout.items);
    }
    /// Copies the memory of all segments.
    __device__ void copy(double const* from, double* to) const {
        move_some<8>(
            static_cast<int>(threadIdx.x), static_cast<int>(Segments::size(stage_.layout.items)),
            static_cast<int>(blockDim.x), [&](int i) { return from[i]; },
            [&](int i, double number) { to[i] = number; });
    }

    DeviceStage const& stage_;
    unsigned block_;
    Sweep const& sweep_;
    dca::BlockEncoding words_;
    Segments segments_;
    Nodes nodes_;
    Forces forces_;
    double *memory_, *parts_;
};

}  // namespace catena::cuda::kernels
