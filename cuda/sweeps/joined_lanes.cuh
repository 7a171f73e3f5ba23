// Passes of one chain whose handles carry one direction: lanes merge their segments in
// registers, without branches. Every warp receives the segments of all warps and merges those as
// well, so that it waits only once.
#pragma once

#include "cuda/sweeps/branchless_math.cuh"
#include "cuda/sweeps/one_chain.cuh"

namespace catena::cuda::kernels {

/// Calls action(s) for s of [0, steps), or in reverse order if `back`.
template <int steps, bool back = false, class Action>
__device__ void each_step(Action const& action) {
    CATENA_UNROLL
    for (int i = 0; i < steps; ++i) action(back ? steps - 1 - i : i);
}

/// Records of a warp's lanes in shared memory: number n of lane i is at n * pitch + i, so that
/// lanes access different banks.
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

/// One step in which lanes merge: every lane l with l & mask == last merges the segment of lane l -
/// distance with its own. The merged segment contains the lanes in between. `others`: some lanes
/// keep their segment for a later step.
struct Meeting {
    int distance, mask, last;
    bool others;
    /// Returns step `step` of merging `in_row` lanes one after the other, then pairs.
    template <int in_row>
    __device__ static Meeting of_row(int step) {
        constexpr int steps = in_row - 1;
        if (step < steps) return {1, in_row - 1, step + 1, step + 1 < steps};
        return of_pairs(in_row << (step - steps));
    }
    /// Returns the step that merges pairs of `distance` lanes each.
    __device__ static Meeting of_pairs(int distance) {
        return {distance, 2 * distance - 1, 2 * distance - 1, false};
    }
};

/// Lanes of a warp that hold a segment of `of_lane` bodies each. First `in_row` neighbouring lanes
/// are merged one after the other, then pairs of these.
template <class Sweep, int of_lane, int in_row>
class JoinedLanes {
    static_assert(Sweep::K == 1);
    static_assert(std::has_single_bit(static_cast<unsigned>(in_row)));
    using Segment = typename Sweep::Segment;
    using Node = typename Sweep::Node;
    using State = typename Sweep::Sweeps::State;
    using Factorizer = BranchlessFactorizer<true>;
    static constexpr int levels_of_warp = levels_above(lanes_of_warp / in_row),
                         most_levels_of_top = levels_above(lanes_of_warp);
    static constexpr int steps_of_warp = in_row - 1 + levels_of_warp,
                         bodies_of_warp = lanes_of_warp * of_lane;

  public:
    /// Forces at a segment's first joint and at the joint after it.
    struct Ends {
        State first, next;
    };
    /// Size of a block's shared memory in doubles, for a launch of `warps` merging warps.
    static constexpr __host__ __device__ int of_block(int warps) {
        return 2 + numbers_of<Segment> * warps;
    }
    /// Size of each warp's memory in doubles: nodes of its lanes, of the top's lanes and of pairs
    /// of warps within these.
    static constexpr int of_warp = 3 * OfLanes::size<Node>;

    /// `warp`: number of this warp in the chain; `shared`: memory of the block; `own`: memory of
    /// the warp.
    __device__ JoinedLanes(OneChain const& chain, Sweep const& sweep, int lane, int warp,
                           double* shared, double* own)
        : chain_(chain),
          sweep_(sweep),
          lane_(lane),
          warp_(warp),
          inbox_(reinterpret_cast<std::uint64_t*>(shared)),
          segments_(shared + 2),
          own_(own),
          unit_((chain.warps + lanes_of_warp - 1) / lanes_of_warp) {}

    /// Opens the inbox and reads the numbers of restricted directions at the top. All threads of
    /// the cluster call it before any lane merges; `joins` is true for warps that merge.
    __device__ void open(bool joins) {
        if (threadIdx.x == 0 && !is_alone(chain_))
            inbox_.open(static_cast<int>(sizeof(Segment)) * chain_.warps);
        __syncwarp();
        arrive_at_cluster();
        CATENA_UNROLL
        for (int i = 0; i < 2; ++i) {
            int const warp = unit_ * lane_ + i;
            at_top_[i] =
                warp < chain_.warps && joins ? sweep_.s.restricted[warp * bodies_of_warp] : 0;
        }
    }
    /// Performs both passes. `segment`: the lane's segment, zero() if it has no bodies.
    /// `restricted`: number of directions that the lane's first joint restricts. Calls down(Ends)
    /// with the forces at the ends of the lane's segment if the warp has bodies. Precondition:
    /// open() is complete in all blocks (wait_for_cluster()).
    template <class Down>
    __device__ void both_passes(Segment segment, int restricted, Down const& down) const {
        climb<steps_of_warp>(segment, own_, warp_ * lanes_of_warp, of_lane, restricted,
                             [](int step) { return Meeting::of_row<in_row>(step); });
        if (warp_ >= chain_.warps) return;
        give(segment);
        int const place = lane_ % in_row;  // place of the lane in its row
        auto const of_levels = nodes_of_levels<levels_of_warp>(own_, in_row);
        auto const of_row =
            nodes_of<in_row - 1>(own_, [second = lane_ - place + 1](int i) { return second + i; });
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
    /// Inward pass of lanes. Lane l has the segment that starts at body (first + l) * length. The
    /// last lane of a pair holds the merged segment; the node is stored at the first lane of the
    /// outboard segment. If the unchecked factorizer was not sure, the pass is repeated with exact
    /// factors and branches.
    template <int steps, class Step>
    __device__ void climb(Segment& segment, double* nodes, int first, int length, int restricted,
                          Step const& step) const {
        bool sure = true;
        Segment quickly = segment;
        // A lane without a joint restricts nothing.
        unsigned const restricts = __ballot_sync(whole_warp, restricted > 0);
        each_step<steps>([&](int s) {
            Meeting const m = step(s);
            int const lane = lane_ - m.distance + 1;
            bool const meets = (lane_ & m.mask) == m.last,
                       exists = (first + lane) * length < chain_.bodies;
            Segment const inboard = from_lane(quickly, lane_ - m.distance);
            Node found;
            bool sure_here = true;
            Segment joined = sweep_.joined_at_once(
                inboard, quickly, static_cast<int>(restricts >> (lane & (lanes_of_warp - 1)) & 1),
                found, UncheckedFactorizer{sure_here});
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
            int const lane = lane_ - m.distance + 1,
                      of_joint = __shfl_sync(whole_warp, restricted, lane);
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
    /// Nodes for a lane's outward pass, read before they are needed; node i is stored at lane
    /// `lane(i)`.
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
    /// Returns the nodes of pairs of `lanes` lanes each, then of twice as many lanes, and so on.
    template <int levels>
    __device__ auto nodes_of_levels(double const* nodes, int lanes) const {
        return nodes_of<levels>(nodes, [lane = lane_, lanes](int level) {
            return (lane & ~(2 * (lanes << level) - 1)) + (lanes << level);
        });
    }
    /// Outward pass from the ends of a lane's pair to the ends of its own segment, level by level.
    template <int levels, class Lane>
    __device__ void go_down(Ends& ends, Nodes<levels, Lane> const& nodes, int first,
                            int length) const {
        each_step<levels, true>([&](int level) {
            int const middle = nodes.lane(level);
            bool const exists = (first + middle) * length < chain_.bodies;
            State const there = sweep_.force(nodes[level], ends.first, ends.next);
            ends.next = dca::either(exists && lane_ < middle, there, ends.next);
            ends.first = dca::either(exists && lane_ >= middle, there, ends.first);
        });
    }
    /// Sends the last lane's segment, which is the warp's, to all blocks.
    __device__ void give(Segment const& segment) const {
        double* const letter = own_ + OfLanes::size<Node>;  // unused before the top's inward pass
        if (lane_ == lanes_of_warp - 1) {
            auto const values = __builtin_bit_cast(NumbersOf<Segment>, segment);
            CATENA_UNROLL
            for (int n = 0; n < numbers_of<Segment>; ++n) letter[n] = values[n];
        }
        __syncwarp();
        send_to_all<numbers_of<Segment>>(chain_, inbox_, lane_, letter, [&](int n) {
            return segments_ + n * chain_.warps + warp_;
        });
        __syncwarp();  // the top's nodes overwrite this memory
    }
    /// Returns the segment of a warp that has arrived.
    __device__ Segment given(int warp) const {
        NumbersOf<Segment> values;
        CATENA_UNROLL
        for (int n = 0; n < numbers_of<Segment>; ++n)
            values[n] = segments_[n * chain_.warps + warp];
        return __builtin_bit_cast(Segment, values);
    }
    /// Merges the segments of all warps and returns the forces at the ends of this warp.
    __device__ Ends solve_top() const {
        double *const nodes = own_ + OfLanes::size<Node>, *const within =
                                                              nodes + OfLanes::size<Node>;
        int const first = unit_ * lane_;
        Segment segment = first < chain_.warps ? given(first) : Segment::zero();
        bool const two = unit_ > 1 && first + 1 < chain_.warps;
        if (two) {
            Node found;
            segment =
                sweep_.joined(segment, given(first + 1), {(first + 1) * bodies_of_warp, at_top_[1]},
                              found, Factorizer{});
            OfLanes::store(within, lane_, found);
        }
        Ends ends = solve_lanes<0>(segment, nodes);
        if (two) {
            State const there =
                sweep_.force(OfLanes::load<Node>(within, lane_), ends.first, ends.next);
            (first == warp_ ? ends.next : ends.first) = there;
        }
        return from_lane(ends, warp_ / unit_);
    }
    /// Performs both passes of the top with one segment per lane, in as many levels as necessary.
    /// The number of levels is a compile-time constant, so that instructions of different levels
    /// overlap.
    template <int levels>
    __device__ Ends solve_lanes(Segment segment, double* nodes) const {
        if constexpr (levels < most_levels_of_top)
            if ((unit_ << levels) < chain_.warps) return solve_lanes<levels + 1>(segment, nodes);
        climb<levels>(segment, nodes, 0, unit_ * bodies_of_warp, at_top_[0],
                      [](int level) { return Meeting::of_pairs(1 << level); });
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
    int unit_;       // warps per lane of the top
    int at_top_[2];  // directions that the joints before the lane's warps restrict
};

}  // namespace catena::cuda::kernels
