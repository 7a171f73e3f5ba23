// Short chain whose handles carry one direction: a lane merges the bodies of its part, then lanes
// merge their segments.
#pragma once

#include <type_traits>

#include "cuda/short/short_thread.cuh"
#include "cuda/sweeps/joined_lanes.cuh"

namespace catena::cuda::kernels {

/// Work of one warp, in its block's shared memory.
template <class Sweep>
class ShortLanes {
    using Segment = typename Sweep::Segment;
    using State = typename Sweep::Sweeps::State;
    using Lanes = JoinedLanes<Sweep, dca::part_length, dca::parts_of_run>;
    using Ends = typename Lanes::Ends;

  public:
    static constexpr int most_threads = 2 * most_joining_warps * lanes_of_warp;
    /// Number of warps per merging warp, itself included. The number is small enough that each
    /// thread has the maximal number of registers.
    static constexpr int warps_for_each(int joining) {
        return joining <= 2 ? dca::part_length : dca::part_length / 2;
    }
    /// Size of a block's shared memory in doubles: `joining` merging warps per block, `warps` in
    /// the launch.
    static constexpr std::size_t numbers(int joining, int warps) {
        return static_cast<std::size_t>(Lanes::of_block(warps)) +
               static_cast<std::size_t>(joining) * of_warp;
    }
    __device__ ShortLanes(OneChain const& chain, Sweep const& sweep, double* memory)
        : sweep_(sweep),
          is_(chain),
          own_(memory + Lanes::of_block(chain.warps) + is_.group * of_warp),
          lanes_(chain, sweep, is_.lane, is_.warp, memory, own_) {}

    /// Prepares the launch while the previous one may still run. It reads nothing that a launch
    /// writes.
    __device__ void open() {
        lanes_.open(is_.beside == 0);
        count_ = is_.bodies_of(is_.lane);
        CATENA_UNROLL
        for (int i = 0; i < dca::part_length; ++i)
            restricted_[i] = i < count_ && is_.beside == 0 ? sweep_.s.restricted[is_.first + i] : 0;
    }
    /// Performs both passes and computes the accelerations of the thread's bodies.
    __device__ void both_passes() const {
        InMemory const memory(own_ + Lanes::of_warp + is_.lane);
        [[maybe_unused]] typename Sweep::Body own[bodies_stay ? most_bodies : 1];
        if (count_ < dca::part_length && is_.beside == 0) {
            CATENA_UNROLL
            for (int i = 0; i < dca::part_length; ++i)
                if (i >= count_) memory.put(i, Segment::zero());
        }
        each_body([&](int round, int i, std::int64_t k) {
            typename Sweep::Body const body = sweep_.bodies.body_at(k, BranchlessInverseLength{});
            if constexpr (bodies_stay) own[round] = body;
            memory.put(i, sweep_.bodies.segment(body, Factorizer{}));
        });
        __syncthreads();
        wait_for_cluster();
        if (is_.beside == 0) join();
        __syncthreads();
        each_body([&](int round, int i, std::int64_t k) {
            Ends const ends = memory.template get<Ends>(i);
            if constexpr (bodies_stay)
                sweep_.accelerate(k, own[round], ends.first, ends.next, Factorizer{});
            else
                sweep_.accelerate(k, sweep_.bodies.body_at(k, BranchlessInverseLength{}),
                                  ends.first, ends.next, Factorizer{});
        });
    }

  private:
    /// True if bodies are small enough to stay in their threads' registers.
    static constexpr bool bodies_stay = !Sweep::one_by_one;
    /// Largest number of bodies per thread.
    static constexpr int most_bodies = dca::part_length / warps_for_each(most_joining_warps);
    using Passed = typename Sweep::Passed;
    using Factorizer = BranchlessFactorizer<true>;
    using Passage = typename Sweep::Passage;
    /// Records of a lane's bodies in shared memory; different types share the same place.
    class InMemory {
      public:
        static constexpr int of_body = OfLanes::size<Segment>, numbers = dca::part_length * of_body;
        static_assert(sizeof(Ends) <= sizeof(Segment));
        __device__ explicit InMemory(double* of_lane) : memory_(of_lane) {}
        template <class T>
        __device__ void put(int i, T const& value) const {
            OfLanes::store(memory_ + i * of_body, 0, value);
        }
        template <class T>
        __device__ T get(int i) const {
            return OfLanes::load<T>(memory_ + i * of_body, 0);
        }

      private:
        double* memory_;
    };
    /// Storage that also keeps in registers what the inward pass leaves for the outward pass.
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
    /// Size of a warp's shared memory in doubles.
    static constexpr int of_warp = Lanes::of_warp + InMemory::numbers;
    /// Calls action(round, i, k) for this thread's bodies: body k is number i of the bodies that
    /// its lane merges.
    template <class Action>
    __device__ void each_body(Action const& action) const {
        each_step<most_bodies>([&](int round) {
            int const i = round * is_.warps_beside + is_.beside;
            if (std::int64_t const k = is_.first + i; is_.is_here(i, k)) action(round, i, k);
        });
    }
    /// Performs both passes by the merging warps.
    __device__ void join() const {
        Kept kept(own_ + Lanes::of_warp + is_.lane);
        auto const restricted = [&](int i) { return restricted_[i]; };
        bool sure = true;
        Segment segment =
            sweep_.join_bodies_at_once(count_, restricted, kept, UncheckedFactorizer{sure});
        if (!sure) segment = sweep_.join_bodies(is_.first, count_, restricted, kept);
        lanes_.both_passes(segment, restricted_[0], [&](Ends const& ends) {
            dca::forces_within<Sweep>(count_, kept, ends.first, ends.next,
                                      [&](int i, State const& inboard, State const& outboard) {
                                          kept.put(i, Ends{inboard, outboard});
                                      });
        });
    }

    Sweep const& sweep_;
    ShortThread is_;
    double* own_;
    Lanes lanes_;
    int count_ = 0;                     // bodies of the lane
    int restricted_[dca::part_length];  // number of directions that their joints restrict
};

}  // namespace catena::cuda::kernels
