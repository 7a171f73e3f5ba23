// Short chain whose handles carry several directions: teams of four or eight lanes merge segments
// in shared memory (merge_teams.cuh). Every block receives the segments of all warps, and one of
// its warps merges those as well, so that it waits only once.
#pragma once

#include "cuda/short/short_memory.cuh"
#include "cuda/short/short_thread.cuh"

namespace catena::cuda::kernels {

/// Number of levels of the tree of warps.
__device__ inline int levels_of_top(OneChain const& chain) {
    int levels = 0;
    while (1 << levels < chain.warps) ++levels;
    return levels;
}
/// Descends from the ends of a pair of `distance` items each to the ends of the half that
/// contains item `own`. `count`: number of items.
template <class Sweep>
__device__ void descend_pair(MergeTeam<Sweep> const& team,
                             typename MemoryOfTeams<Sweep>::Ends& ends,
                             typename MemoryOfTeams<Sweep>::Records const& records, int place,
                             int own, int distance, int count) {
    int const middle = (own & ~(2 * distance - 1)) + distance;
    bool const exists = middle < count;
    auto const there =
        team.force(records.record(place + (exists ? middle : 0)), ends.first, ends.next);
    ends.next = dca::either(exists && own < middle, there, ends.next);
    ends.first = dca::either(exists && own >= middle, there, ends.first);
}

/// Work of one warp, in its block's shared memory.
template <class Sweep>
class ShortTeams {
    using Segment = typename Sweep::Segment;
    using Node = typename Sweep::Node;
    using State = typename Sweep::Sweeps::State;
    using Team = MergeTeam<Sweep>;
    using Memory = MemoryOfTeams<Sweep>;
    using Ends = typename Memory::Ends;
    using Kept = BodiesOfLane<Sweep>;
    static constexpr int bodies_of_warp = lanes_of_warp * dca::part_length;
    static constexpr int teams_of_warp = lanes_of_warp / Team::lanes;

  public:
    /// Number of warps per merging warp, itself included; each of the other threads has one or two
    /// bodies.
    static constexpr int warps_for_each(int joining) {
        return 1 + (joining <= 2 ? dca::part_length : dca::part_length / 2);
    }
    static constexpr int most_threads =
        most_joining_warps * (1 + dca::part_length / 2) * lanes_of_warp;
    /// Size of a block's shared memory in doubles: `joining` merging warps per block, `warps` in
    /// the launch.
    static constexpr std::size_t numbers(int joining, int warps) {
        return Memory::numbers(joining, warps);
    }
    __device__ ShortTeams(OneChain const& chain, Sweep const& sweep, double* memory)
        : chain_(chain),
          sweep_(sweep),
          is_(chain, true),
          own_(is_.lane / Team::lanes),
          in_(chain, is_.group, memory) {}

    /// Prepares the launch while the previous one may still run. It reads nothing that a launch
    /// writes.
    __device__ void open() {
        if (threadIdx.x == 0 && !is_alone(chain_))
            in_.inbox.open(static_cast<int>(sizeof(Segment)) * chain_.warps);
        __syncwarp();
        arrive_at_cluster();
        if (is_.beside >= 0)
            for (int i = is_.beside; has_body(i); i += is_.warps_beside)
                in_.restricted[Memory::place_of(is_.lane, i)] = sweep_.s.restricted[is_.first + i];
        for (int warp = static_cast<int>(threadIdx.x); warp < chain_.warps;
             warp += static_cast<int>(blockDim.x))
            in_.at_top[warp] = sweep_.s.restricted[warp * bodies_of_warp];
    }
    /// Performs both passes and computes the accelerations of the thread's bodies.
    __device__ void both_passes() const {
        Kept const kept{in_.records, in_.gains, is_.lane};
        bool const joins = is_.beside < 0;
        typename Sweep::Body body;
        Turning turning;
        auto const read = [&](int i) {
            body = sweep_.bodies.body_at(is_.first + i, BranchlessInverseLength{});
            turning = sweep_.bodies.turning(body, Factorizer{});
        };
        if (!joins) {
            // The body that is read last stays in the thread's registers.
            CATENA_NO_UNROLL
            for (int i = is_.beside + dca::part_length - is_.warps_beside; i >= 0;
                 i -= is_.warps_beside) {
                if (!has_body(i)) continue;
                read(i);
                kept.put(i, sweep_.bodies.segment(body, turning));
            }
        }
        __syncthreads();
        if (!joins) join_bodies();
        __syncthreads();
        wait_for_cluster();
        if (joins) {
            climb();
        } else {
            CATENA_NO_UNROLL
            for (int i = is_.beside; has_body(i); i += is_.warps_beside)
                if (i > 0) kept.put_gain(i, gain(kept.template get<Passed>(i)));
        }
        __syncthreads();
        if (joins && is_.warp < chain_.warps) go_down();
        __syncthreads();
        if (joins) return;
        CATENA_NO_UNROLL
        for (int i = is_.beside; has_body(i); i += is_.warps_beside) {
            if (i != is_.beside) read(i);
            Ends const ends = kept.template get<Ends>(i);
            sweep_.accelerate_turned(is_.first + i, body, turning, ends.first, ends.next);
        }
    }

  private:
    using Passed = typename Sweep::Passed;
    using Factorizer = BranchlessFactorizer<false>;
    using Biases = dca::SegmentBias<double, Sweep::K>;
    using Turning = typename BodiesOf<Sweep>::Turning;
    static constexpr int steps_of_parts = dca::parts_of_run - 1,
                         steps_of_warp =
                             steps_of_parts + levels_above(lanes_of_warp / dca::parts_of_run);
    __device__ bool has_body(int i) const { return is_.is_here(i, is_.first + i); }

    /// Two segments that a team merges, unless there is no second one. The merged segment
    /// overwrites the first, the node the second.
    struct Pair {
        double *inboard, *outboard;
        dca::JointAt at;
        bool works;
    };
    /// Merges every part's bodies by the teams of all warps that hold bodies.
    __device__ void join_bodies() const {
        Team const team;
        CATENA_NO_UNROLL
        for (int part = is_.beside * teams_of_warp + own_; part < lanes_of_warp;
             part += is_.warps_beside * teams_of_warp) {
            int const count = is_.bodies_of(part);
            double *const first = in_.records.record(part), *const joined = in_.records.record(
                                                                Memory::place_of_part(part));
            if (count == 1) team.copy(first, joined);
            auto const pair = [&](int i) {
                int const place = Memory::place_of(part, i);
                bool const works = i < count;
                return Pair{i == 1 ? first : joined,
                            in_.records.record(place),
                            {is_.first_of(part) + i, works ? in_.restricted[place] : 0},
                            works};
            };
            Pair next = pair(1);
            CATENA_NO_UNROLL
            for (int i = 1; i < dca::part_length; ++i) {
                Pair const now = next;
                if (i + 1 < dca::part_length) next = pair(i + 1);
                Biases const bias = team.join(sweep_, now.at, now.works,
                                              {now.inboard, now.outboard, joined, now.outboard});
                __syncwarp();
                if (now.works) team.put_bias(now.outboard + Kept::at_bias, bias);
            }
        }
    }
    /// Returns merge number i in step `step` of the warp: parts of runs one after the other, then
    /// pairs.
    __device__ Pair of_lanes(int step, int i) const {
        int const level = step - steps_of_parts,
                  apart = level < 0 ? step + 1 : dca::parts_of_run << level;
        int const inboard = level < 0 ? dca::parts_of_run * i : 2 * apart * i,
                  outboard = inboard + apart;
        bool const works = outboard < lanes_of_warp && is_.first_of(outboard) < chain_.bodies;
        int const there = works ? outboard : 0;
        return {in_.records.record(works ? Memory::place_of_part(inboard) : Memory::idle),
                in_.records.record(works ? Memory::place_of_part(outboard) : Memory::idle),
                {is_.first_of(there), in_.restricted[Memory::place_of(there, 0)]},
                works};
    }
    /// Returns merge number i of pairs of warps at a level of the top.
    __device__ Pair of_warps(int level, int i) const {
        int const inboard = i << (level + 1), outboard = inboard + (1 << level);
        bool const works = outboard < chain_.warps;
        int const there = works ? outboard : 0;
        double* const nowhere = in_.records.record(Memory::idle);
        return {works ? in_.top.record(inboard) : nowhere,
                works ? in_.top.record(outboard) : nowhere,
                {there * bodies_of_warp, in_.at_top[there]},
                works};
    }
    /// Merges pair(step, i) for i of [0, count(step)) by the warp's teams, step by step. Each pair
    /// is looked up while the previous ones are merged.
    template <class Count, class Of>
    __device__ void join_steps(int steps, Count const& count, Of const& pair) const {
        int step = 0, i = own_;
        Pair next = pair(step, i);
        CATENA_NO_UNROLL
        while (step < steps) {
            Pair const now = next;
            i += teams_of_warp;
            if (i - own_ >= count(step)) ++step, i = own_;
            if (step < steps) next = pair(step, i);
            Team().join(sweep_, now.at, now.works,
                        {now.inboard, now.outboard, now.inboard, now.outboard});
            __syncwarp();
        }
    }
    /// Inward pass by the merging warps: each merges its own parts, and the block's first one
    /// merges the segments of all warps.
    __device__ void climb() const {
        join_steps(
            steps_of_warp,
            [](int step) {
                return step < steps_of_parts
                           ? lanes_of_warp / dca::parts_of_run
                           : lanes_of_warp / (2 * dca::parts_of_run << (step - steps_of_parts));
            },
            [&](int step, int i) { return of_lanes(step, i); });
        if (is_.warp < chain_.warps)
            send_to_all<numbers_of<Segment>>(chain_, in_.inbox, is_.lane,
                                             in_.records.record(Memory::of_parts),
                                             [&](int n) { return &in_.top.number(is_.warp, n); });
        if (is_.group > 0) return;
        if (!is_alone(chain_)) in_.inbox.wait();
        join_steps(
            levels_of_top(chain_),
            [&](int level) { return (chain_.warps + (2 << level) - 1) >> (level + 1); },
            [&](int level, int i) { return of_warps(level, i); });
    }
    /// Outward pass by the merging warps. It computes the forces at the first joint, at the warp,
    /// at its runs and parts by teams, and at bodies by each lane.
    __device__ void go_down() const {
        Team const team;
        Ends ends{sweep_.first_force({0, in_.at_top[0]}, in_.top.load(0), Factorizer{}),
                  State::zero()};
        CATENA_NO_UNROLL
        for (int level = levels_of_top(chain_) - 1; level >= 0; --level)
            descend_pair<Sweep>(team, ends, in_.top, 0, is_.warp, 1 << level, chain_.warps);
        // Number of lanes that have bodies.
        int const lanes =
            (chain_.bodies - is_.first_of(0) + dca::part_length - 1) / dca::part_length;
        CATENA_NO_UNROLL
        for (int lane = own_ * dca::parts_of_run; lane < lanes_of_warp;
             lane += teams_of_warp * dca::parts_of_run) {
            Ends of_run = ends;
            CATENA_NO_UNROLL
            for (int distance = lanes_of_warp / 2; distance >= dca::parts_of_run; distance /= 2)
                descend_pair<Sweep>(team, of_run, in_.records, Memory::of_parts, lane, distance,
                                    lanes);
            CATENA_NO_UNROLL
            for (int p = dca::parts_of_run - 1; p > 0; --p) {
                bool const exists = lane + p < lanes;
                State const there =
                    team.force(in_.records.record(Memory::place_of_part(exists ? lane + p : 0)),
                               of_run.first, of_run.next);
                if (!exists) continue;
                if (team.leads()) in_.ends.store(lane + p, {there, of_run.next});
                of_run.next = there;
            }
            if (team.leads()) in_.ends.store(lane, of_run);
        }
        __syncwarp();
        Ends const own = in_.ends.load(is_.lane);
        Kept const kept{in_.records, in_.gains, is_.lane};
        if (int const count = is_.bodies_of(is_.lane); count > 0)
            dca::forces_by_gains<Sweep>(count, kept, own.first, own.next,
                                        [&](int i, State const& inboard, State const& outboard) {
                                            kept.put(i, Ends{inboard, outboard});
                                        });
    }
    OneChain const& chain_;
    Sweep const& sweep_;
    ShortThread is_;
    int own_;  // team in the warp
    Memory in_;
};

}  // namespace catena::cuda::kernels
