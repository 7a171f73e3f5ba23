// Kernels for a sweep's stages (tree/stages.hpp) and runs on a GPU. tests/support/cuda_on_host.hpp,
// included first, makes this file compile on the host.
#pragma once

#include "cuda/sweeps/run_groups.cuh"
#include "cuda/sweeps/stage_block.cuh"

namespace catena::cuda::kernels {

/// Threads per block of runs; a block of this size has enough registers for merges of every K.
constexpr int threads = 128;

/// True if the next launch may start during this one. With larger handles its waiting blocks would
/// occupy more than the early start saves.
template <class Sweep>
constexpr bool lets_next_start = Sweep::Sweeps::K == 1;

/// Kernel of a stage's inward pass.
template <class Sweep>
__global__ void __launch_bounds__(threads_of<Sweep>, blocks_of_stage<Sweep>)
    climb(DeviceStage stage, Sweep sweep) {
    BlockOfStage<Sweep> const block(stage, blockIdx.x, sweep, shared_numbers);
    block.take_words();
    __syncthreads();
    wait_for_launch();
    typename Sweep::Part part;
    block.template take_items<false>(part);
    block.climb();
    block.send_segments();
    block.close();
    block.put_nodes();
}
/// Kernel of a stage's outward pass.
template <class Sweep>
__global__ void __launch_bounds__(threads_of<Sweep>, blocks_of_stage<Sweep>)
    descend(DeviceStage stage, Sweep sweep) {
    BlockOfStage<Sweep> const block(stage, blockIdx.x, sweep, shared_numbers);
    block.take_words();
    __syncthreads();
    wait_for_launch();
    block.take_nodes();
    block.take_forces();
    block.descend();
    block.template give_items<true>(nullptr);
}
/// Number of threads per block that speeds up a launch in which ranks exchange.
template <class Sweep>
constexpr int threads_among_ranks = std::min(256, threads_of_turn<Sweep>);
/// Exchange of a launch without other ranks; it does nothing.
struct NoExchange {
    __device__ void operator()() const {}
};
/// Kernel of both passes of the last stage, `upper`, which has one block if there is a stage below.
/// If `lower` has blocks, all blocks of both stages run at once, and the block of `upper` has the
/// highest number. That block starts last and is already polling when the others send their
/// segments. If ranks share a `top`, then `upper` and `top` have one block each, and all threads of
/// that block call exchange(). It sends the segments in this rank's slots to the other ranks and
/// fills their slots; then the block performs both passes of the top. Loops make both stages use
/// the same instructions.
template <class Sweep, class Exchange>
__global__ void __launch_bounds__(threads_of_turn<Sweep>)
    both_passes(DeviceStage lower, DeviceStage upper, DeviceStage top, TopLaunchLetters letters,
                Exchange exchange, Sweep sweep) {
    constexpr bool among_ranks = !std::is_same_v<Exchange, NoExchange>;
    bool const by_letters = lower.blocks > 0, is_upper = blockIdx.x >= lower.blocks,
               has_top = among_ranks && is_upper;
    if constexpr (lets_next_start<Sweep>)
        if (by_letters && !has_top)
            // The next launch does not start yet if there is a top: it would occupy room for which
            // other ranks wait.
            let_next_launch_start();
    // A gathering stage without blocks below has no work: its segments are already in their slots.
    int const begin = has_top && !by_letters && upper.gathers ? 1 : 0, end = has_top ? 2 : 1;
    auto const with_block = [&](bool is_top, auto const& action) {
        DeviceStage const stage = is_top ? top : is_upper ? upper : lower;
        unsigned const block = is_top ? 0 : is_upper ? blockIdx.x - lower.blocks : blockIdx.x;
        int const before =
            is_top ? PlacesOfBlock<Sweep>::size(upper, static_cast<int>(blockDim.x)) : 0;
        action(BlockOfStage<Sweep>(stage, block, sweep, shared_numbers + before));
    };
    CATENA_NO_UNROLL
    for (int i = begin; i < end; ++i)
        with_block(i == 1, [](auto const& block) { block.take_words(); });
    __syncthreads();
    wait_for_launch();
    if (by_letters) letters.open();
    typename Sweep::Part part;
    CATENA_NO_UNROLL
    for (int i = begin; i < end; ++i) {
        if (among_ranks && i == 1) {
            exchange();
            __syncthreads();
            if constexpr (lets_next_start<Sweep>) let_next_launch_start();
        }
        with_block(i == 1, [&](auto const& block) {
            if (by_letters && is_upper && i == 0)
                block.take_items(letters.up);
            else
                block.template take_items<true>(part);
            block.climb();
            if (!is_upper)
                block.send_segments(letters.up);
            else if (has_top && i == 0)
                block.send_segments();
            block.close();
        });
        __syncthreads();
    }
    CATENA_NO_UNROLL
    for (int i = end - 1; i >= begin; --i) {
        with_block(i == 1, [&](auto const& block) {
            if (is_upper)
                block.take_forces();
            else
                block.take_forces(letters.down);
            block.descend();
            if (by_letters && is_upper && i == 0) block.give_forces(letters.down);
            block.template give_items<false>(&part);
        });
        if (i > begin) __syncthreads();
    }
    if (by_letters && threadIdx.x == 0) letters.close();
}
/// Blocks of `threads` that share a multiprocessor, in the inward pass and in the outward pass.
/// Links need few registers, and many blocks to hide the latency of memory. Planar and spherical
/// joints need many blocks in the outward pass only. In the inward pass of links a fourth block
/// would lack registers for quotients without branches.
template <class Sweep>
constexpr int blocks_of_climb = Sweep::Sweeps::K > 1   ? 1
                                : takes_factors<Sweep> ? 3
                                                       : 4;
template <class Sweep>
constexpr int blocks_of_descent =
    Sweep::Sweeps::K == 1                                                           ? 4
    : reads_bodies_twice<Sweep> && (Sweep::Sweeps::K == 2 || Sweep::Sweeps::K == 3) ? 3
                                                                                    : 1;
/// True if a thread processes a whole run in the inward pass. With larger handles and one thread
/// per part, most threads would wait for the thread that merges the parts.
template <class Sweep>
constexpr bool whole_runs = Sweep::Sweeps::K > 1;
/// Eliminates the run as climb_run(), with the branchless factorizer. `read(p)` returns the bodies
/// of part p.
template <class Sweep, class Read>
__device__ void climb_parts_quickly(Sweep const& sweep, dca::Run const& run, Read const& read) {
    dca::climb_parts(
        sweep, run, [&](int p) { return part_quickly(sweep, run, p, read(p)); },
        [&](auto const& inboard, auto const& outboard, dca::JointAt const& at) {
            typename Sweep::Node node;
            auto const joined = joined_quickly(sweep, inboard, outboard, at, node);
            sweep.keep(at.k, node);
            return joined;
        });
}
/// Eliminates a whole run by one thread, with prefetched bodies if that is faster.
template <class Sweep>
__device__ void climb_whole(Sweep const& sweep, dca::Run const& run) {
    if constexpr (prefetches_bodies<Sweep>) {
        // Bodies can be read only once here; links read them again if the branchless factorizer
        // fails.
        static_assert(Sweep::K > 1);
        using Bodies = BodiesInTurn<BodiesOf<Sweep>>;
        Bodies bodies(sweep.bodies, run.body, run.body + run.count, shared_numbers);
        climb_parts_quickly(sweep, run, [&](int) { return typename Bodies::Part{bodies}; });
    } else if constexpr (takes_factors<Sweep> && !dca::takes_whole_runs<Sweep>) {
        climb_parts_quickly(sweep, run, [&](int p) {
            return sweep.read(dca::begin_of(run, p), dca::end_of(run, p));
        });
    } else {
        climb_run(sweep, run);
    }
}
/// Kernel of the runs' inward pass.
template <class Sweep>
__global__ void __launch_bounds__(threads, blocks_of_climb<Sweep>)
    climb_runs(RunsView runs, Sweep sweep) {
    if constexpr (lets_next_start<Sweep>) let_next_launch_start();
    wait_for_launch();
    if constexpr (whole_runs<Sweep>) {
        if (std::int64_t const i = thread(); i < runs.count) climb_whole(sweep, runs[i]);
    } else {
        typename Sweep::Part part;
        climb_some_runs<false>(
            runs, static_cast<std::int64_t>(blockIdx.x) * (blockDim.x / dca::parts_of_run),
            runs.count, sweep, shared_numbers, part,
            [&](std::int64_t i, typename Sweep::Segment const& segment) {
                sweep.store(runs[i].slot, segment);
            });
    }
}
/// Kernel of the runs' outward pass. Blocks go from the last run to the first, because the data
/// that the inward pass read last are still in the cache.
template <class Sweep>
__global__ void __launch_bounds__(threads, blocks_of_descent<Sweep>)
    descend_runs(RunsView runs, Sweep sweep) {
    if constexpr (lets_next_start<Sweep>) let_next_launch_start();
    wait_for_launch();
    std::int64_t const block = gridDim.x - 1 - blockIdx.x;
    if constexpr (dca::takes_whole_runs<Sweep>) {
        if (std::int64_t const i = block * blockDim.x + threadIdx.x; i < runs.count)
            descend_run(sweep, runs[i]);
    } else {
        descend_some_runs<true, false, true>(
            runs, block * (blockDim.x / dca::parts_of_run), runs.count, sweep, shared_numbers,
            nullptr,
            [&](dca::Run const& run, std::int64_t) { return sweep.s.forces.load(run.body); },
            [&](dca::Run const& run, std::int64_t) { return sweep.s.forces.load(run.next); });
    }
}

/// Block size of the following kernels, which also process the tree levels within groups of runs:
/// one group per block.
static_assert(threads == runs_of_group * dca::parts_of_run);
/// Kernel of the groups' inward pass.
template <class Sweep>
__global__ void __launch_bounds__(threads, blocks_of_climb<Sweep>)
    climb_groups(RunsView runs, GroupsView groups, Sweep sweep) {
    using Segment = typename Sweep::Segment;
    constexpr std::size_t any_gpu_shares = 48 << 10;
    // The memory fits on any GPU, so that grid_of_climb() does not reduce the block size.
    static_assert(sizeof(double) * PackedRecords<Segment>::size(threads) <= any_gpu_shares);
    if constexpr (lets_next_start<Sweep>) let_next_launch_start();
    wait_for_launch();
    typename Sweep::Part part;
    Segment own = Segment::zero();
    climb_some_runs<false>(runs, std::int64_t{blockIdx.x} * runs_of_group, runs.count, sweep,
                           shared_numbers, part,
                           [&](std::int64_t, Segment const& segment) { own = segment; });
    if (threadIdx.x < runs_of_group) GroupOfRuns(groups, runs, blockIdx.x).climb(sweep, own);
}
/// Kernel of the groups' outward pass.
template <class Sweep>
__global__ void __launch_bounds__(threads, blocks_of_descent<Sweep>)
    descend_groups(RunsView runs, GroupsView groups, Sweep sweep) {
    if constexpr (lets_next_start<Sweep>) let_next_launch_start();
    wait_for_launch();
    std::int64_t const group = gridDim.x - 1 - blockIdx.x;
    auto const ends = GroupOfRuns(groups, runs, group).descend(sweep);
    descend_some_runs<true, false, true>(
        runs, group * runs_of_group, runs.count, sweep, shared_numbers, nullptr,
        [&](dca::Run const&, std::int64_t) { return ends.first; },
        [&](dca::Run const&, std::int64_t) { return ends.next; });
}

/// Dimensions of a launch over runs.
struct RunsGrid {
    unsigned blocks = 0, threads = 0;
    std::size_t shared_bytes = 0;
};
/// Returns a grid with threads for whole groups of 32 runs, whose lanes proceed in lockstep.
inline RunsGrid grid_of_runs(std::int64_t runs, int threads_of_run, int threads_of_block) {
    std::int64_t const wanted = (runs + 31) / 32 * 32 * threads_of_run;
    return {static_cast<unsigned>((wanted + threads_of_block - 1) / threads_of_block),
            static_cast<unsigned>(threads_of_block), 0};
}
/// Block size if a thread processes a whole run: a single warp, so that few runs spread over the
/// GPU.
template <class Sweep>
constexpr int threads_of_whole_runs = dca::takes_whole_runs<Sweep> ? 32 : threads;
/// Returns the grid of the largest blocks whose numbers(threads) doubles fit in shared memory.
template <class Numbers>
RunsGrid grid_that_fits(std::int64_t runs, int threads_of_run, int most_threads,
                        std::size_t most_shared_bytes, Numbers const& numbers) {
    int of_block = most_threads;
    while (of_block > 32 && sizeof(double) * numbers(of_block) > most_shared_bytes) of_block /= 2;
    RunsGrid grid = grid_of_runs(runs, threads_of_run, of_block);
    grid.shared_bytes = sizeof(double) * numbers(of_block);
    return grid;
}
/// Returns the grid of the runs' inward pass. `most_shared_bytes`: largest shared memory of a
/// block.
template <class Sweep>
RunsGrid grid_of_climb(std::int64_t runs, std::size_t most_shared_bytes) {
    if constexpr (prefetches_bodies<Sweep>)
        return grid_that_fits(runs, 1, threads, most_shared_bytes,
                              BodiesInTurn<BodiesOf<Sweep>>::size);
    else if constexpr (whole_runs<Sweep>)
        return grid_of_runs(runs, 1, threads_of_whole_runs<Sweep>);
    else
        return grid_that_fits(runs, dca::parts_of_run, threads, most_shared_bytes,
                              PackedRecords<typename Sweep::Segment>::size);
}
/// Returns the grid of the runs' outward pass.
template <class Sweep>
RunsGrid grid_of_descent(std::int64_t runs, std::size_t most_shared_bytes) {
    if constexpr (dca::takes_whole_runs<Sweep>)
        return grid_of_runs(runs, 1, threads_of_whole_runs<Sweep>);
    else
        return grid_that_fits(runs, dca::parts_of_run, threads, most_shared_bytes,
                              numbers_of_descent<Sweep>);
}

}  // namespace catena::cuda::kernels
