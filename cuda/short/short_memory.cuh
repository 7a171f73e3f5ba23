// Shared memory of a short chain's warps that merge by teams (short_teams.cuh).
#pragma once

#include <type_traits>

#include "cuda/sweeps/merge_teams.cuh"
#include "cuda/sweeps/one_chain.cuh"

namespace catena::cuda::kernels {

/// Shared memory of one merging warp and of its block.
template <class Sweep>
struct MemoryOfTeams {
    using Segment = typename Sweep::Segment;
    using State = typename Sweep::Sweeps::State;
    using Records = typename MergeTeam<Sweep>::Segments;
    using Gains = PackedRecords<Matrix<double, Sweep::K, Sweep::K>>;
    /// Forces at a segment's first joint and at the joint after it.
    struct Ends {
        State first, next;
    };

    /// Places in shared memory: one per body of each lane (body i of all lanes together), then one
    /// per lane for its part.
    static constexpr int of_parts = dca::part_length * lanes_of_warp,
                         places = of_parts + lanes_of_warp;
    static constexpr int idle = 0;  // a place that no thread writes while warps merge
    /// Place of body i of a lane, and place of a lane's merged part.
    __device__ static int place_of(int lane, int i) { return i * lanes_of_warp + lane; }
    __device__ static int place_of_part(int lane) { return of_parts + lane; }

    /// Size of a block's shared memory in doubles: `joining` merging warps per block, `warps` in
    /// the launch.
    static constexpr std::size_t numbers(int joining, int warps) {
        return 2 + Records::size(warps) + of_top_words +
               static_cast<std::size_t>(joining) * of_group;
    }
    /// `group`: number of the merging warp in the block; `memory`: that of the block.
    __device__ MemoryOfTeams(OneChain const& chain, int group, double* memory)
        : inbox(reinterpret_cast<std::uint64_t*>(memory)),
          top{memory + 2},
          at_top(reinterpret_cast<int*>(top.origin + Records::size(chain.warps))),
          records{top.origin + Records::size(chain.warps) + of_top_words +
                  static_cast<std::size_t>(group) * of_group},
          gains{records.origin + Records::size(places)},
          ends{gains.origin + Gains::size(of_parts)},
          restricted(
              reinterpret_cast<int*>(ends.origin + PackedRecords<Ends>::size(lanes_of_warp))) {}

    Inbox inbox;
    Records top;
    int* at_top;  // directions that the joints before warps restrict
    Records records;
    Gains gains;
    PackedRecords<Ends> ends;  // forces at the ends of lanes' parts
    int* restricted;           // directions that the joints of the warp's bodies restrict

  private:
    /// Sizes of arrays of integers, two of which fit in a double.
    static constexpr std::size_t of_top_words = most_warps_of_chain / 2,
                                 of_bodies_words = of_parts / 2;
    /// Size of the shared memory of a merging warp in doubles.
    static constexpr std::size_t of_group = Records::size(places) + Gains::size(of_parts) +
                                            PackedRecords<Ends>::size(lanes_of_warp) +
                                            of_bodies_words;
};

/// Records of a lane's bodies: first a body's segment, after merges the terms that its joint
/// passes on, and finally the forces.
template <class Sweep>
struct BodiesOfLane {
    using Segment = typename Sweep::Segment;
    using Passed = typename Sweep::Passed;
    using Team = MergeTeam<Sweep>;
    using Directions = Vector<double, Sweep::K>;
    using Square = Matrix<double, Sweep::K, Sweep::K>;
    using Biases = dca::SegmentBias<double, Sweep::K>;
    using Records = typename Team::Segments;
    using Gains = PackedRecords<Square>;
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
        gains.store(MemoryOfTeams<Sweep>::place_of(lane, i), gain);
    }
    __device__ Square gain(int i) const {
        return gains.load(MemoryOfTeams<Sweep>::place_of(lane, i));
    }
    /// Stores the offset of the force at the joint before body i.
    __device__ void put_offset(int i, Directions const& offset) const {
        write(of(i) + at_bias, offset);
    }
    __device__ Directions offset(int i) const {
        return Team::template record<Directions>(of(i) + at_bias);
    }

  private:
    __device__ double* of(int i) const {
        return records.record(MemoryOfTeams<Sweep>::place_of(lane, i));
    }
    template <class T>
    __device__ static void write(double* record, T const& value) {
        auto const values = __builtin_bit_cast(NumbersOf<T>, value);
        CATENA_UNROLL
        for (int n = 0; n < numbers_of<T>; ++n) record[n] = values[n];
    }
};

}  // namespace catena::cuda::kernels
