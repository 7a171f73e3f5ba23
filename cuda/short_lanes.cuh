// A short chain whose handles carry one direction: a lane joins what it holds to what another lane has, in registers, and without
// branches. Every warp is given the segments of all of them and joins those as well, so that nobody waits twice.
#pragma once

#include <type_traits>

#include "cuda/short_thread.cuh"

namespace catena::cuda::kernels {

/// One meeting of lanes: lane l of those with l & mask == last joins what lane l - distance has to its own; all that lie between them count
/// to its own. `others`: whether some have theirs for a later one.
struct Meeting {
    int distance, mask, last;
    bool others;
    /// Parts of runs one after the other, then pairs.
    __device__ static Meeting of_parts(int step) {
        constexpr int in_run = dca::parts_of_run - 1;
        if (step < in_run) return {1, dca::parts_of_run - 1, step + 1, step + 1 < in_run};
        return of_pairs(dca::parts_of_run << (step - in_run));
    }
    __device__ static Meeting of_pairs(int distance) { return {distance, 2 * distance - 1, 2 * distance - 1, false}; }
};

/// Of one warp, in its block's shared memory.
template <class Sweep>
class ShortLanes {
    static_assert(Sweep::K == 1);
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
    static constexpr int most_threads = 2 * most_joining_warps * lanes_of_warp;
    /// Warps for each that joins, itself included: few enough that all threads have as many registers as they may.
    static constexpr int warps_for_each(int joining) { return joining <= 2 ? dca::part_length : dca::part_length / 2; }
    /// Numbers of a block of so many warps that join, and of a launch of so many.
    static constexpr std::size_t numbers(int joining, int warps) {
        return 2 + static_cast<std::size_t>(numbers_of<Segment>) * static_cast<std::size_t>(warps) +
               static_cast<std::size_t>(joining) * of_warp;
    }
    __device__ ShortLanes(ShortChain const& chain, Sweep const& sweep, double* memory)
        : chain_(chain),
          sweep_(sweep),
          is_(chain),
          inbox_(reinterpret_cast<std::uint64_t*>(memory)),
          segments_(memory + 2),
          own_(segments_ + numbers_of<Segment> * chain.warps + is_.group * of_warp) {}

    /// While the launch before may still go on: nothing is read here that a launch writes.
    __device__ void open() {
        if (threadIdx.x == 0) inbox_.open(static_cast<int>(sizeof(Segment)) * chain_.warps);
        __syncwarp();
        arrive_at_cluster();
        part_ = is_.lane % dca::parts_of_run;
        count_ = is_.bodies_of(is_.lane);
        unit_ = (chain_.warps + lanes_of_warp - 1) / lanes_of_warp;
        CATENA_UNROLL
        for (int i = 0; i < dca::part_length; ++i) restricted_[i] = i < count_ && is_.beside == 0 ? sweep_.s.restricted[is_.first + i] : 0;
        CATENA_UNROLL
        for (int i = 0; i < 2; ++i) {
            int const warp = unit_ * is_.lane + i;
            at_top_[i] = warp < chain_.warps && is_.beside == 0 ? sweep_.s.restricted[warp * bodies_of_warp] : 0;
        }
    }
    __device__ void turn() const {
        InMemory const memory(own_ + of_nodes + is_.lane);
        [[maybe_unused]] typename Sweep::Body own[bodies_stay ? most_bodies : 1];
        if (count_ < dca::part_length && is_.beside == 0) {
            CATENA_UNROLL
            for (int i = 0; i < dca::part_length; ++i)
                if (i >= count_) memory.put(i, Segment::zero());
        }
        each_body([&](int round, int i, std::int64_t k) {
            typename Sweep::Body const body = sweep_.bodies.body_at(k, QuickInverseLength{});
            if constexpr (bodies_stay) own[round] = body;
            memory.put(i, sweep_.bodies.segment(body, Factors{}));
        });
        __syncthreads();
        wait_for_cluster();
        if (is_.beside == 0) join();
        __syncthreads();
        each_body([&](int round, int i, std::int64_t k) {
            Ends const ends = memory.template get<Ends>(i);
            if constexpr (bodies_stay)
                sweep_.accelerate(k, own[round], ends.first, ends.next, Factors{});
            else
                sweep_.accelerate(k, sweep_.bodies.body_at(k, QuickInverseLength{}), ends.first, ends.next, Factors{});
        });
    }

  private:
    /// Whether bodies are so small that they stay with their threads.
    static constexpr bool bodies_stay = !Sweep::one_by_one;
    static constexpr int most_bodies = dca::part_length / warps_for_each(most_joining_warps);
    using Passed = typename Sweep::Passed;
    using Factors = QuickFactors<true>;
    using Passage = typename Sweep::Passage;
    /// Of a lane's bodies, in turn in the same place.
    class InMemory {
      public:
        static constexpr int of_body = numbers_of<Segment> * pitch, numbers = dca::part_length * of_body;
        static_assert(sizeof(Ends) <= sizeof(Segment));
        __device__ explicit InMemory(double* of_lane) : memory_(of_lane) {}
        template <class T>
        __device__ void put(int i, T const& value) const {
            keep(memory_ + i * of_body, 0, value);
        }
        template <class T>
        __device__ T get(int i) const {
            return kept<T>(memory_ + i * of_body, 0);
        }

      private:
        double* memory_;
    };
    /// And what the way up leaves for the way down, in registers.
    class Kept : public InMemory {
      public:
        using InMemory::InMemory, InMemory::put;
        __device__ void put(int i, Passed const& joint) { passed_[i] = joint; }
        __device__ void put(int i, Passage const& passage) { passages_[i] = passage; }
        template <class T>
        __device__ T get(int i) const {
            if constexpr (std::is_same_v<T, Passed>)
                return passed_[i];
            else if constexpr (std::is_same_v<T, Passage>)
                return passages_[i];
            else
                return InMemory::template get<T>(i);
        }

      private:
        Passed passed_[dca::part_length];
        Passage passages_[dca::part_length];
    };
    static constexpr int of_nodes = 3 * numbers_of<Node> * pitch;  // of the warp's lanes, of those of the top and within these
    static constexpr int of_warp = of_nodes + InMemory::numbers;
    /// action(round, i, k) for this thread's bodies: body k is the i-th of what its lane joins.
    template <class Action>
    __device__ void each_body(Action const& action) const {
        each_step<most_bodies>([&](int round) {
            int const i = round * is_.warps_beside + is_.beside;
            if (std::int64_t const k = is_.first + i; is_.is_here(i, k)) action(round, i, k);
        });
    }
    /// What the warps do that join: up and down again.
    __device__ void join() const {
        Kept kept(own_ + of_nodes + is_.lane);
        auto const restricted = [&](int i) { return restricted_[i]; };
        bool sure = true;
        Segment segment = sweep_.join_bodies_at_once(count_, restricted, kept, SureFactors{sure});
        if (!sure) segment = sweep_.join_bodies(is_.first, count_, restricted, kept);
        climb<steps_of_warp>(segment, own_, is_.warp * lanes_of_warp, dca::part_length, restricted_[0],
                             [](int step) { return Meeting::of_parts(step); });
        if (is_.warp >= chain_.warps) return;
        give(segment);
        auto const of_levels = nodes_of_levels<levels_of_warp>(own_, dca::parts_of_run);
        auto const of_parts = nodes_of<dca::parts_of_run>(own_, [first = is_.lane - part_](int p) { return first + p; });
        inbox_.wait();
        Ends ends = solve_top();
        go_down(ends, of_levels, is_.warp * lanes_of_warp, dca::part_length);
        State first = ends.first;
        each_step<dca::parts_of_run, true>([&](int p) {
            if (p == 0) return;
            bool const exists = is_.first_of(is_.lane - part_ + p) < chain_.bodies;
            State const there = sweep_.force(of_parts[p], ends.first, ends.next);
            first = dca::either(part_ == p && exists, there, first);
            ends.next = dca::either(part_ < p && exists, there, ends.next);
        });
        sweep_.forces(count_, kept, first, ends.next,
                      [&](int i, State const& inboard, State const& outboard) { kept.put(i, Ends{inboard, outboard}); });
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
    /// action(s) for s of [0, steps), or back.
    template <int steps, bool back = false, class Action>
    __device__ static void each_step(Action const& action) {
        CATENA_UNROLL
        for (int i = 0; i < steps; ++i) action(back ? steps - 1 - i : i);
    }
    /// Lane l has the segment from body (first + l) `length` on. What is joined is with the last of those who met.
    template <int steps, class Step>
    __device__ void climb(Segment& segment, double* nodes, int first, int length, int restricted, Step const& step) const {
        bool sure = true;
        Segment quickly = segment;
        unsigned const restricts = __ballot_sync(whole_warp, restricted > 0);  // where there is no joint, none
        each_step<steps>([&](int s) {
            Meeting const m = step(s);
            int const lane = is_.lane - m.distance + 1;
            bool const meets = (is_.lane & m.mask) == m.last, exists = (first + lane) * length < chain_.bodies;
            Segment const inboard = from_lane(quickly, is_.lane - m.distance);
            Node found;
            bool sure_here = true;
            Segment joined = sweep_.joined_at_once(inboard, quickly, static_cast<int>(restricts >> (lane & (lanes_of_warp - 1)) & 1), found,
                                                   SureFactors{sure_here});
            if (!exists) joined.bias.b1 = inboard.bias.b1;
            if (meets && exists) keep(nodes, lane, found);
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
            int const lane = is_.lane - m.distance + 1, of_joint = __shfl_sync(whole_warp, restricted, lane);
            std::int64_t const joint = (first + lane) * length;
            Segment const inboard = from_lane(segment, is_.lane - m.distance);
            if ((is_.lane & m.mask) != m.last) continue;
            if (joint < chain_.bodies) {
                Node found;
                segment = sweep_.joined(inboard, segment, {joint, of_joint}, found);
                keep(nodes, lane, found);
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
            each_step<count>([&](int i) { node[i] = kept<Node>(nodes, lane(i)); });
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
                                [lane = is_.lane, lanes](int level) { return (lane & ~(2 * (lanes << level) - 1)) + (lanes << level); });
    }
    /// From what a lane's pair holds together to what it holds itself, level by level.
    template <int levels, class Lane>
    __device__ void go_down(Ends& ends, Nodes<levels, Lane> const& nodes, int first, int length) const {
        each_step<levels, true>([&](int level) {
            int const middle = nodes.lane(level);
            bool const exists = (first + middle) * length < chain_.bodies;
            State const there = sweep_.force(nodes[level], ends.first, ends.next);
            ends.next = dca::either(exists && is_.lane < middle, there, ends.next);
            ends.first = dca::either(exists && is_.lane >= middle, there, ends.first);
        });
    }
    /// The last lane's segment, to all blocks.
    __device__ void give(Segment const& segment) const {
        double* const letter = own_ + numbers_of<Node> * pitch;  // free till the top is climbed
        if (is_.lane == lanes_of_warp - 1) {
            auto const values = __builtin_bit_cast(NumbersOf<Segment>, segment);
            CATENA_UNROLL
            for (int n = 0; n < numbers_of<Segment>; ++n) letter[n] = values[n];
        }
        __syncwarp();
        send_to_all<numbers_of<Segment>>(inbox_, is_.lane, letter, [&](int n) { return segments_ + n * chain_.warps + is_.warp; });
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
        double *const nodes = own_ + numbers_of<Node> * pitch, *const within = nodes + numbers_of<Node> * pitch;
        int const first = unit_ * is_.lane;
        Segment segment = first < chain_.warps ? given(first) : Segment::zero();
        bool const two = unit_ > 1 && first + 1 < chain_.warps;
        if (two) {
            Node found;
            segment = sweep_.joined(segment, given(first + 1), {(first + 1) * bodies_of_warp, at_top_[1]}, found, Factors{});
            keep(within, is_.lane, found);
        }
        Ends ends = solve_lanes<0>(segment, nodes);
        if (two) {
            State const there = sweep_.force(kept<Node>(within, is_.lane), ends.first, ends.next);
            (first == is_.warp ? ends.next : ends.first) = there;
        }
        return from_lane(ends, is_.warp / unit_);
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
        if (is_.lane == last) ends.first = sweep_.first_force({0, restricted}, segment, Factors{});
        ends.first = from_lane(ends.first, last);
        go_down(ends, of_levels, 0, unit_ * bodies_of_warp);
        return ends;
    }

    ShortChain const& chain_;
    Sweep const& sweep_;
    ShortThread is_;
    Inbox inbox_;
    double *segments_, *own_;
    int part_ = 0, count_ = 0, unit_ = 0;             // of the lane: its part of a run, its bodies; `unit`: warps a lane of the top
    int restricted_[dca::part_length], at_top_[2];  // directions that joints restrict
};

}  // namespace catena::cuda::kernels
