// One chain that fits into one cluster of blocks, up and down its tree in one launch. A lane takes a part of a run, a warp eight runs,
// which it joins by itself; then every warp is given the segments of all of them and joins those as well, so that nobody waits twice.
// Bodies that are read one by one have more warps beside: what needs no neighbour is done for all bodies at once.
#pragma once

#include <bit>
#include <type_traits>
#include <vector>

#include "cuda/cluster.cuh"
#include "cuda/quick.cuh"
#include "cuda/stage_kernels.cuh"

namespace catena::cuda::kernels {

constexpr int lanes_of_warp = 32, most_joining_warps = 4, most_blocks_of_short = 16;
constexpr int bodies_of_warp = lanes_of_warp * dca::part_length;
/// Of those at the top every lane takes one or two.
constexpr int most_warps_of_short = 2 * lanes_of_warp;
static_assert(most_warps_of_short <= most_blocks_of_short * most_joining_warps);
static_assert(std::has_single_bit(static_cast<unsigned>(lanes_of_warp)));
/// Of a tree of pairs with so many leaves, a power of two.
constexpr int levels_above(int leaves) { return std::bit_width(static_cast<unsigned>(leaves)) - 1; }

/// `warps`, that join; none: there is none, or one that is not short.
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
    static constexpr int levels_of_warp = levels_above(lanes_of_warp / dca::parts_of_run), most_levels_of_top = levels_above(lanes_of_warp);
    static constexpr int steps_of_warp = dca::parts_of_run - 1 + levels_of_warp;
    static_assert(std::has_single_bit(static_cast<unsigned>(dca::parts_of_run)));
    static constexpr int pitch = lanes_of_warp + 1;
    struct Ends {
        State first, next;
    };

  public:
    static constexpr bool one_by_one = Sweep::one_by_one;
    /// Warps beside every one that joins, itself included: few enough that all threads have as many registers as they may.
    static constexpr int warps_beside(int joining) { return !one_by_one ? 1 : joining <= 2 ? 4 : 2; }
    static constexpr int most_threads = (one_by_one ? 2 : 1) * most_joining_warps * lanes_of_warp;
    /// Numbers of a block of so many warps that join, and of a launch of so many.
    static constexpr std::size_t numbers(int joining, int warps) {
        return 2 + static_cast<std::size_t>(numbers_of<Segment>) * static_cast<std::size_t>(warps) +
               static_cast<std::size_t>(joining) * of_warp;
    }
    __device__ ShortWarp(ShortChain const& chain, Sweep const& sweep, double* memory)
        : chain_(chain),
          sweep_(sweep),
          lane_(static_cast<int>(threadIdx.x) % lanes_of_warp),
          joining_(joining_in_block(chain)),
          beside_(static_cast<int>(threadIdx.x) / lanes_of_warp / joining_),
          warp_(static_cast<int>(blockIdx.x) * joining_ + static_cast<int>(threadIdx.x) / lanes_of_warp % joining_),
          inbox_(reinterpret_cast<std::uint64_t*>(memory)),
          segments_(memory + 2),
          own_(segments_ + numbers_of<Segment> * chain.warps + static_cast<int>(threadIdx.x) / lanes_of_warp % joining_ * of_warp) {}

    __device__ void open() const {
        if (threadIdx.x == 0) inbox_.open(static_cast<int>(sizeof(Segment)) * chain_.warps);
        __syncwarp();
        arrive_at_cluster();
    }
    __device__ void turn() const {
        Kept kept{own_ + of_nodes};
        Place const here = place();
        if constexpr (one_by_one) {
            int const beside = static_cast<int>(blockDim.x) / lanes_of_warp / joining_;
            std::int64_t const begin = (static_cast<std::int64_t>(warp_) * lanes_of_warp + lane_) * dca::part_length;
            auto const is_here = [&](int i) { return i < dca::part_length && begin + i < chain_.bodies; };
            CATENA_NO_UNROLL
            for (int i = beside_; is_here(i); i += beside) kept.put(i, sweep_.bodies.segment(body(begin + i), Factors{}));
            __syncthreads();
            wait_for_cluster();
            if (beside_ == 0) join(here, kept);
            typename Sweep::Body next;
            if (is_here(beside_)) next = body(begin + beside_);
            __syncthreads();
            CATENA_NO_UNROLL
            for (int i = beside_; is_here(i); i += beside) {
                typename Sweep::Body const own = next;
                if (is_here(i + beside)) next = body(begin + i + beside);
                Ends const ends = kept.template get<Ends>(i);
                sweep_.accelerate(begin + i, own, ends.first, ends.next, Factors{});
            }
        } else {
            join(here, kept);
        }
    }

  private:
    using Passed = typename Sweep::Passed;
    using Factors = QuickFactors<Sweep::K == 1 && !one_by_one>;
    using Passage = typename Sweep::Passage;
    /// Of a lane's bodies: in registers where there are few, else in shared memory, in turn in the same place.
    class InRegisters {
      public:
        static constexpr int numbers = 0;
        __device__ explicit InRegisters(double*) {}
        __device__ void put(int i, Passed const& joint) { passed_[i] = joint; }
        __device__ void put(int i, Passage const& passage) { passages_[i] = passage; }
        template <class T>
        __device__ T const& get(int i) const {
            if constexpr (std::is_same_v<T, Passed>)
                return passed_[i];
            else
                return passages_[i];
        }

      private:
        Passed passed_[dca::part_length];
        Passage passages_[dca::part_length];
    };
    class InMemory {
      public:
        static constexpr int of_body = numbers_of<Segment> * pitch, numbers = dca::part_length * of_body;
        static_assert(sizeof(Passed) <= sizeof(Segment) && sizeof(Passage) <= sizeof(Segment));
        __device__ explicit InMemory(double* of_warp) : memory_(of_warp + threadIdx.x % lanes_of_warp) {}
        template <class T>
        __device__ void put(int i, T const& value) {
            keep(memory_ + i * of_body, 0, value);
        }
        template <class T>
        __device__ T get(int i) const {
            return kept<T>(memory_ + i * of_body, 0);
        }

      private:
        double* memory_;
    };
    using Kept = std::conditional_t<one_by_one, InMemory, InRegisters>;
    static constexpr int of_nodes = 3 * numbers_of<Node> * pitch;  // of the warp's lanes, of those of the top and within these
    static constexpr int of_warp = of_nodes + Kept::numbers;
    __device__ static int joining_in_block(ShortChain const& chain) {
        auto const blocks = static_cast<int>(gridDim.x);
        return (chain.warps + blocks - 1) / blocks;
    }
    __device__ typename Sweep::Body body(std::int64_t k) const { return sweep_.bodies.body(sweep_.read(k, k + 1), 0); }
    /// What a lane joins, and how many directions the joints restrict: read first of all.
    struct Place {
        dca::Run run;
        int part, parts, count, unit;  // `unit`: warps a lane of the top
        std::int64_t begin;
        int restricted[dca::part_length], at_top[2];
    };
    __device__ Place place() const {
        Place p;
        p.run = run_here();
        p.part = lane_ % dca::parts_of_run;
        p.parts = p.run.count > 0 ? dca::parts_of(p.run) : 0;
        p.begin = dca::begin_of(p.run, p.part);
        p.count = p.part < p.parts ? static_cast<int>(dca::end_of(p.run, p.part) - p.begin) : 0;
        p.unit = (chain_.warps + lanes_of_warp - 1) / lanes_of_warp;
        CATENA_UNROLL
        for (int i = 0; i < (one_by_one ? dca::part_length : 1); ++i)
            p.restricted[i] = i < p.count && beside_ == 0 ? sweep_.s.restricted[p.begin + i] : 0;
        CATENA_UNROLL
        for (int i = 0; i < 2; ++i) {
            int const warp = p.unit * lane_ + i;
            p.at_top[i] = warp < chain_.warps && beside_ == 0 ? sweep_.s.restricted[warp * bodies_of_warp] : 0;
        }
        return p;
    }
    /// What the warps do that join: up and down again.
    __device__ void join(Place const& here, Kept& kept) const {
        typename Sweep::Part read;
        Segment segment{};
        if constexpr (one_by_one) {
            static_assert(dca::part_length == 4);
            auto const restricted = [&](int i) {  // no array with a place that varies
                return i == 1 ? here.restricted[1] : i == 2 ? here.restricted[2] : here.restricted[3];
            };
            if (here.count > 0) segment = sweep_.join_bodies(here.begin, here.count, restricted, kept, Factors{});
        } else if (here.count > 0) {
            read = sweep_.read(here.begin, here.begin + here.count, QuickInverseLength{});
            segment = sweep_.part(here.begin, here.count, read, kept, Factors{});
        }
        climb<steps_of_warp>(segment, own_, warp_ * lanes_of_warp, dca::part_length, here.restricted[0], steps_of_warp,
                             [](int step) { return Meeting::of_parts(step); });
        if constexpr (!one_by_one) wait_for_cluster();
        if (warp_ >= chain_.warps) return;
        give(segment);
        __syncwarp();
        inbox_.wait();
        Ends ends = solve_top(here.unit, here.at_top);
        each_step<levels_of_warp, true>(
            levels_of_warp, [&](int level) { go_down(ends, dca::parts_of_run << level, own_, warp_ * lanes_of_warp, dca::part_length); });
        State first = ends.first;
        each_step<dca::parts_of_run, true>(dca::parts_of_run, [&](int p) {
            if (p == 0 || p >= here.parts) return;
            State const there = sweep_.force(node(own_, lane_ - here.part + p), ends.first, ends.next);
            first = here.part == p ? there : first;
            ends.next = here.part < p ? there : ends.next;
        });
        sweep_.forces(here.count, kept, first, ends.next, [&](int i, State const& inboard, State const& outboard) {
            if constexpr (one_by_one)
                kept.put(i, Ends{inboard, outboard});
            else
                sweep_.accelerate(here.begin + i, sweep_.bodies.body(read, i), inboard, outboard, Factors{});
        });
    }
    __device__ dca::Run run_here() const {
        std::int64_t const body = (warp_ * (lanes_of_warp / dca::parts_of_run) + lane_ / dca::parts_of_run) * dca::longest_run;
        std::int64_t const left = chain_.bodies - body;
        return {body, left < dca::longest_run ? left : dca::longest_run, 0, 0};
    }
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
                    segment = sweep_.joined(inboard, segment, {joint, of_joint}, found, Factors{});
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
    __device__ Ends solve_top(int unit, int const (&restricted)[2]) const {
        double *const nodes = own_ + numbers_of<Node> * pitch, *const within = nodes + numbers_of<Node> * pitch;
        Segment segment{};
        if (unit * lane_ < chain_.warps) segment = given(unit * lane_);
        bool const two = unit > 1 && unit * lane_ + 1 < chain_.warps;
        if (two) {
            Node found;
            segment = sweep_.joined(segment, given(unit * lane_ + 1), {(unit * lane_ + 1) * bodies_of_warp, restricted[1]}, found, Factors{});
            keep(within, lane_, found);
        }
        int levels = 0;
        while ((unit << levels) < chain_.warps) ++levels;
        climb<most_levels_of_top>(segment, nodes, 0, unit * bodies_of_warp, restricted[0], levels,
                                  [](int level) { return Meeting::of_pairs(1 << level); });
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
    int lane_, joining_, beside_, warp_;
    Inbox inbox_;
    double *segments_, *own_;
};

struct ShortGrid {
    unsigned blocks = 0, threads = 0;
    std::size_t shared_bytes = 0;
};
/// As few warps a block as there may be: each then has more of a multiprocessor.
template <class Sweep>
ShortGrid grid_of_short(ShortChain const& chain) {
    using Warp = ShortWarp<Sweep>;
    constexpr int crowded = Sweep::K > 3 ? 1 : Warp::one_by_one ? 2 : most_joining_warps;
    int const most = chain.warps > most_in_cluster * crowded ? most_blocks_of_short : most_in_cluster;
    int const joining = (chain.warps + most - 1) / most, blocks = (chain.warps + joining - 1) / joining;
    return {static_cast<unsigned>(blocks), static_cast<unsigned>(lanes_of_warp * joining * Warp::warps_beside(joining)),
            sizeof(double) * Warp::numbers(joining, chain.warps)};
}
/// The next early launch may start before this one has ended; what it reads and writes waits.
template <class Sweep>
__global__ void __launch_bounds__(ShortWarp<Sweep>::most_threads) turn_short(ShortChain chain, Sweep sweep) {
    let_next_launch_start();
    ShortWarp<Sweep> const warp(chain, sweep, shared_numbers);
    warp.open();
    wait_for_launch();
    warp.turn();
}

}  // namespace catena::cuda::kernels
