// Kernels for the runs and merges in the lanes of a vector. The operations are those of
// fused_sweep.hpp and tree_sweeps.hpp, in the same order, on vectors.
#pragma once

#include <new>
#include <type_traits>

#include "dca/simd/revolute_runs.hpp"

namespace catena::dca {

/// Data of the joints between segments, one joint per lane, for the outward pass.
template <class Real, int K>
struct NodeInLanes {
    JointMatrix<Real, K> joint;
    Vector<Real, K> offset;

    /// Joins `outboard` to `segment`, matrices and biases together.
    void append(BiasedSegment<Real, K>& segment, BiasedSegment<Real, K> const& outboard) {
        dca::append(segment.matrix, outboard.matrix, K, joint);
        dca::append(segment.bias, outboard.bias, joint, offset);
    }
    /// Returns the joint forces from those at the merged segments' two ends.
    Vector<Real, K> force(Vector<Real, K> const& first, Vector<Real, K> const& next) const {
        return disassemble(joint, offset, first, next);
    }
};
/// True if the records of the lanes have the sizes that RunWork::nodes assumes.
template <class Real, int K>
inline constexpr bool fits_nodes = sizeof(NodeInLanes<Real, K>) == node_numbers<K> * sizeof(Real) &&
                                   sizeof(OneSided<Real, K>) == passed_numbers<K> * sizeof(Real);
/// Records pivot failures of joints number[j] + further, whose factor is `factor`.
template <class Leaf, class Real, int K>
void watch(TreeSweeps<Leaf> const& sweeps, std::int64_t const* number, int further,
           Symmetric<Real, K> const& factor) {
    unsigned bad = 0;
    for (int i = 0; i < K; ++i) bad |= factor(i, i).not_positive();
    note_lost<Real>(sweeps, number, further, bad);
}

/// Kernel for runs that are joined body by body.
template <class Real, class Leaf>
class RunsSideBySide : RunsInTile<Real, Leaf> {
    static constexpr int K = Leaf::K, lanes = Real::lanes;
    using Base = RunsInTile<Real, Leaf>;
    // Members of RunsInTile that this kernel uses.
    using Base::work_, Base::begin_, Base::bodies_, Base::out_, Base::fill, Base::empty, Base::ask;
    using Bodies = typename Base::Bodies;
    using Body = typename Bodies::template Body<Column<Real>>;
    // Intermediate results of a body for its accelerations.
    using Kept = decltype(std::declval<Bodies const&>().keep(std::declval<Body const&>()));
    using Segment = BiasedSegment<Real, K>;
    using Directions = Vector<Real, K>;
    using Node = NodeInLanes<Real, K>;
    using Passed = OneSided<Real, K>;
    static_assert(fits_nodes<Real, K>);
    static constexpr int numbers_of_node = node_numbers<K> * lanes,
                         numbers_of_passed = passed_numbers<K> * lanes;
    // Sizes of the records in RunWork::nodes, in doubles.

  public:
    explicit RunsSideBySide(RunWork<Leaf> const& work) : Base(work) {}

    /// Inward pass of the runs in the lanes of one item.
    void climb(std::int64_t item) {
        RunsInLanes const& runs = work_.runs[item];
        Segment whole, part;
        CATENA_NO_UNROLL
        for (int p = 0; p < parts_of_run; ++p) {
            make_part(item, p, p == 0 ? whole : part);
            if (p == 0) continue;
            Node node;
            append(whole, part, node, runs, p * part_length);
            double* const kept = place_of_node(item, p);
            if (work_.prefetches) prefetch_to_write<Real>(kept, numbers_of_node, numbers_of_node);
            store_vectors<Real>(kept, node);
        }
        scatter<Real>(whole.matrix, work_.sweeps.matrices, runs.slot);
        scatter<Real>(whole.bias, work_.sweeps.biases, runs.slot);
    }
    /// Outward pass of the runs in the lanes of one item.
    void descend(std::int64_t item) {
        RunsInLanes const& runs = work_.runs[item];
        Directions first, next;
        gather<Real>(work_.sweeps.forces, runs.body, first);
        gather<Real>(work_.sweeps.forces, runs.next, next);
        CATENA_NO_UNROLL
        for (int p = parts_of_run - 1; p >= 0; --p) {
            Directions at_begin = first;
            if (p > 0) {
                Node node;
                double const* const kept = place_of_node(item, p);
                if (work_.prefetches) prefetch<Real>(kept, -numbers_of_node, numbers_of_node);
                load_vectors<Real>(kept, node);
                at_begin = node.force(first, next);
            }
            down(item, p, at_begin, next);
            next = at_begin;
        }
    }

  private:
    /// Returns the storage of an item's runs.
    double* place_of(std::int64_t item) const {
        return work_.nodes + item * kept_of_run<K>(work_.keeps_all) * lanes;
    }
    /// Returns the storage of the joint inboard of part p > 0.
    double* place_of_node(std::int64_t item, int p) const {
        return place_of(item) + (p - 1) * numbers_of_node;
    }
    /// Returns the storage of the run's body i. Precondition: the data of all bodies are kept.
    double* place_of_passed(std::int64_t item, int i) const {
        return place_of(item) + (parts_of_run - 1) * numbers_of_node + i * numbers_of_passed;
    }
    /// Assembles part p into `segment`.
    void make_part(std::int64_t item, int p, Segment& segment) {
        RunsInLanes const& runs = work_.runs[item];
        fill(runs, p, 1);
        auto bodies = bodies_.walk(begin_);
        Segment body;
        Node node;
        each_body<unrolled<K>>(0, part_length, [&](int i) {
            ask(runs, p * part_length + i, 1);
            // Placement new constructs the segment where it is used, without a copy.
            ::new (i == 0 ? &segment : &body) Segment(bodies_.segment(bodies.body(i)));
            if (i == 0) return keep(item, p, 0, {{}, segment.matrix.z12, segment.bias});
            append(segment, body, node, runs, p * part_length + i);
            keep(item, p, i, {node.joint.factor, node.joint.outboard, body.bias});
        });
    }
    /// Stores what body i of part p needs in the outward pass, if all bodies are kept.
    void keep(std::int64_t item, int p, int i, Passed const& passed) const {
        if constexpr (!Leaf::beads)
            if (work_.keeps_all)
                store_vectors<Real>(place_of_passed(item, p * part_length + i), passed);
    }
    /// Joins `outboard` to `segment` and records pivot failures; `body` is the index of the joint
    /// in the run.
    void append(Segment& segment, Segment const& outboard, Node& node, RunsInLanes const& runs,
                int body) const {
        node.append(segment, outboard);
        watch(work_.sweeps, runs.body, body, node.joint.factor);
    }
    /// Outward pass of part p.
    void down(std::int64_t item, int p, Directions const& first, Directions next) {
        RunsInLanes const& runs = work_.runs[item];
        fill(runs, p, -1);
        if (!Leaf::beads && work_.keeps_all)
            use_kept(runs, item, p, first, next);
        else
            eliminate_again(runs, p, first, next);
        empty(runs, p);
    }
    /// Outward pass that eliminates the part again, as descend_part().
    void eliminate_again(RunsInLanes const& runs, int p, Directions const& first, Directions next) {
        Elimination<Real, K> passed[part_length];
        Kept kept[part_length];
        auto bodies = bodies_.walk(begin_);
        Symmetric<Real, K> z22;
        Directions b2;
        each_body<unrolled<K>>(0, part_length, [&](int i) {
            ask(runs, p * part_length + i, -1);
            Segment const segment = take(bodies, i, kept);
            if (i == 0) {
                z22 = segment.matrix.z22;
                b2 = segment.bias.b2 + transposed_times(segment.matrix.z12, first);
            } else {
                passed[i] = eliminate(z22, b2, segment.matrix, segment.bias, K);
            }
        });
        back(kept, first, next, [&](int i) { return passed[i].gain * next + passed[i].offset; });
    }
    /// Outward pass from data that the inward pass kept, as forces_within().
    void use_kept(RunsInLanes const& runs, std::int64_t item, int p, Directions const& first,
                  Directions next) {
        Elimination<Real, K> passed[part_length];
        Kept kept[part_length];
        auto bodies = bodies_.walk(begin_);
        Directions b2;
        each_body<unrolled<K>>(0, part_length, [&](int i) {
            ask(runs, p * part_length + i, -1);
            kept[i] = bodies_.keep(bodies.body(i));
            Passed joint;
            load_vectors<Real>(place_of_passed(item, p * part_length + i), joint);
            if (i == 0)
                b2 = joint.bias.b2 + transposed_times(joint.outboard, first);
            else
                passed[i] = pass(b2, joint);
        });
        back(kept, first, next, [&](int i) { return passed[i].gain * next + passed[i].offset; });
    }
    template <class Bodies>
    Segment take(Bodies& bodies, int i, Kept* kept) const {
        Body const body = bodies.body(i);
        kept[i] = bodies_.keep(body);
        return bodies_.segment(body, kept[i]);
    }
    /// Goes from the last body, at whose outboard joint `next` acts, to the first. force(i) returns
    /// the force at body i's inboard joint.
    template <class Force>
    void back(Kept const* kept, Directions const& first, Directions& next, Force const& force) {
        each_body<unrolled<K>>(0, part_length, [&](int from_end) {
            int const i = part_length - 1 - from_end;
            Directions const at_i = i == 0 ? first : force(i);
            give(kept[i], i, at_i, next);
            next = at_i;
        });
    }
    /// Writes the results of body i from the forces at its joints.
    void give(Kept const& kept, int i, Directions const& inboard, Directions const& outboard) {
        bodies_.accelerate(kept, inboard, outboard, out_);
        store_forces(GroupView{}, out_, begin_ + i, inboard, outboard);
    }
};

/// The kernel for the runs of a leaf.
template <class Real, class Leaf>
using Runs = std::conditional_t<Leaf::by_inertia, RevoluteRunsSideBySide<Real, Leaf>,
                                RunsSideBySide<Real, Leaf>>;

/// Inward pass of the items [begin, end).
template <class Real, class Leaf>
[[gnu::flatten]] void climb_runs(RunWork<Leaf> const& work, std::int64_t begin, std::int64_t end) {
    Runs<Real, Leaf> runs(work);
    for (std::int64_t item = begin; item < end; ++item) runs.climb(item);
}
/// Outward pass of the items [begin, end).
template <class Real, class Leaf>
[[gnu::flatten]] void descend_runs(RunWork<Leaf> const& work, std::int64_t begin,
                                   std::int64_t end) {
    Runs<Real, Leaf> runs(work);
    for (std::int64_t item = end; item-- > begin;)
        // Reverse order, because the items processed last may still be in the caches.
        runs.descend(item);
}
/// Prefetches the segments of a merge for reading and its nodes for writing.
template <class Real, class Leaf>
[[gnu::always_inline]] inline void prefetch_merge(MergeWork<Leaf> const& work, std::int64_t item) {
    constexpr int numbers_of_node = node_numbers<Leaf::K> * Real::lanes;
    std::int64_t const* const segments[] = {work.merges[item].inboard, work.merges[item].outboard};
    for (std::int64_t const* slots : segments) {
        prefetch_records<Real>(work.sweeps.matrices, slots);
        prefetch_records<Real>(work.sweeps.biases, slots);
    }
    prefetch_to_write<Real>(work.nodes, item * numbers_of_node, numbers_of_node);
}
/// Inward pass of the merges [begin, end): stores their segments and nodes.
template <class Real, class Leaf>
[[gnu::flatten]] void climb_merges(MergeWork<Leaf> const& work, std::int64_t begin,
                                   std::int64_t end) {
    constexpr int K = Leaf::K, numbers_of_node = node_numbers<K> * Real::lanes;
    auto const& [sweeps, merges, nodes, prefetches] = work;
    for (std::int64_t item = begin; item < end; ++item) {
        MergesInLanes const& m = merges[item];
        if (prefetches && item + 1 < end) prefetch_merge<Real>(work, item + 1);
        BiasedSegment<Real, K> segment, outboard;
        gather<Real>(sweeps.matrices, m.inboard, segment.matrix);
        gather<Real>(sweeps.biases, m.inboard, segment.bias);
        gather<Real>(sweeps.matrices, m.outboard, outboard.matrix);
        gather<Real>(sweeps.biases, m.outboard, outboard.bias);
        NodeInLanes<Real, K> node;
        node.append(segment, outboard);
        watch(sweeps, m.joint, 0, node.joint.factor);
        store_vectors<Real>(nodes + item * numbers_of_node, node);
        scatter<Real>(segment.matrix, sweeps.matrices, m.slot);
        scatter<Real>(segment.bias, sweeps.biases, m.slot);
    }
}
/// Outward pass of the merges [begin, end): stores the forces at their joints.
template <class Real, class Leaf>
[[gnu::flatten]] void descend_merges(MergeWork<Leaf> const& work, std::int64_t begin,
                                     std::int64_t end) {
    constexpr int K = Leaf::K;
    auto const& [sweeps, merges, nodes, prefetches] = work;
    for (std::int64_t item = begin; item < end; ++item) {
        MergesInLanes const& m = merges[item];
        NodeInLanes<Real, K> node;
        load_vectors<Real>(nodes + item * node_numbers<K> * Real::lanes, node);
        Vector<Real, K> first, next;
        gather<Real>(sweeps.forces, m.first, first);
        gather<Real>(sweeps.forces, m.next, next);
        scatter<Real>(node.force(first, next), sweeps.forces, m.joint);
    }
}
/// Returns the kernels for one vector type.
template <class Real, class Leaf>
RunKernels<Leaf> kernels() {
    return {climb_runs<Real, Leaf>, descend_runs<Real, Leaf>, climb_merges<Real, Leaf>,
            descend_merges<Real, Leaf>};
}

}  // namespace catena::dca
