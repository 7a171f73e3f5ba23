// Short chain whose handles carry several directions: teams of four or eight lanes merge segments
// in shared memory (merge_teams.cuh). Every block receives the segments of all warps, and one of
// its warps merges those as well, so that it waits only once.
#pragma once

#include <type_traits>

#include "cuda/short/short_thread.cuh"
#include "cuda/sweeps/merge_teams.cuh"

namespace catena::cuda::kernels {

/// Work of one warp, in its block's shared memory.
template <class Sweep>
class ShortTeams {
    using Segment = typename Sweep::Segment;
    using Node = typename Sweep::Node;
    using State = typename Sweep::Sweeps::State;
    using Team = MergeTeam<Sweep>;
    using Records = typename Team::Segments;
    static constexpr int bodies_of_warp = lanes_of_warp * dca::part_length;
    static constexpr int teams_of_warp = lanes_of_warp / Team::lanes;
    /// Places in shared memory: one per body of each lane (body i of all lanes together), then one
    /// per lane for its part.
    static constexpr int of_parts = dca::part_length * lanes_of_warp,
                         places = of_parts + lanes_of_warp;
    static constexpr int idle = 0;  // a place that no thread writes while warps merge
    /// Forces at a segment's first joint and at the joint after it.
    struct Ends {
        State first, next;
    };

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
        return 2 + Records::size(warps) + of_top_words +
               static_cast<std::size_t>(joining) * of_group;
    }
    __device__ ShortTeams(OneChain const& chain, Sweep const& sweep, double* memory)
        : chain_(chain),
          sweep_(sweep),
          is_(chain, true),
          own_(is_.lane / Team::lanes),
          inbox_(reinterpret_cast<std::uint64_t*>(memory)),
          top_{memory + 2},
          at_top_(reinterpret_cast<int*>(top_.origin + Records::size(chain.warps))),
          records_{top_.origin + Records::size(chain.warps) + of_top_words +
                   static_cast<std::size_t>(is_.group) * of_group},
          gains_{records_.origin + Records::size(places)},
          ends_{gains_.origin + Gains::size(of_parts)},
          restricted_(
              reinterpret_cast<int*>(ends_.origin + PackedRecords<Ends>::size(lanes_of_warp))) {}

    /// Prepares the launch while the previous one may still run. It reads nothing that a launch
    /// writes.
    __device__ void open() {
        if (threadIdx.x == 0 && !is_alone(chain_))
            inbox_.open(static_cast<int>(sizeof(Segment)) * chain_.warps);
        __syncwarp();
        arrive_at_cluster();
        if (is_.beside >= 0)
            for (int i = is_.beside; has_body(i); i += is_.warps_beside)
                restricted_[place_of(is_.lane, i)] = sweep_.s.restricted[is_.first + i];
        for (int warp = static_cast<int>(threadIdx.x); warp < chain_.warps;
             warp += static_cast<int>(blockDim.x))
            at_top_[warp] = sweep_.s.restricted[warp * bodies_of_warp];
    }
    /// Performs both passes and computes the accelerations of the thread's bodies.
    __device__ void both_passes() const {
        Kept const kept{records_, gains_, is_.lane};
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
    using Directions = Vector<double, Sweep::K>;
    using Square = Matrix<double, Sweep::K, Sweep::K>;
    using Biases = dca::SegmentBias<double, Sweep::K>;
    using Turning = typename BodiesOf<Sweep>::Turning;
    using Gains = PackedRecords<Square>;
    /// Sizes of arrays of integers, two of which fit in a double.
    static constexpr std::size_t of_top_words = most_warps_of_chain / 2,
                                 of_bodies_words = of_parts / 2;
    /// Size of the shared memory of a merging warp in doubles.
    static constexpr std::size_t of_group = Records::size(places) + Gains::size(of_parts) +
                                            PackedRecords<Ends>::size(lanes_of_warp) +
                                            of_bodies_words;
    static constexpr int steps_of_parts = dca::parts_of_run - 1,
                         steps_of_warp =
                             steps_of_parts + levels_above(lanes_of_warp / dca::parts_of_run);
    /// Place of body i of a lane, and place of a lane's merged part.
    __device__ static int place_of(int lane, int i) { return i * lanes_of_warp + lane; }
    __device__ static int place_of_part(int lane) { return of_parts + lane; }
    __device__ bool has_body(int i) const { return is_.is_here(i, is_.first + i); }

    /// Records of a lane's bodies: first a body's segment, after merges the terms that its joint
    /// passes on, and finally the forces.
    struct Kept {
        Records records;
        Gains gains;
        int lane;
        // The biases overwrite the joint's inboard matrix, which the outward pass does not need.
        static constexpr int at_bias = Team::at_inboard;
        static_assert(numbers_of<Biases> <= numbers_of<Square>);

        template <class T>
        __device__ void put(int i, T const& value) const {
            write(of(i), value);
        }
        template <class T>
        __device__ T get(int i) const {
            double const* const record = of(i);
            if constexpr (std::is_same_v<T, Passed>) {
                if (i == 0) {
                    Segment const own = Team::template record<Segment>(record);
                    return {{}, own.matrix.z12, own.bias};
                }
                return {Team::template record<Symmetric<double, Sweep::K>>(record),
                        Team::template record<Square>(record + Team::at_outboard),
                        Team::template record<Biases>(record + at_bias)};
            } else {
                return Team::template record<T>(record);
            }
        }
        /// Stores the gain of the joint before body i (force at it per force after the body).
        __device__ void put_gain(int i, Square const& gain) const {
            gains.store(place_of(lane, i), gain);
        }
        __device__ Square gain(int i) const { return gains.load(place_of(lane, i)); }
        /// Stores the offset of the force at the joint before body i.
        __device__ void put_offset(int i, Directions const& offset) const {
            write(of(i) + at_bias, offset);
        }
        __device__ Directions offset(int i) const {
            return Team::template record<Directions>(of(i) + at_bias);
        }

      private:
        __device__ double* of(int i) const { return records.record(place_of(lane, i)); }
        template <class T>
        __device__ static void write(double* record, T const& value) {
            auto const values = __builtin_bit_cast(NumbersOf<T>, value);
            CATENA_UNROLL
            for (int n = 0; n < numbers_of<T>; ++n) record[n] = values[n];
        }
    };
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
            double *const first = records_.record(part), *const joined =
                                                             records_.record(place_of_part(part));
            if (count == 1) team.copy(first, joined);
            auto const pair = [&](int i) {
                int const place = place_of(part, i);
                bool const works = i < count;
                return Pair{i == 1 ? first : joined,
                            records_.record(place),
                            {is_.first_of(part) + i, works ? restricted_[place] : 0},
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
        return {records_.record(works ? place_of_part(inboard) : idle),
                records_.record(works ? place_of_part(outboard) : idle),
                {is_.first_of(there), restricted_[place_of(there, 0)]},
                works};
    }
    /// Returns merge number i of pairs of warps at a level of the top.
    __device__ Pair of_warps(int level, int i) const {
        int const inboard = i << (level + 1), outboard = inboard + (1 << level);
        bool const works = outboard < chain_.warps;
        int const there = works ? outboard : 0;
        double* const nowhere = records_.record(idle);
        return {works ? top_.record(inboard) : nowhere,
                works ? top_.record(outboard) : nowhere,
                {there * bodies_of_warp, at_top_[there]},
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
    /// Number of levels of the tree of warps.
    __device__ int levels_of_top() const {
        int levels = 0;
        while (1 << levels < chain_.warps) ++levels;
        return levels;
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
            send_to_all<numbers_of<Segment>>(chain_, inbox_, is_.lane, records_.record(of_parts),
                                             [&](int n) { return &top_.number(is_.warp, n); });
        if (is_.group > 0) return;
        if (!is_alone(chain_)) inbox_.wait();
        join_steps(
            levels_of_top(),
            [&](int level) { return (chain_.warps + (2 << level) - 1) >> (level + 1); },
            [&](int level, int i) { return of_warps(level, i); });
    }
    /// Outward pass by the merging warps. It computes the forces at the first joint, at the warp,
    /// at its runs and parts by teams, and at bodies by each lane.
    __device__ void go_down() const {
        Team const team;
        Ends ends{sweep_.first_force({0, at_top_[0]}, top_.load(0), Factorizer{}), State::zero()};
        CATENA_NO_UNROLL
        for (int level = levels_of_top() - 1; level >= 0; --level)
            go_down(team, ends, top_, 0, is_.warp, 1 << level, chain_.warps);
        // Number of lanes that have bodies.
        int const lanes =
            (chain_.bodies - is_.first_of(0) + dca::part_length - 1) / dca::part_length;
        CATENA_NO_UNROLL
        for (int lane = own_ * dca::parts_of_run; lane < lanes_of_warp;
             lane += teams_of_warp * dca::parts_of_run) {
            Ends of_run = ends;
            CATENA_NO_UNROLL
            for (int distance = lanes_of_warp / 2; distance >= dca::parts_of_run; distance /= 2)
                go_down(team, of_run, records_, of_parts, lane, distance, lanes);
            CATENA_NO_UNROLL
            for (int p = dca::parts_of_run - 1; p > 0; --p) {
                bool const exists = lane + p < lanes;
                State const there =
                    team.force(records_.record(place_of_part(exists ? lane + p : 0)), of_run.first,
                               of_run.next);
                if (!exists) continue;
                if (team.leads()) ends_.store(lane + p, {there, of_run.next});
                of_run.next = there;
            }
            if (team.leads()) ends_.store(lane, of_run);
        }
        __syncwarp();
        Ends const own = ends_.load(is_.lane);
        Kept const kept{records_, gains_, is_.lane};
        if (int const count = is_.bodies_of(is_.lane); count > 0)
            sweep_.forces_by_gains(count, kept, own.first, own.next,
                                   [&](int i, State const& inboard, State const& outboard) {
                                       kept.put(i, Ends{inboard, outboard});
                                   });
    }
    /// Descends from the ends of a pair of `distance` items each to the ends of the half that
    /// contains item `own`. `count`: number of items.
    __device__ static void go_down(Team const& team, Ends& ends, Records const& records, int place,
                                   int own, int distance, int count) {
        int const middle = (own & ~(2 * distance - 1)) + distance;
        bool const exists = middle < count;
        State const there =
            team.force(records.record(place + (exists ? middle : 0)), ends.first, ends.next);
        ends.next = dca::either(exists && own < middle, there, ends.next);
        ends.first = dca::either(exists && own >= middle, there, ends.first);
    }

    OneChain const& chain_;
    Sweep const& sweep_;
    ShortThread is_;
    int own_;  // team in the warp
    Inbox inbox_;
    Records top_;
    int* at_top_;  // directions that the joints before warps restrict
    Records records_;
    Gains gains_;
    PackedRecords<Ends> ends_;  // forces at the ends of lanes' parts
    int* restricted_;           // directions that the joints of the warp's bodies restrict
};

}  // namespace catena::cuda::kernels
