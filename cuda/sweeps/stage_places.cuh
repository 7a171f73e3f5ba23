// Places of a block's part of a sweep's stage (tree/stages.hpp) in shared memory on a GPU.
// tests/support/cuda_on_host.hpp, included first, makes this file compile on the host.
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

/// A block's shared memory: the words of its part of a stage, its segments and nodes, its forces,
/// and parts of its runs. A node takes the place of the outboard segment of its merge.
template <class Sweep>
struct PlacesOfBlock {
    using Records = RecordsOfStage<Sweep>;
    using Segments = typename Records::Segments;

    /// Returns the size of the memory in doubles for a block of `of_threads` threads. It is even,
    /// so that another block's words may follow.
    static __host__ __device__ int size(DeviceStage const& of, int of_threads) {
        int const all =
            before_parts(of) + (of.runs ? static_cast<int>(Segments::size(of_threads)) : 0);
        return all + all % 2;
    }
    /// `of_block`: number of the block in the stage; `shared`: its shared memory.
    __device__ PlacesOfBlock(DeviceStage const& of_stage, unsigned of_block, double* shared)
        : stage(of_stage),
          block(of_block),
          memory(shared),
          words(stage.layout, reinterpret_cast<dca::StageWord*>(memory)),
          segments{memory + numbers_of_words(stage)},
          nodes{segments.origin},
          forces{segments.origin + Segments::size(stage.layout.items)},
          parts(memory + before_parts(stage)) {}
    /// Reads the block's words. It is called first; a barrier must follow.
    __device__ void take_words() const {
        int const count = stage.layout.words();
        dca::StageWord const* const from = stage.words + static_cast<std::int64_t>(block) * count;
        auto* const to = reinterpret_cast<dca::StageWord*>(memory);
        move_some<4>(
            static_cast<int>(threadIdx.x), count, static_cast<int>(blockDim.x),
            [&](int i) { return from[i]; },
            [&](int i, dca::StageWord const& word) { to[i] = word; });
    }

    /// Calls action(merge) for the merges of a level.
    template <class Action>
    __device__ void each_merge(int level, Action const& action) const {
        int const end = words.end_of_level(level);
        CATENA_NO_UNROLL
        for (int i = words.end_of_level(level - 1) + static_cast<int>(threadIdx.x); i < end;
             i += static_cast<int>(blockDim.x))
            action(words.merge(i));
    }
    /// Calls action(merge) for the merges of all levels.
    template <class Action>
    __device__ void each_merge(Action const& action) const {
        each_of(words.end_of_level(stage.layout.levels - 1),
                [&](int i) { action(words.merge(i)); });
    }
    /// Calls action(team, merge, works) for the merges of a level by the block's teams.
    template <class Action>
    __device__ void each_merge_of_team(int level, Action const& action) const {
        MergeTeam<Sweep> const team;
        team.each(words.end_of_level(level - 1), words.end_of_level(level),
                  [&](int i, bool works) { action(team, words.merge(i), works); });
    }
    /// Address of the block's places in the stage's memory.
    __device__ double* kept() const {
        return stage.kept + block * Segments::size(stage.layout.items);
    }
    /// Copies the memory of all segments.
    __device__ void copy(double const* from, double* to) const {
        move_some<8>(
            static_cast<int>(threadIdx.x), static_cast<int>(Segments::size(stage.layout.items)),
            static_cast<int>(blockDim.x), [&](int i) { return from[i]; },
            [&](int i, double number) { to[i] = number; });
    }

    DeviceStage const& stage;
    unsigned block;
    double* memory;
    dca::BlockEncoding words;
    Segments segments;
    typename Records::Nodes nodes;
    typename Records::Forces forces;
    double* parts;  // memory of run parts

  private:
    /// Size of the words in doubles.
    static __host__ __device__ int numbers_of_words(DeviceStage const& of) {
        return of.layout.words() * static_cast<int>(sizeof(dca::StageWord) / sizeof(double));
    }
    /// Size of the words, segments and forces in doubles; the memory of run parts follows.
    static __host__ __device__ int before_parts(DeviceStage const& of) {
        return numbers_of_words(of) +
               static_cast<int>(Segments::size(of.layout.items) + Records::Forces::size(of.forces));
    }
};

}  // namespace catena::cuda::kernels
