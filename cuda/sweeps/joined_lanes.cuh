// What lanes hold of one chain whose handles carry one direction: a lane joins what it holds to
// what another lane has, in registers, and without branches. Every warp is given the segments of
// all of them and joins those as well, so that nobody waits twice.
#pragma once

#include "cuda/sweeps/branchless_math.cuh"
#include "cuda/sweeps/one_chain.cuh"

namespace catena::cuda::kernels {

/// action(s) for s of [0, steps), or back.
template <int steps, bool back = false, class Action>
__device__ void each_step(Action const& action) {
    CATENA_UNROLL
    for (int i = 0; i < steps; ++i) action(back ? steps - 1 - i : i);
}

/// A warp's records in memory, number n of lane i at n pitch + i: lanes do not meet in a bank.
struct OfLanes {
    static constexpr int pitch = lanes_of_warp + 1;
    template <class T>
    static constexpr int size = numbers_of<T> * pitch;
    template <class T>
    __device__ static T load(double const* memory, int i) {
        NumbersOf<T> values;
        CATENA_UNROLL
        for (int n = 0; n < numbers_of<T>; ++n) values[n] = memory[n * pitch + i];
        return __builtin_bit_cast(T, values);
    }
    template <class T>
    __device__ static void store(double* memory, int i, T const& value) {
        auto const values = __builtin_bit_cast(NumbersOf<T>, value);
        CATENA_UNROLL
        for (int n = 0; n < numbers_of<T>; ++n) memory[n * pitch + i] = values[n];
    }
};

/// One meeting of lanes: lane l of those with l & mask == last joins what lane l - distance has to its own; all that lie between them count
/// to its own. `others`: whether some have theirs for a later one.
struct Meeting {
    int distance, mask, last;
    bool others;
    /// `in_row` lanes one after the other, then pairs.
    template <int in_row>
    __device__ static Meeting of_row(int step) {
        constexpr int steps = in_row - 1;
        if (step < steps) return {1, in_row - 1, step + 1, step + 1 < steps};
        return of_pairs(in_row << (step - steps));
    }
    __device__ static Meeting of_pairs(int distance) { return {distance, 2 * distance - 1, 2 * distance - 1, false}; }
};

/// Of a warp whose lanes have a segment of `of_lane` bodies each; `in_row` neighbours are joined one after the other, then pairs of these.
template <class Sweep, int of_lane, int in_row>
class JoinedLanes {
    static_assert(Sweep::K == 1);
    static_assert(std::has_single_bit(static_cast<unsigned>(in_row)));
    using Segment = typename Sweep::Segment;
    using Node = typename Sweep::Node;
    using State = typename Sweep::Sweeps::State;
    using Factorizer = BranchlessFactorizer<true>;
    static constexpr int levels_of_warp = levels_above(lanes_of_warp / in_row), most_levels_of_top = levels_above(lanes_of_warp);
    static constexpr int steps_of_warp = in_row - 1 + levels_of_warp, bodies_of_warp = lanes_of_warp * of_lane;

  public:
    /// Forces at a segment's first joint and at the one after it.
    struct Ends {
        State first, next;
    };
    /// Numbers of shared memory: of a block in a launch of so many warps, and of each warp of its own.
    static constexpr __host__ __device__ int of_block(int warps) { return 2 + numbers_of<Segment> * warps; }
    static constexpr int of_warp = 3 * OfLanes::size<Node>;  // nodes of the warp's lanes, of those of the top and within these

    /// Warp `warp` of the chain's; `shared` is its block's.
    __device__ JoinedLanes(OneChain const& chain, Sweep const& sweep, int lane, int warp, double* shared, double* own)
        : chain_(chain),
          sweep_(sweep),
          lane_(lane),
          warp_(warp),
          inbox_(reinterpret_cast<std::uint64_t*>(shared)),
          segments_(shared + 2),
          own_(own),
          unit_((chain.warps + lanes_of_warp - 1) / lanes_of_warp) {}

    /// By all threads of the cluster, before any joins: these ask for what the top is joined by.
    __device__ void open(bool joins) {
        if (threadIdx.x == 0 && !is_alone(chain_)) inbox_.open(static_cast<int>(sizeof(Segment)) * chain_.warps);
        __syncwarp();
        arrive_at_cluster();
        CATENA_UNROLL
        for (int i = 0; i < 2; ++i) {
            int const warp = unit_ * lane_ + i;
            at_top_[i] = warp < chain_.warps && joins ? sweep_.s.restricted[warp * bodies_of_warp] : 0;
        }
    }
    /// Up from what each lane has, zero() if nothing, and down again: down(Ends) where the warp has bodies. `restricted`: directions that
    /// the lane's first joint restricts. All blocks' open() lies behind (wait_for_cluster()).
    template <class Down>
    __device__ void turn(Segment segment, int restricted, Down const& down) const {
        climb<steps_of_warp>(segment, own_, warp_ * lanes_of_warp, of_lane, restricted,
                             [](int step) { return Meeting::of_row<in_row>(step); });
        if (warp_ >= chain_.warps) return;
        give(segment);
        int const place = lane_ % in_row;  // in the row
        auto const of_levels = nodes_of_levels<levels_of_warp>(own_, in_row);
        auto const of_row = nodes_of<in_row - 1>(own_, [second = lane_ - place + 1](int i) { return second + i; });
        if (!is_alone(chain_)) inbox_.wait();
        Ends ends = solve_top();
        go_down(ends, of_levels, warp_ * lanes_of_warp, of_lane);
        Ends own = ends;
        each_step<in_row - 1, true>([&](int i) {
            int const there = of_row.lane(i);
            bool const exists = (warp_ * lanes_of_warp + there) * of_lane < chain_.bodies;
            State const force = sweep_.force(of_row[i], ends.first, own.next);
            own.first = dca::either(lane_ == there && exists, force, own.first);
            own.next = dca::either(lane_ < there && exists, force, own.next);
        });
        down(own);
    }

  private:
    /// Lane l has the segment from body (first + l) `length` on. What is joined is with the last of those who met.
    template <int steps, class Step>
    __device__ void climb(Segment& segment, double* nodes, int first, int length, int restricted, Step const& step) const {
        bool sure = true;
        Segment quickly = segment;
        unsigned const restricts = __ballot_sync(whole_warp, restricted > 0);  // where there is no joint, none
        each_step<steps>([&](int s) {
            Meeting const m = step(s);
            int const lane = lane_ - m.distance + 1;
            bool const meets = (lane_ & m.mask) == m.last, exists = (first + lane) * length < chain_.bodies;
            Segment const inboard = from_lane(quickly, lane_ - m.distance);
            Node found;
            bool sure_here = true;
            Segment joined = sweep_.joined_at_once(inboard, quickly, static_cast<int>(restricts >> (lane & (lanes_of_warp - 1)) & 1), found,
                                                   UncheckedFactorizer{sure_here});
            if (!exists) joined.bias.b1 = inboard.bias.b1;
            if (meets && exists) OfLanes::store(nodes, lane, found);
            sure = sure && (!meets || sure_here);
            quickly = m.others ? dca::either(meets, joined, quickly) : joined;
        });
        __syncwarp();
        if (__all_sync(whole_warp, sure)) {
            segment = quickly;
            return;
        }
        CATENA_NO_UNROLL
        for (int s = 0; s < steps; ++s) {
            Meeting const m = step(s);
            int const lane = lane_ - m.distance + 1, of_joint = __shfl_sync(whole_warp, restricted, lane);
            std::int64_t const joint = (first + lane) * length;
            Segment const inboard = from_lane(segment, lane_ - m.distance);
            if ((lane_ & m.mask) != m.last) continue;
            if (joint < chain_.bodies) {
                Node found;
                segment = sweep_.joined(inboard, segment, {joint, of_joint}, found);
                OfLanes::store(nodes, lane, found);
            } else {
                segment = inboard;
            }
        }
        __syncwarp();
    }
    /// Nodes that a lane goes down by, the i-th with lane `lane(i)`, read before they are wanted.
    template <int count, class Lane>
    struct Nodes {
        Lane lane;
        Node node[count > 0 ? count : 1];
        __device__ Nodes(double const* nodes, Lane const& lane_of) : lane(lane_of) {
            each_step<count>([&](int i) { node[i] = OfLanes::load<Node>(nodes, lane(i)); });
        }
        __device__ Node const& operator[](int i) const { return node[i]; }
    };
    template <int count, class Lane>
    __device__ static Nodes<count, Lane> nodes_of(double const* nodes, Lane const& lane) {
        return {nodes, lane};
    }
    /// Of pairs of `lanes` lanes each, twice as many, ...
    template <int levels>
    __device__ auto nodes_of_levels(double const* nodes, int lanes) const {
        return nodes_of<levels>(nodes,
                                [lane = lane_, lanes](int level) { return (lane & ~(2 * (lanes << level) - 1)) + (lanes << level); });
    }
    /// From what a lane's pair holds together to what it holds itself, level by level.
    template <int levels, class Lane>
    __device__ void go_down(Ends& ends, Nodes<levels, Lane> const& nodes, int first, int length) const {
        each_step<levels, true>([&](int level) {
            int const middle = nodes.lane(level);
            bool const exists = (first + middle) * length < chain_.bodies;
            State const there = sweep_.force(nodes[level], ends.first, ends.next);
            ends.next = dca::either(exists && lane_ < middle, there, ends.next);
            ends.first = dca::either(exists && lane_ >= middle, there, ends.first);
        });
    }
    /// The last lane's segment, to all blocks.
    __device__ void give(Segment const& segment) const {
        double* const letter = own_ + OfLanes::size<Node>;  // free till the top is climbed
        if (lane_ == lanes_of_warp - 1) {
            auto const values = __builtin_bit_cast(NumbersOf<Segment>, segment);
            CATENA_UNROLL
            for (int n = 0; n < numbers_of<Segment>; ++n) letter[n] = values[n];
        }
        __syncwarp();
        send_to_all<numbers_of<Segment>>(chain_, inbox_, lane_, letter, [&](int n) { return segments_ + n * chain_.warps + warp_; });
        __syncwarp();  // the top's nodes come there
    }
    __device__ Segment given(int warp) const {
        NumbersOf<Segment> values;
        CATENA_UNROLL
        for (int n = 0; n < numbers_of<Segment>; ++n) values[n] = segments_[n * chain_.warps + warp];
        return __builtin_bit_cast(Segment, values);
    }
    /// The forces at the ends of this warp.
    __device__ Ends solve_top() const {
        double *const nodes = own_ + OfLanes::size<Node>, *const within = nodes + OfLanes::size<Node>;
        int const first = unit_ * lane_;
        Segment segment = first < chain_.warps ? given(first) : Segment::zero();
        bool const two = unit_ > 1 && first + 1 < chain_.warps;
        if (two) {
            Node found;
            segment = sweep_.joined(segment, given(first + 1), {(first + 1) * bodies_of_warp, at_top_[1]}, found, Factorizer{});
            OfLanes::store(within, lane_, found);
        }
        Ends ends = solve_lanes<0>(segment, nodes);
        if (two) {
            State const there = sweep_.force(OfLanes::load<Node>(within, lane_), ends.first, ends.next);
            (first == warp_ ? ends.next : ends.first) = there;
        }
        return from_lane(ends, warp_ / unit_);
    }
    /// Of what each lane holds, in as many levels as there have to be: a constant, so that one level's instructions go beside another's.
    template <int levels>
    __device__ Ends solve_lanes(Segment segment, double* nodes) const {
        if constexpr (levels < most_levels_of_top)
            if ((unit_ << levels) < chain_.warps) return solve_lanes<levels + 1>(segment, nodes);
        climb<levels>(segment, nodes, 0, unit_ * bodies_of_warp, at_top_[0], [](int level) { return Meeting::of_pairs(1 << level); });
        auto const of_levels = nodes_of_levels<levels>(nodes, 1);
        constexpr int last = (1 << levels) - 1;
        int const restricted = __shfl_sync(whole_warp, at_top_[0], 0);
        Ends ends{State::zero(), State::zero()};
        if (lane_ == last) ends.first = sweep_.first_force({0, restricted}, segment, Factorizer{});
        ends.first = from_lane(ends.first, last);
        go_down(ends, of_levels, 0, unit_ * bodies_of_warp);
        return ends;
    }

    OneChain const& chain_;
    Sweep const& sweep_;
    int lane_, warp_;
    Inbox inbox_;
    double *segments_, *own_;
    int unit_;       // warps a lane of the top
    int at_top_[2];  // directions that its joints restrict
};

}  // namespace catena::cuda::kernels
