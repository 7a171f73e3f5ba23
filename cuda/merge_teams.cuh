// Merges of a tree by several lanes of a warp each: a column of the matrices a lane, and one lane for the biases. Larger handles have too
// many numbers for one thread's registers, and too long a way through them. What they leave has the bits of Evaluation's joined() and
// force() (dca/evaluation.hpp). A host compiler takes it too, where tests/support/cuda_on_host.hpp stands before it.
#pragma once

#include <cstddef>

#include "cuda/cluster.cuh"
#include "cuda/quick.cuh"
#include "cuda/run_parts.cuh"
#include "dca/stage_words.hpp"

namespace catena::cuda::kernels {

/// Of sweeps that have matrices and biases, over merges in shared memory: the joined segment takes the inboard one's place, the joint's
/// node the outboard one's.
template <class Sweep>
class MergeTeam {
    static constexpr int K = Sweep::K;
    using Segment = typename Sweep::Segment;
    using Node = typename Sweep::Node;
    using Directions = Vector<double, K>;
    using Triangle = Symmetric<double, K>;

  public:
    static constexpr int lanes = 8;
    static constexpr int of_place = numbers_of<Node> > numbers_of<Segment> ? numbers_of<Node> : numbers_of<Segment>;
    using Segments = PackedRecords<Segment, of_place>;
    using Nodes = PackedRecords<Node, of_place>;
    using Forces = PackedRecords<Directions, K>;

    __device__ MergeTeam()
        : lane_(static_cast<int>(threadIdx.x) % 32), own_(lane_ % lanes), column_(own_ < K ? own_ : K - 1), has_biases_(own_ == K) {}

    /// action(i, works) for i of [begin, end) by one team of the block each. All threads of a warp come to each call of `action`; one
    /// whose team does not work has no such i.
    template <class Action>
    __device__ static void each(int begin, int end, Action const& action) {
        constexpr int of_warp = 32 / lanes;
        int const team = static_cast<int>(threadIdx.x) / lanes, teams = static_cast<int>(blockDim.x) / lanes;
        CATENA_NO_UNROLL
        for (int first = begin + team / of_warp * of_warp; first < end; first += teams) {
            int const i = first + team % of_warp;
            action(i, i < end);
        }
    }

    /// All lanes of a warp come to these.
    __device__ void join(Sweep const& sweep, dca::BlockMerge const& m, bool works, Segments const& segments, Nodes const& nodes) const {
        Triangle factor;
        Directions inboard, outboard, first, last;  // of the joint and of what is joined: the lane's columns, or its biases
        if (works) {
            factor = QuickFactors<false>{}(segments.load(m.inboard).matrix.z22 + segments.load(m.outboard).matrix.z11, m.restricted);
        CATENA_UNROLL
            for (int i = 0; i < K; ++i) {
                int const in_triangle = Triangle::at(i, column_ < i ? column_ : i);
                inboard[i] = segments.number(m.inboard, (has_biases_ ? at_b2 : at_z12 + column_ * K) + i);
                outboard[i] = segments.number(m.outboard, at_z12 + i * K + column_);
                first[i] = segments.number(m.inboard, has_biases_ ? at_b1 + i : in_triangle);
                last[i] = segments.number(m.outboard, has_biases_ ? at_b2 + i : at_z22 + in_triangle);
            }
            if (has_biases_) inboard = inboard - segments.load(m.outboard).bias.b1;
            inboard = dca::solve_lower(factor, inboard);
            outboard = dca::solve_lower(factor, outboard);
        }
        __syncwarp();  // both segments are read
        if (works) put(nodes, m.outboard, factor, inboard, outboard);
        __syncwarp();
        if (works) {
            watch(sweep, m, nodes);
            put_joined(nodes, m, dca::scaled(factor, inboard), dca::scaled(factor, outboard), segments, first, last);
        }
    }
    /// The force at the joint, to its place.
    __device__ void go_down(dca::BlockMerge const& m, bool works, Nodes const& nodes, Forces const& forces) const {
        double of_row = 0;
        if (works) {
            Directions const first = forces.load(m.inboard), next = forces.load(m.next);
            Directions inboard, outboard;
            CATENA_UNROLL
            for (int i = 0; i < K; ++i) {
                inboard[i] = nodes.number(m.outboard, at_inboard + column_ * K + i);
                outboard[i] = nodes.number(m.outboard, at_outboard + column_ * K + i);
            }
            of_row = dot(inboard, first) + (dot(outboard, next) + nodes.number(m.outboard, at_offset + column_));
        }
        Directions all;
        CATENA_UNROLL
        for (int i = 0; i < K; ++i) all[i] = from_lane(of_row, lane_ - own_ + i);
        if (works && own_ == 0) forces.store(m.outboard, dca::solve_upper(nodes.load(m.outboard).joint.factor, all));
    }

  private:
    // In a segment, and in a node.
    static constexpr int at_z22 = Triangle::size, at_z12 = 2 * Triangle::size, at_b1 = at_z12 + K * K, at_b2 = at_b1 + K;
    static constexpr int at_inboard = Triangle::size, at_outboard = at_inboard + K * K, at_offset = at_outboard + K * K;
    static_assert(numbers_of<Segment> == at_b2 + K && numbers_of<Node> == at_offset + K && K < lanes);
    using Matrices = dca::SegmentMatrix<double, K>;
    using Joint = dca::JointMatrix<double, K>;
    static_assert(offsetof(Matrices, z12) == at_z12 * sizeof(double) && offsetof(Joint, outboard) == at_outboard * sizeof(double));

    __device__ void put(Nodes const& nodes, int place, Triangle const& factor, Directions const& inboard, Directions const& outboard) const {
        if (own_ < K) {
            CATENA_UNROLL
            for (int i = 0; i < K; ++i) {
                nodes.number(place, at_inboard + i * K + own_) = inboard[i];
                nodes.number(place, at_outboard + i * K + own_) = outboard[i];
            }
        } else if (has_biases_) {
            CATENA_UNROLL
            for (int i = 0; i < K; ++i) nodes.number(place, at_offset + i) = inboard[i];
        }
        if (own_ == lanes - 1) {
            CATENA_UNROLL
            for (int n = 0; n < Triangle::size; ++n) nodes.number(place, n) = factor.data[n];
        }
    }
    /// As the sweep's own watch(), a pivot each.
    __device__ void watch(Sweep const& sweep, dca::BlockMerge const& m, Nodes const& nodes) const {
        if (own_ >= K || own_ >= m.restricted || dca::is_good(nodes.number(m.outboard, Triangle::at(own_, own_)))) return;
        dca::Lost lost;
        lost.add(m.joint);
        sweep.s.note(lost);
    }
    __device__ Directions column(Nodes const& nodes, int place, int first, int i) const {
        Directions c;
        CATENA_UNROLL
        for (int k = 0; k < K; ++k) c[k] = nodes.number(place, first + k * K + i);
        return c;
    }
    /// As append(), a column of the matrices or the biases. Columns of the joint's are read when they are wanted: registers are few.
    __device__ void put_joined(Nodes const& nodes, dca::BlockMerge const& m, Directions const& of_inboard, Directions const& of_outboard,
                               Segments const& segments, Directions first, Directions last) const {
        Directions through;
        CATENA_UNROLL
        for (int i = 0; i < K; ++i) {
            Directions const inboard = column(nodes, m.outboard, at_inboard, i), outboard = column(nodes, m.outboard, at_outboard, i);
            through[i] = dot(inboard, has_biases_ ? of_inboard : of_outboard);
            first[i] = has_biases_ ? first[i] - through[i] : dca::less_products(first[i], inboard, of_inboard);
            last[i] = has_biases_ ? last[i] + dot(outboard, of_inboard) : dca::less_products(last[i], outboard, of_outboard);
        }
        if (own_ < K) {
            CATENA_UNROLL
            for (int i = 0; i < K; ++i) {
                segments.number(m.inboard, at_z12 + i * K + own_) = through[i];
                if (i < own_) continue;
                segments.number(m.inboard, Triangle::at(i, 0) + own_) = first[i];
                segments.number(m.inboard, at_z22 + Triangle::at(i, 0) + own_) = last[i];
            }
        } else if (has_biases_) {
            CATENA_UNROLL
            for (int i = 0; i < K; ++i) {
                segments.number(m.inboard, at_b1 + i) = first[i];
                segments.number(m.inboard, at_b2 + i) = last[i];
            }
        }
    }

    int lane_, own_, column_;  // of the warp, of the team; its column of matrices, or one in the place of that
    bool has_biases_;
};

}  // namespace catena::cuda::kernels
