// Records in a block's shared memory, and both passes of a few runs with one thread per part of a
// run. tests/support/cuda_on_host.hpp, included first, makes this file compile on the host.
#pragma once

#include "cuda/sweeps/branchless_math.cuh"
#include "cuda/sweeps/prefetch.cuh"
#include "cuda/sweeps/runs_view.hpp"
#include "dca/part_descent.hpp"

namespace catena::cuda::kernels {

/// Number of this thread in the launch.
__device__ inline std::int64_t thread() {
    return static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x;
}

/// Dynamic shared memory of a block.
alignas(16) extern __shared__ double shared_numbers[];

/// Records in a block's shared memory, at intervals of `stride` numbers. Neighbouring threads and
/// threads a power of two apart access different banks. The offset of a number within its record is
/// a compile-time constant.
template <class T, int stride_ = static_cast<int>(sizeof(T) / sizeof(double))>
struct PackedRecords {
    static constexpr int numbers = static_cast<int>(sizeof(T) / sizeof(double)),
                         stride = stride_ | 1;
    static_assert(numbers <= stride);
    /// Size of `count` records in doubles.
    static constexpr __host__ __device__ std::size_t size(int count) {
        return static_cast<std::size_t>(dca::packed_numbers(stride, count));
    }
    double* origin;
    __device__ double* record(int i) const { return origin + stride * i + i / 16; }
    __device__ double& number(int i, int n) const { return record(i)[n]; }
    __device__ void store(int i, T const& record) const {
        auto const values = __builtin_bit_cast(Numbers, record);
        CATENA_UNROLL
        for (int n = 0; n < numbers; ++n) number(i, n) = values[n];
    }
    __device__ T load(int i) const {
        Numbers values;
        CATENA_UNROLL
        for (int n = 0; n < numbers; ++n) values[n] = number(i, n);
        return __builtin_bit_cast(T, values);
    }

  private:
    using Numbers = Vector<double, numbers>;
};

/// Calls put(i, get(i)) for i = begin, begin + step, ... below end. It reads `at_once` values
/// before it writes any, which hides the latency of memory.
template <int at_once, class Get, class Put>
__device__ void move_some(int begin, int end, int step, Get const& get, Put const& put) {
    for (int first = begin; first < end; first += at_once * step) {
        decltype(get(first)) value[at_once] = {};
        CATENA_UNROLL
        for (int i = 0; i < at_once; ++i)
            if (first + i * step < end) value[i] = get(first + i * step);
        CATENA_UNROLL
        for (int i = 0; i < at_once; ++i)
            if (first + i * step < end) put(first + i * step, value[i]);
    }
}

/// Sweep whose joined(), part(), read() and descend_part() accept factorizers (FusedSweep).
template <class Sweep>
concept takes_factors = requires(Sweep const& sweep, typename Sweep::Segment const& segment,
                                 typename Sweep::Node& node) {
    sweep.joined(segment, segment, dca::JointAt{}, node, BranchlessFactorizer < Sweep::K == 1 > {});
};
/// Merges two segments, with the branchless factorizer if the sweep accepts one.
template <class Sweep>
__device__ typename Sweep::Segment joined_quickly(Sweep const& sweep,
                                                  typename Sweep::Segment const& inboard,
                                                  typename Sweep::Segment const& outboard,
                                                  dca::JointAt const& at,
                                                  typename Sweep::Node& node) {
    if constexpr (takes_factors<Sweep>)
        return sweep.joined(inboard, outboard, at, node, BranchlessFactorizer < Sweep::K == 1 > {});
    else
        return sweep.joined(inboard, outboard, at, node);
}
/// Reads a part's bodies. `quick`: there are enough registers for the branchless inverse length.
template <bool quick, class Sweep, class Reader = dca::ReadHere>
__device__ typename Sweep::Part read_quickly(Sweep const& sweep, std::int64_t begin,
                                             std::int64_t end, Reader const& by = {}) {
    if constexpr (quick && takes_factors<Sweep>)
        return sweep.read(begin, end, BranchlessInverseLength{}, by);
    else if constexpr (takes_factors<Sweep>)
        return sweep.read(begin, end, dca::InverseLength{}, by);
    else
        return sweep.read(begin, end);
}
/// Eliminates part `p` of a run, with the branchless factorizer if the sweep accepts one.
template <class Sweep, class Part>
__device__ typename Sweep::Segment part_quickly(Sweep const& sweep, dca::Run const& run, int p,
                                                Part const& part) {
    if constexpr (takes_factors<Sweep>)
        return sweep.part(run, p, part, BranchlessFactorizer < Sweep::K == 1 > {});
    else
        return sweep.part(run, p, part);
}

/// Performs the outward pass of part `p` of a run. `passages`: storage for what its joints pass on.
template <bool unroll, class Sweep, class Part, class State, class Passages>
__device__ void down_quickly(Sweep const& sweep, dca::Run const& run, int p, Part const& part,
                             State const& first, State const& next, Passages&& passages) {
    if constexpr (Sweep::K > 1)
        dca::descend_part<unroll>(sweep, run, p, part, first, next, passages,
                                  BranchlessFactorizer<false>{});
    else
        dca::descend_part<unroll>(sweep, run, p, part, first, next, passages);
}

/// Assignment of a block's threads to runs and parts. Thread t has part t / lanes mod parts_of_run
/// of run t mod lanes, in the block's group number t / (lanes parts_of_run). A group has `lanes`
/// runs, so that the threads of a warp proceed in lockstep.
struct RunPart {
    int run, part;
    __device__ RunPart(int thread, int lanes)
        : run(thread / (lanes * dca::parts_of_run) * lanes + thread % lanes),
          part(thread / lanes % dca::parts_of_run) {}
};
/// Number of runs per group.
__device__ inline int lanes_of_block() {
    int const of_part = static_cast<int>(blockDim.x) / dca::parts_of_run;
    return of_part < 32 ? of_part : 32;
}

/// Storage of nodes, each in the place of its part's segment.
template <class Sweep>
using NodesOfParts =
    PackedRecords<typename Sweep::Sweeps::Node, PackedRecords<typename Sweep::Segment>::stride>;
/// Computes the segments of runs `first` + RunPart(...).run, as many as the block's threads can
/// process at once. Calls take(run, segment) by one thread per run. All threads of a block must
/// call it, and there is one thread for every part. `memory` has room for one segment per thread.
/// `part` receives the bodies that a thread read. `nodes_stay`: nodes between parts stay in
/// `memory` for the outward pass in the same launch; otherwise they are stored by joint.
template <bool nodes_stay, class Sweep, class Take>
__device__ void climb_some_runs(RunsView const& runs, std::int64_t first, std::int64_t end,
                                Sweep const& sweep, double* memory, typename Sweep::Part& part,
                                Take const& take) {
    using Segment = typename Sweep::Segment;
    PackedRecords<Segment> const parts{memory};
    int const lanes = lanes_of_block();
    RunPart const mine(static_cast<int>(threadIdx.x), lanes);
    std::int64_t const i = first + mine.run;
    dca::Run run;
    if (i < end) run = runs[i];
    int const count = i < end ? dca::parts_of(run) : 0;
    // Numbers of restricted directions are read now and used when parts are merged.
    std::uint8_t restricted_of[dca::parts_of_run] = {};
    CATENA_UNROLL
    for (int p = 1; p < dca::parts_of_run; ++p)
        if (p < count) restricted_of[p] = sweep.s.restricted[dca::begin_of(run, p)];
    Segment segment;
    if (mine.part < count) {
        part =
            read_quickly<true>(sweep, dca::begin_of(run, mine.part), dca::end_of(run, mine.part));
        segment = part_quickly(sweep, run, mine.part, part);
    }
    if (mine.part > 0 && mine.part < count) parts.store(static_cast<int>(threadIdx.x), segment);
    __syncthreads();
    if (mine.part == 0 && count > 0) {
        // One byte per part avoids an array with a variable index.
        unsigned restricted = 0;
        CATENA_UNROLL
        for (int p = 1; p < dca::parts_of_run; ++p)
            restricted |= static_cast<unsigned>(restricted_of[p]) << (8 * p);
        CATENA_NO_UNROLL
        for (int p = 1; p < count; ++p) {
            int const there = static_cast<int>(threadIdx.x) + lanes * p;
            dca::JointAt const at{dca::begin_of(run, p),
                                  static_cast<int>(restricted >> (8 * p) & 255)};
            if constexpr (Sweep::keeps_nodes) {
                typename Sweep::Node node;
                segment = joined_quickly(sweep, segment, parts.load(there), at, node);
                if constexpr (nodes_stay)
                    NodesOfParts<Sweep>{memory}.store(there, node);
                else
                    sweep.keep(at.k, node);
            } else {
                segment = sweep.joined(segment, parts.load(there), at);
            }
        }
        take(i, segment);
    }
    __syncthreads();
}

/// Storage in shared memory for what the joints of a thread's part pass on, except the last joint.
template <class Sweep>
struct PassagesInMemory {
    static constexpr int most = dca::part_length - 2;
    using Passage = typename Sweep::Passage;
    double* memory;
    /// Size in doubles.
    static __host__ __device__ constexpr std::size_t size(int threads) {
        return most * PackedRecords<Passage>::size(threads);
    }
    __device__ void put(int i, Passage const& passage) const {
        records(i).store(static_cast<int>(threadIdx.x), passage);
    }
    __device__ Passage get(int i) const { return records(i).load(static_cast<int>(threadIdx.x)); }

  private:
    __device__ PackedRecords<Passage> records(int i) const {
        return {memory + i * PackedRecords<Passage>::size(static_cast<int>(blockDim.x))};
    }
};
template <class Sweep>
using BodiesOf = decltype(Sweep::bodies);
/// Sweep that reads a part's bodies one by one, and twice in its outward pass.
template <class Sweep>
concept reads_bodies_twice = requires { requires Sweep::one_by_one; };
/// Storage in shared memory for data that such a sweep needs twice. Data of a thread's bodies are
/// contiguous, with an odd number of doubles, so that threads access different banks. Passages
/// follow, unless they stay in registers.
template <class Sweep, bool passages_too>
class LeftInMemory {
    using Turning = typename BodiesOf<Sweep>::Turning;
    using Passage = typename Sweep::Passage;
    using Passages =
        std::conditional_t<passages_too, PassagesInMemory<Sweep>, typename Sweep::PassagesHere>;
    static __host__ __device__ constexpr std::size_t size_of_turnings(int threads) {
        return static_cast<std::size_t>(of_thread) * static_cast<std::size_t>(threads);
    }

  public:
    static constexpr bool keeps_turnings = true;
    static constexpr int most = Passages::most,
                         of_thread = dca::part_length * numbers_of<Turning> | 1;
    /// Size in doubles.
    static __host__ __device__ constexpr std::size_t size(int threads) {
        std::size_t const turnings = size_of_turnings(threads);
        if constexpr (passages_too)
            return turnings + Passages::size(threads);
        else
            return turnings;
    }
    __device__ explicit LeftInMemory(double* memory) : turnings_(memory + threadIdx.x * of_thread) {
        if constexpr (passages_too)
            passages_.memory = memory + size_of_turnings(static_cast<int>(blockDim.x));
    }
    __device__ void put(int i, Passage const& passage) { passages_.put(i, passage); }
    __device__ Passage get(int i) const { return passages_.get(i); }
    __device__ void keep(int i, Turning const& turning) const {
        auto const values = __builtin_bit_cast(NumbersOf<Turning>, turning);
        CATENA_UNROLL
        for (int n = 0; n < numbers_of<Turning>; ++n)
            turnings_[i * numbers_of<Turning> + n] = values[n];
    }
    __device__ Turning turning(int i) const {
        NumbersOf<Turning> values;
        CATENA_UNROLL
        for (int n = 0; n < numbers_of<Turning>; ++n)
            values[n] = turnings_[i * numbers_of<Turning> + n];
        return __builtin_bit_cast(Turning, values);
    }

  private:
    double* turnings_;
    Passages passages_;
};
/// True if passages stay in registers although there is shared memory for them.
template <class Sweep>
constexpr bool passages_stay = Sweep::K <= 2;
/// True if the memory of one segment per thread has room for a thread's state and for the data of
/// its bodies.
template <class Sweep>
constexpr bool turnings_fit = false;
template <class Sweep>
    requires reads_bodies_twice<Sweep>
constexpr bool turnings_fit<Sweep> =
    PackedRecords<typename Sweep::Sweeps::State>::stride + LeftInMemory<Sweep, false>::of_thread <=
    PackedRecords<typename Sweep::Segment>::stride;

/// True if bodies of runs are prefetched to shared memory. This is faster with spherical joints and
/// slightly slower with others.
template <class Sweep>
constexpr bool prefetches_bodies = false;
template <class Sweep>
    requires reads_bodies_twice<Sweep>
constexpr bool prefetches_bodies<Sweep> = Sweep::K == 3;

/// Size of the block's shared memory for descend_some_runs() in doubles.
template <class Sweep>
constexpr std::size_t numbers_of_descent(int threads) {
    std::size_t const states = PackedRecords<typename Sweep::Sweeps::State>::size(threads);
    if constexpr (reads_bodies_twice<Sweep>)
        return states + LeftInMemory<Sweep, !passages_stay<Sweep>>::size(threads);
    else
        return states;
}

/// Performs the outward pass of the same runs from the forces at their ends, of_first(run, i) and
/// of_next(run, i). A thread computes the force at its part's first joint from the forces of the
/// parts after it. `memory`: one segment per thread, or numbers_of_descent() if `roomy`, that is if
/// registers are scarce. `part`: as left by climb_some_runs(), or null. `nodes_stay`: `memory` is
/// unchanged since climb_some_runs().
template <bool unroll, bool nodes_stay, bool roomy, class Sweep, class OfFirst, class OfNext>
__device__ void descend_some_runs(RunsView const& runs, std::int64_t first_run, std::int64_t end,
                                  Sweep const& sweep, double* memory,
                                  typename Sweep::Part const* part, OfFirst const& of_first,
                                  OfNext const& of_next) {
    using State = typename Sweep::Sweeps::State;
    PackedRecords<State> const at_part{memory};
    int const lanes = lanes_of_block(), here = static_cast<int>(threadIdx.x);
    RunPart const mine(static_cast<int>(threadIdx.x), lanes);
    std::int64_t const i = first_run + mine.run;
    dca::Run run;
    if (i < end) run = runs[i];
    int const count = i < end ? dca::parts_of(run) : 0;
    typename Sweep::Part read;
    typename Sweep::Sweeps::Node node;
    State own, next;
    // All data are read before any of them is used.
    if (mine.part < count) {
        if (!part)
            read = read_quickly<!roomy>(sweep, dca::begin_of(run, mine.part),
                                        dca::end_of(run, mine.part), dca::ReadLast{});
        if constexpr (nodes_stay && Sweep::keeps_nodes) {
            if (mine.part > 0) node = NodesOfParts<Sweep>{memory}.load(here);
        } else {
            if (mine.part > 0) node = sweep.node(dca::begin_of(run, mine.part));
        }
        own = of_first(run, i);
        next = of_next(run, i);
    }
    if constexpr (nodes_stay && Sweep::keeps_nodes) __syncthreads();
    CATENA_NO_UNROLL
    for (int p = dca::parts_of_run - 1; p > 0; --p) {
        if (mine.part == p && p < count) {
            if (p + 1 < count) next = at_part.load(here + lanes);
            own = sweep.force(node, own, next);
            at_part.store(here, own);
        }
        __syncthreads();
    }
    if (mine.part >= count) return;
    if (mine.part == 0 && count > 1) next = at_part.load(here + lanes);
    double* const beyond = memory + PackedRecords<State>::size(static_cast<int>(blockDim.x));
    if constexpr (roomy && reads_bodies_twice<Sweep>)
        down_quickly<unroll && passages_stay<Sweep>>(
            sweep, run, mine.part, part ? *part : read, own, next,
            LeftInMemory<Sweep, !passages_stay<Sweep>>(beyond));
    else if constexpr (turnings_fit<Sweep>)
        down_quickly<unroll && !Sweep::in_loops>(sweep, run, mine.part, part ? *part : read, own,
                                                 next, LeftInMemory<Sweep, false>(beyond));
    else if constexpr (takes_factors<Sweep>)
        down_quickly<unroll && !Sweep::in_loops>(sweep, run, mine.part, part ? *part : read, own,
                                                 next, typename Sweep::PassagesHere{});
    else
        sweep.template down<unroll>(run, mine.part, part ? *part : read, own, next);
}

}  // namespace catena::cuda::kernels
