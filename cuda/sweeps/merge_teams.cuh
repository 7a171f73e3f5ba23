// Merges by several lanes of a warp: one lane per column of the matrices, and one lane for the
// biases. Merges of larger handles need more registers than one thread has, and a long chain of
// dependent operations. Results are bitwise those of FusedSweep's joined() and force()
// (dca/fused_sweep.hpp). tests/support/cuda_on_host.hpp, included first, makes this file compile on
// the host.
#pragma once

#include <cstddef>

#include "cuda/device/cluster.cuh"
#include "cuda/sweeps/branchless_math.cuh"
#include "cuda/sweeps/run_parts.cuh"
#include "dca/tree_sweeps.hpp"
#include "tree/stage_encoding.hpp"

namespace catena::cuda::kernels {

/// Team of lanes that merges segments in shared memory, for sweeps with matrices and biases.
template <class Sweep>
class MergeTeam {
    static constexpr int K = Sweep::K;
    using Segment = typename Sweep::Segment;
    using Node = typename Sweep::Node;
    using Directions = Vector<double, K>;
    using Triangle = Symmetric<double, K>;

  public:
    static constexpr int lanes = K < 4 ? 4 : 8;
    static constexpr int of_place =
        numbers_of<Node> > numbers_of<Segment> ? numbers_of<Node> : numbers_of<Segment>;
    using Segments = PackedRecords<Segment, of_place>;
    using Nodes = PackedRecords<Node, of_place>;
    using Forces = PackedRecords<Directions, K>;
    // Offsets of the numbers in a segment, and in a node.
    static constexpr int at_z22 = Triangle::size, at_z12 = 2 * Triangle::size,
                         at_b1 = at_z12 + K * K, at_b2 = at_b1 + K;
    static constexpr int at_inboard = Triangle::size, at_outboard = at_inboard + K * K,
                         at_offset = at_outboard + K * K;

    __device__ MergeTeam()
        : lane_(static_cast<int>(threadIdx.x) % 32),
          own_(lane_ % lanes),
          column_(own_ < K ? own_ : K - 1),
          has_biases_(own_ == K) {}

    /// Calls action(i, works) for i of [begin, end), each i by one team of the block. All threads
    /// of a warp call `action` together. A team without work receives the i of the warp's first
    /// team, and `works` is false.
    template <class Action>
    __device__ static void each(int begin, int end, Action const& action) {
        constexpr int of_warp = 32 / lanes;
        int const team = static_cast<int>(threadIdx.x) / lanes,
                  teams = static_cast<int>(blockDim.x) / lanes;
        CATENA_NO_UNROLL
        for (int first = begin + team / of_warp * of_warp; first < end; first += teams) {
            int const i = first + team % of_warp;
            action(i < end ? i : first, i < end);
        }
    }

    /// Addresses of the two segments, of the merged segment (may be `inboard`) and of the joint's
    /// node (may be `outboard`).
    struct Places {
        double *inboard, *outboard, *joined, *node;
    };
    /// Merges two segments as append() does. All lanes of a warp call it. A team that does
    /// not work only reads from its places. These are the places of a working team of the warp, or
    /// places that no thread writes during the call. The lane of the biases returns the outboard
    /// segment's biases.
    __device__ dca::SegmentBias<double, K> join(Sweep const& sweep, dca::JointAt const& at,
                                                bool works, Places const& places) const {
        bool sure = at.restricted == K;
        Triangle factor = dca::factorize(sum(places), K, BranchlessInverse{sure});
        // Columns of the two segments and of the merged one, or biases on the lane of the biases.
        Directions of_inboard, of_outboard, first, last;
        CATENA_UNROLL
        for (int i = 0; i < K; ++i) {
            int const in_triangle = Triangle::at(i, column_ < i ? column_ : i);
            of_inboard[i] = places.inboard[(has_biases_ ? at_b2 : at_z12 + column_ * K) + i];
            of_outboard[i] = places.outboard[at_z12 + i * K + column_];
            first[i] = places.inboard[has_biases_ ? at_b1 + i : in_triangle];
            last[i] = places.outboard[has_biases_ ? at_b2 + i : at_z22 + in_triangle];
        }
        auto const beyond = record<Directions>(places.outboard + at_b1);
        CATENA_UNROLL
        for (int i = 0; i < K; ++i)
            of_inboard[i] = has_biases_ ? of_inboard[i] - beyond[i] : of_inboard[i];
        Directions inboard = dca::solve_lower(factor, of_inboard),
                   outboard = dca::solve_lower(factor, of_outboard);
        __syncwarp();  // all lanes have read both segments
        put(places.node, works, inboard, outboard);
        __syncwarp();
        CATENA_UNROLL
        for (int i = 0; i < K; ++i) sure = sure && factor(i, i) > 0;
        // The check is late because the last pivot's inverse has a long latency and the joint's
        // matrices do not depend on it.
        if (!__all_sync(0xffffffffu, sure || !works)) {
            factor = factorized(sweep, at, works, sum(places));
            inboard = dca::solve_lower(factor, of_inboard),
            outboard = dca::solve_lower(factor, of_outboard);
            __syncwarp();
            put(places.node, works, inboard, outboard);
            __syncwarp();
        }
        put_joined(places.node, dca::scaled(factor, inboard), dca::scaled(factor, outboard), works,
                   places.joined, first, last);
        CATENA_UNROLL
        for (int n = 0; n < Triangle::size; ++n)
            if (works && own_ == lanes - 1) places.node[n] = factor.data[n];
        return {beyond, last};
    }
    /// Computes the force at the joint of a merge and stores it.
    __device__ void go_down(dca::BlockMerge const& m, bool works, Nodes const& nodes,
                            Forces const& forces) const {
        Directions const found =
            force(nodes.record(m.outboard), forces.load(m.inboard), forces.load(m.next));
        if (works && own_ == 0) forces.store(m.outboard, found);
    }
    /// Returns the force at the joint from the forces at the ends of the merged segment; each lane
    /// computes one row.
    __device__ Directions force(double const* node, Directions const& first,
                                Directions const& next) const {
        auto const inboard = record<Directions>(node + at_inboard + column_ * K),
                   outboard = record<Directions>(node + at_outboard + column_ * K);
        double const of_row =
            dot(inboard, first) + (dot(outboard, next) + node[at_offset + column_]);
        Directions all;
        CATENA_UNROLL
        for (int i = 0; i < K; ++i) all[i] = from_lane(of_row, lane_ - own_ + i);
        return dca::solve_upper(record<Triangle>(node), all);
    }
    /// True for the team's first lane.
    __device__ bool leads() const { return own_ == 0; }
    /// Returns a record that a thread reads alone.
    template <class T>
    __device__ static T record(double const* numbers) {
        NumbersOf<T> values;
        CATENA_UNROLL
        for (int n = 0; n < numbers_of<T>; ++n) values[n] = numbers[n];
        return __builtin_bit_cast(T, values);
    }
    /// Copies a segment by all lanes of the team.
    __device__ void copy(double const* from, double* to) const {
        for (int n = own_; n < numbers_of<Segment>; n += lanes) to[n] = from[n];
    }
    /// Stores biases from the lane of the biases.
    __device__ void put_bias(double* to, dca::SegmentBias<double, K> const& bias) const {
        if (!has_biases_) return;
        CATENA_UNROLL
        for (int i = 0; i < K; ++i) to[i] = bias.b1[i], to[K + i] = bias.b2[i];
    }

  private:
    static_assert(numbers_of<Segment> == at_b2 + K && numbers_of<Node> == at_offset + K &&
                  K < lanes);
    using Matrices = dca::SegmentMatrix<double, K>;
    using Joint = dca::JointMatrix<double, K>;
    static_assert(offsetof(Matrices, z12) == at_z12 * sizeof(double) &&
                  offsetof(Joint, outboard) == at_outboard * sizeof(double));

    /// Returns Z of append(). If a node takes the outboard segment's place, the joint's factor is
    /// written last, as it overwrites that segment's z11.
    __device__ static Triangle sum(Places const& places) {
        return record<Triangle>(places.inboard + at_z22) + record<Triangle>(places.outboard);
    }
    /// Factorizes with the sweep's checks and reports a pivot failure.
    __device__ static Triangle factorized(Sweep const& sweep, dca::JointAt const& at, bool works,
                                          Triangle const& z) {
        Triangle const factor = BranchlessFactorizer<false>{}(z, at.restricted);
        dca::PivotFailure found;
        sweep.s.watch(at, factor, found);
        if (works) sweep.s.note(found);
        return factor;
    }
    /// Stores the joint's matrices and offset.
    __device__ void put(double* node, bool works, Directions const& inboard,
                        Directions const& outboard) const {
        CATENA_UNROLL
        for (int i = 0; i < K; ++i) {
            if (works && own_ <= K)
                node[has_biases_ ? at_offset + i : at_inboard + i * K + column_] = inboard[i];
            if (works && own_ < K) node[at_outboard + i * K + column_] = outboard[i];
        }
    }
    /// Returns column i of a matrix in shared memory.
    __device__ static Directions column(double const* matrix, int i) {
        Directions c;
        CATENA_UNROLL
        for (int k = 0; k < K; ++k) c[k] = matrix[k * K + i];
        return c;
    }
    /// Computes and stores a column of the merged matrices, or the biases, as append() does.
    /// Columns of the joint's matrices are read just before use, because registers are scarce.
    __device__ void put_joined(double const* node, Directions const& of_inboard,
                               Directions const& of_outboard, bool works, double* joined,
                               Directions first, Directions last) const {
        Directions through;
        CATENA_UNROLL
        for (int i = 0; i < K; ++i) {
            Directions const inboard = column(node + at_inboard, i),
                             outboard = column(node + at_outboard, i);
            through[i] = dot(inboard, has_biases_ ? of_inboard : of_outboard);
            first[i] = has_biases_ ? first[i] - through[i]
                                   : dca::less_products(first[i], inboard, of_inboard);
            last[i] = has_biases_ ? last[i] + dot(outboard, of_inboard)
                                  : dca::less_products(last[i], outboard, of_outboard);
        }
        CATENA_UNROLL
        for (int i = 0; i < K; ++i) {
            if (works && own_ < K) joined[at_z12 + i * K + column_] = through[i];
            int const at_first = has_biases_ ? at_b1 + i : Triangle::at(i, 0) + column_;
            int const at_last = has_biases_ ? at_b2 + i : at_z22 + Triangle::at(i, 0) + column_;
            if (works && own_ <= K && (has_biases_ || i >= column_))
                joined[at_first] = first[i], joined[at_last] = last[i];
        }
    }

    /// Lane in the warp, lane in the team, and column of the matrices (clamped to the last one).
    int lane_, own_, column_;
    bool has_biases_;
};

}  // namespace catena::cuda::kernels
