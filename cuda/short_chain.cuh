// One chain that fits into one cluster of blocks, up and down its tree in one launch. A lane takes a part of a run, a warp eight runs,
// which it joins by itself; then every warp is given the segments of all of them and joins those as well, so that nobody waits twice.
#pragma once

#include <type_traits>
#include <vector>

#include "cuda/cluster.cuh"
#include "cuda/stage_kernels.cuh"

namespace catena::cuda::kernels {

constexpr int lanes_of_warp = 32, most_threads_of_short = 128, most_blocks_of_short = 16;
constexpr int bodies_of_warp = lanes_of_warp * dca::part_length;
/// Of those at the top every lane takes one or two.
constexpr int most_warps_of_short = 2 * lanes_of_warp;
static_assert(most_warps_of_short <= most_blocks_of_short * most_threads_of_short / lanes_of_warp);

/// No warps: none, or one that is not short.
struct ShortChain {
    int bodies = 0, warps = 0;
};
/// That of a tree of one whole chain whose tip is free, in runs as long as they get.
inline ShortChain short_chain_of(std::vector<dca::Run> const& runs, std::vector<std::vector<dca::Merge>> const& levels,
                                 std::vector<dca::Root> const& roots) {
    if (runs.empty() || roots.size() != 1 || roots.front().tip != dca::TipTo::nothing) return {};
    std::int64_t const bodies = runs.back().body + runs.back().count;
    std::size_t joined = 1;
    for (std::vector<dca::Merge> const& level : levels) joined += level.size();
    bool const whole = runs.front().body == 0 && joined == runs.size();
    bool const longest = (bodies + dca::longest_run - 1) / dca::longest_run == std::ssize(runs);
    if (!whole || !longest || bodies > most_warps_of_short * bodies_of_warp) return {};
    return {static_cast<int>(bodies), static_cast<int>((bodies + bodies_of_warp - 1) / bodies_of_warp)};
}

/// One meeting of lanes: lane l of those with l & mask == last joins what lane l - distance has to its own; all that lie between them count
/// to its own.
struct Meeting {
    int distance, mask, last;
    /// Parts of runs one after the other, then pairs.
    __device__ static Meeting of_parts(int step) {
        constexpr int in_run = dca::parts_of_run - 1;
        if (step < in_run) return {1, dca::parts_of_run - 1, step + 1};
        return of_pairs(dca::parts_of_run << (step - in_run));
    }
    __device__ static Meeting of_pairs(int distance) { return {distance, 2 * distance - 1, 2 * distance - 1}; }
};

/// Of one warp, in its block's shared memory.
template <class Sweep>
class ShortWarp {
    using Segment = typename Sweep::Segment;
    using Node = typename Sweep::Node;
    using State = typename Sweep::Sweeps::State;
    static constexpr int levels_of_warp = 3, steps_of_warp = dca::parts_of_run - 1 + levels_of_warp, most_levels_of_top = 5;
    static constexpr int pitch = lanes_of_warp + 1;
    struct Ends {
        State first, next;
    };

  public:
    /// Numbers of a block of so many threads, and of a launch of so many warps.
    static constexpr std::size_t numbers(int of_threads, int warps) {
        return 2 + static_cast<std::size_t>(numbers_of<Segment>) * static_cast<std::size_t>(warps) +
               static_cast<std::size_t>(of_threads / lanes_of_warp) * of_warp;
    }
    __device__ ShortWarp(ShortChain const& chain, Sweep const& sweep, double* memory)
        : chain_(chain),
          sweep_(sweep),
          lane_(static_cast<int>(threadIdx.x) % lanes_of_warp),
          warp_(static_cast<int>(thread()) / lanes_of_warp),
          inbox_(reinterpret_cast<std::uint64_t*>(memory)),
          segments_(memory + 2),
          own_(segments_ + numbers_of<Segment> * chain.warps + static_cast<int>(threadIdx.x) / lanes_of_warp * of_warp) {}

    __device__ void open() const {
        if (threadIdx.x == 0) inbox_.open(static_cast<int>(sizeof(Segment)) * chain_.warps);
        arrive_at_cluster();
    }
    template <class Clock>
    __device__ void turn(Clock const& clock) const {
        dca::Run const run = run_here();
        int const part = lane_ % dca::parts_of_run, parts = run.count > 0 ? dca::parts_of(run) : 0;
        bool const mine = part < parts;
        int const restricted = mine ? sweep_.s.restricted[dca::begin_of(run, part)] : 0;
        int const unit = (chain_.warps + lanes_of_warp - 1) / lanes_of_warp;  // warps a lane of the top
        int const restricted_top[2] = {restricted_at(unit * lane_), restricted_at(unit * lane_ + 1)};
        typename Sweep::Part read;
        Segment segment{};
        Kept kept{own_ + of_nodes};
        if (mine) {
            read = sweep_.read(dca::begin_of(run, part), dca::end_of(run, part));
            segment = sweep_.part(run, part, read, kept);
        }
        clock(1);
        climb<steps_of_warp>(segment, own_, warp_ * lanes_of_warp, dca::part_length, restricted, steps_of_warp,
                             [](int step) { return Meeting::of_parts(step); });
        clock(2);
        wait_for_cluster();
        if (warp_ >= chain_.warps) return;
        give(segment);
        __syncwarp();
        inbox_.wait();
        clock(3);
        Ends ends = solve_top(unit, restricted_top, clock);
        clock(5);
        each_step<levels_of_warp, true>(
            levels_of_warp, [&](int level) { go_down(ends, dca::parts_of_run << level, own_, warp_ * lanes_of_warp, dca::part_length); });
        State begin = ends.first;
        each_step<dca::parts_of_run, true>(dca::parts_of_run, [&](int p) {
            if (p == 0 || p >= parts) return;
            State const there = sweep_.force(node(own_, lane_ - part + p), ends.first, ends.next);
            begin = part == p ? there : begin;
            ends.next = part < p ? there : ends.next;
        });
        clock(6);
        if (mine) sweep_.template down<false>(run, part, read, kept, begin, ends.next);
        clock(7);
    }

  private:
    using Passed = typename Sweep::Passed;
    /// Of a lane's bodies: in registers where there are few, else in shared memory.
    struct InRegisters {
        static constexpr int numbers = 0;
        Passed passed[dca::part_length];
        __device__ explicit InRegisters(double*) {}
        __device__ void put(int i, Passed const& joint) { passed[i] = joint; }
        __device__ Passed const& get(int i) const { return passed[i]; }
    };
    struct InMemory {
        static constexpr int numbers = dca::part_length * numbers_of<Passed> * pitch;
        double* memory;
        __device__ explicit InMemory(double* of_warp) : memory(of_warp + threadIdx.x % lanes_of_warp) {}
        __device__ void put(int i, Passed const& joint) { keep(memory + i * numbers_of<Passed> * pitch, 0, joint); }
        __device__ Passed get(int i) const { return kept<Passed>(memory + i * numbers_of<Passed> * pitch, 0); }
    };
    using Kept = std::conditional_t<dca::unrolled<Sweep::K>, InRegisters, InMemory>;
    static constexpr int of_nodes = 3 * numbers_of<Node> * pitch;  // of the warp's lanes, of those of the top and within these
    static constexpr int of_warp = of_nodes + Kept::numbers;
    __device__ dca::Run run_here() const {
        std::int64_t const body = (warp_ * (lanes_of_warp / dca::parts_of_run) + lane_ / dca::parts_of_run) * dca::longest_run;
        std::int64_t const left = chain_.bodies - body;
        return {body, left < dca::longest_run ? left : dca::longest_run, 0, 0};
    }
    __device__ int restricted_at(int warp) const { return warp < chain_.warps ? sweep_.s.restricted[warp * bodies_of_warp] : 0; }
    template <class T>
    __device__ static T kept(double const* memory, int i) {
        NumbersOf<T> values;
        CATENA_UNROLL
        for (int n = 0; n < numbers_of<T>; ++n) values[n] = memory[n * pitch + i];
        return __builtin_bit_cast(T, values);
    }
    template <class T>
    __device__ static void keep(double* memory, int i, T const& value) {
        auto const values = __builtin_bit_cast(NumbersOf<T>, value);
        CATENA_UNROLL
        for (int n = 0; n < numbers_of<T>; ++n) memory[n * pitch + i] = values[n];
    }
    __device__ static Node node(double const* nodes, int i) { return kept<Node>(nodes, i); }
    /// action(s) for s of [0, steps), or back.
    template <int most, bool back = false, class Action>
    __device__ static void each_step(int steps, Action const& action) {
        if constexpr (dca::unrolled<Sweep::K>) {
            CATENA_UNROLL
            for (int i = 0; i < most; ++i)
                if (int const s = back ? most - 1 - i : i; s < steps) action(s);
        } else {
            CATENA_NO_UNROLL
            for (int i = 0; i < steps; ++i) action(back ? steps - 1 - i : i);
        }
    }
    /// Lane l has the segment from body (first + l) `length` on. What is joined is with the last of those who met.
    template <int most, class Step>
    __device__ void climb(Segment& segment, double* nodes, int first, int length, int restricted, int steps, Step const& step) const {
        each_step<most>(steps, [&](int s) {
            Meeting const m = step(s);
            Segment const inboard = from_lane(segment, lane_ - m.distance);
            int const at = lane_ - m.distance + 1, of_joint = __shfl_sync(0xffffffffu, restricted, at);
            std::int64_t const joint = static_cast<std::int64_t>(first + at) * length;
            if ((lane_ & m.mask) == m.last) {
                if (joint < chain_.bodies) {
                    Node found;
                    segment = sweep_.joined(inboard, segment, {joint, of_joint}, found);
                    keep(nodes, at, found);
                } else {
                    segment = inboard;
                }
            }
        });
        __syncwarp();
    }
    /// Of what lanes [l, l + 2 distance) hold together to those of one half.
    __device__ void go_down(Ends& ends, int distance, double const* nodes, int first, int length) const {
        int const middle = (lane_ & ~(2 * distance - 1)) + distance;
        if (static_cast<std::int64_t>(first + middle) * length >= chain_.bodies) return;
        State const there = sweep_.force(node(nodes, middle), ends.first, ends.next);
        (lane_ < middle ? ends.next : ends.first) = there;
    }
    /// The last lane's segment, to all blocks.
    __device__ void give(Segment const& segment) const {
        double* const letter = own_ + numbers_of<Node> * pitch;  // free till the top is climbed
        if (lane_ == lanes_of_warp - 1) {
            auto const values = __builtin_bit_cast(NumbersOf<Segment>, segment);
            CATENA_UNROLL
            for (int n = 0; n < numbers_of<Segment>; ++n) letter[n] = values[n];
        }
        __syncwarp();
        auto const blocks = static_cast<int>(gridDim.x);
        for (int n = lane_; n < numbers_of<Segment>; n += lanes_of_warp)
            for (int block = 0; block < blocks; ++block) inbox_.send(block, segments_ + n * chain_.warps + warp_, letter[n]);
    }
    __device__ Segment given(int warp) const {
        NumbersOf<Segment> values;
        CATENA_UNROLL
        for (int n = 0; n < numbers_of<Segment>; ++n) values[n] = segments_[n * chain_.warps + warp];
        return __builtin_bit_cast(Segment, values);
    }
    /// The forces at the ends of this warp.
    template <class Clock>
    __device__ Ends solve_top(int unit, int const (&restricted)[2], Clock const& clock) const {
        double *const nodes = own_ + numbers_of<Node> * pitch, *const within = nodes + numbers_of<Node> * pitch;
        Segment segment{};
        if (unit * lane_ < chain_.warps) segment = given(unit * lane_);
        bool const two = unit > 1 && unit * lane_ + 1 < chain_.warps;
        if (two) {
            Node found;
            segment = sweep_.joined(segment, given(unit * lane_ + 1), {(unit * lane_ + 1) * bodies_of_warp, restricted[1]}, found);
            keep(within, lane_, found);
        }
        int levels = 0;
        while ((unit << levels) < chain_.warps) ++levels;
        climb<most_levels_of_top>(segment, nodes, 0, unit * bodies_of_warp, restricted[0], levels,
                                  [](int level) { return Meeting::of_pairs(1 << level); });
        clock(4);
        int const restricted_of_first = __shfl_sync(0xffffffffu, restricted[0], 0);
        Ends ends{State::zero(), State::zero()};
        if (lane_ == (1 << levels) - 1) ends.first = sweep_.first_force({0, restricted_of_first}, segment);
        ends.first = from_lane(ends.first, (1 << levels) - 1);
        each_step<most_levels_of_top, true>(levels, [&](int level) { go_down(ends, 1 << level, nodes, 0, unit * bodies_of_warp); });
        if (two) {
            State const there = sweep_.force(node(within, lane_), ends.first, ends.next);
            (unit * lane_ == warp_ ? ends.next : ends.first) = there;
        }
        return from_lane(ends, warp_ / unit);
    }

    ShortChain const& chain_;
    Sweep const& sweep_;
    int lane_, warp_;
    Inbox inbox_;
    double *segments_, *own_;
};

struct NoClock {
    __device__ void operator()(int) const {}
};
/// The sweeps that keep what they find where they find it, and leave nothing for others.
template <class Sweep>
constexpr bool takes_short_chains = Sweep::keeps_nodes;

struct ShortGrid {
    unsigned blocks = 0, threads = 0;
    std::size_t shared_bytes = 0;
};
/// As few warps a block as there may be: each then has more of a multiprocessor.
template <class Sweep>
ShortGrid grid_of_short(ShortChain const& chain) {
    int const most = chain.warps > most_in_cluster * most_threads_of_short / lanes_of_warp ? most_blocks_of_short : most_in_cluster;
    int const warps = (chain.warps + most - 1) / most, blocks = (chain.warps + warps - 1) / warps, of_block = lanes_of_warp * warps;
    return {static_cast<unsigned>(blocks), static_cast<unsigned>(of_block),
            sizeof(double) * ShortWarp<Sweep>::numbers(of_block, chain.warps)};
}
/// The next such launch may start before this one has ended; what it reads and writes waits.
template <class Sweep>
__global__ void __launch_bounds__(most_threads_of_short) turn_short(ShortChain chain, Sweep sweep) {
    let_next_launch_start();
    ShortWarp<Sweep> const warp(chain, sweep, shared_numbers);
    warp.open();
    wait_for_launch();
    warp.turn(NoClock{});
}

}  // namespace catena::cuda::kernels
