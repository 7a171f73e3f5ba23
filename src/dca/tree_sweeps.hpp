// One item of every sweep over the canonical tree, host and device: a part of a run, a run, a merge, a root. Who calls them for which
// items is the driver's business (tree_solver.hpp) and the space's.
//
// A sweep is an object with Segment (what travels upwards), part(Run, p), joined(inboard, outboard, joint), load and store of slots,
// close(Root, segment) and, if it `descends`, node(joint), force(node, first, next), read(begin, end) of a part's bodies and
// down(Run, p, bodies, first, next) from what was read and the forces at the ends of part p.
#pragma once

#include "dca/closure.hpp"
#include "dca/leaves.hpp"
#include "dca/records.hpp"
#include "dca/tree.hpp"

namespace catena::dca {

/// A joint whose matrix is not positive definite; none at first.
struct Lost {
    unsigned long long joint = ~0ULL;
};

template <class Leaf_>
struct TreeSweeps {
    using Leaf = Leaf_;
    static constexpr int K = Leaf::K;
    using Matrices = SegmentMatrix<double, K>;
    using Biases = SegmentBias<double, K>;
    using Joint = JointMatrix<double, K>;
    using Directions = Vector<double, K>;

    Leaf leaf;
    std::uint8_t const* restricted = nullptr;      // of every joint (ChainGroup::restricted_of_joint)
    RecordsView<Matrices, Order::plain> matrices;  // by slot
    RecordsView<Biases, Order::plain> biases;
    RecordsView<Joint, Order::by_body> joints;  // by joint
    RecordsView<Directions, Order::by_body> offsets, forces;
    unsigned long long* lost = nullptr;  // the smallest joint whose matrix was not positive definite

    static std::int64_t bytes(Schedule const& schedule) {
        return schedule.slots * static_cast<std::int64_t>(sizeof(Matrices) + sizeof(Biases)) +
               schedule.joints * static_cast<std::int64_t>(sizeof(Joint) + 2 * sizeof(Directions));
    }
    /// The smallest joint so far whose matrix is not positive definite, as its pivots say.
    CATENA_HD void watch(std::int64_t k, Symmetric<double, K> const& factor, Lost& found) const { watch(k, restricted[k], factor, found); }
    CATENA_HD static void watch(std::int64_t k, int restricted_of_k, Symmetric<double, K> const& factor, Lost& found) {
        bool good = true;
        CATENA_UNROLL
        for (int i = 0; i < K; ++i) good = good && (i >= restricted_of_k || (factor(i, i) > 0 && factor(i, i) - factor(i, i) == 0));
        auto const bad = static_cast<unsigned long long>(k);
        found.joint = good || bad > found.joint ? found.joint : bad;
    }
    /// Apart from the watching, so that it does not stand between a loop's reads.
    CATENA_HD void note(Lost const& found) const {
        if (found.joint != Lost{}.joint) lower_to(lost, found.joint);
    }
    /// What the way down needs of a joint.
    struct Node {
        Joint joint;
        Directions offset;
    };
    CATENA_HD Node node(std::int64_t k) const { return {joints.load(k), offsets.load(k)}; }
    /// The forces at a chain's ends, from its bias as it is held. `first`: what fasten() returned.
    CATENA_HD void close(Root const& root, Joint const& first, Biases const& held) const {
        if (root.tip == TipTo::nothing)
            return forces.store(root.first, solve_upper(first.factor, solve_lower(first.factor, -held.b1)));
        bool const ring = root.tip == TipTo::first_body;
        Directions const force = closing_force(first, ring ? held.b2 - held.b1 : -held.b1);
        forces.store(root.first, force);
        if (ring) return forces.store(root.next, force);
        Node const tip = node(root.next);
        forces.store(root.next, disassemble(tip.joint, tip.offset, force, Directions::zero()));
    }
    /// The joint that is closed last, between a chain's first body and the ground or, in a ring, its last body; returns it. `floating`, the
    /// chain as it floats; `held`, with its tip on the ground.
    CATENA_HD Joint fasten(Root const& root, Matrices const& floating, Matrices const& held) const {
        Lost found;
        Joint first = joints.load(root.first);
        if (root.tip == TipTo::nothing) {
            first.factor = factorize(held.z11, restricted[root.first]);
        } else {
            bool const ring = root.tip == TipTo::first_body;
            first = closing_joint(ring ? ring_matrix(floating) : held.z11, open_response(floating, ring), restricted[root.first]);
        }
        joints.store(root.first, first);
        if (root.tip == TipTo::nothing || !has_least_norm(first)) watch(root.first, first.factor, found);
        note(found);
        return first;
    }
};

/// action(i) for a part's bodies i of [begin, end) in turn, unrolled for the smallest handles: larger ones fill the instruction cache as
/// they are.
template <int K, class Action>
CATENA_HD void each_body(int begin, int end, Action const& action) {
    if constexpr (K == 1) {
        CATENA_UNROLL
        for (int i = 0; i < part_length; ++i)
            if (i >= begin && i < end) action(i);
    } else {
        CATENA_NO_UNROLL
        for (int i = begin; i < end; ++i) action(i);
    }
}

/// The matrices of every segment and joint.
template <class Leaf>
struct MatrixSweep {
    static constexpr bool descends = false, keeps_nodes = false;
    using Sweeps = TreeSweeps<Leaf>;
    using Joint = typename Sweeps::Joint;
    using Segment = typename Sweeps::Matrices;
    Sweeps s;

    CATENA_HD Segment part(Run const& run, int p) const {
        std::int64_t const begin = begin_of(run, p);
        Lost found;
        Segment segment = s.leaf.matrix(begin);
        each_body<Leaf::K>(1, static_cast<int>(end_of(run, p) - begin), [&](int i) {
            std::int64_t const k = begin + i;
            append(segment, s.leaf.matrix(k), k, found);
        });
        s.note(found);
        return segment;
    }
    CATENA_HD Segment joined(Segment const& inboard, Segment const& outboard, std::int64_t k) const {
        Lost found;
        Segment segment = inboard;
        append(segment, outboard, k, found);
        s.note(found);
        return segment;
    }
    CATENA_HD Segment load(std::int64_t slot) const { return s.matrices.load(slot); }
    CATENA_HD void store(std::int64_t slot, Segment const& segment) const { s.matrices.store(slot, segment); }
    CATENA_HD void close(Root const& root, Segment const& floating) const {
        s.fasten(root, floating, root.tip == TipTo::ground ? joined(floating, Segment::zero(), root.next) : floating);
    }

  private:
    CATENA_HD void append(Segment& segment, Segment const& outboard, std::int64_t k, Lost& found) const {
        Joint joint;
        dca::append(segment, outboard, s.restricted[k], joint);
        s.joints.store(k, joint);
        s.watch(k, joint.factor, found);
    }
};

/// The biases, joint forces and accelerations, with the matrices assembled last.
template <class Leaf>
struct BiasSweep {
    static constexpr bool descends = true, keeps_nodes = false;
    using Sweeps = TreeSweeps<Leaf>;
    using Segment = typename Sweeps::Biases;
    using Directions = typename Sweeps::Directions;
    using Node = typename Sweeps::Node;
    Sweeps s;
    LoadsView loads;
    AccelerationsView out;

    CATENA_HD Segment part(Run const& run, int p) const {
        std::int64_t const begin = begin_of(run, p);
        Segment segment = s.leaf.bias(loads, begin);
        each_body<Leaf::K>(1, static_cast<int>(end_of(run, p) - begin), [&](int i) {
            std::int64_t const k = begin + i;
            append(segment, s.leaf.bias(loads, k), k);
        });
        return segment;
    }
    CATENA_HD Segment joined(Segment const& inboard, Segment const& outboard, std::int64_t k) const {
        Segment segment = inboard;
        append(segment, outboard, k);
        return segment;
    }
    CATENA_HD Segment load(std::int64_t slot) const { return s.biases.load(slot); }
    CATENA_HD void store(std::int64_t slot, Segment const& segment) const { s.biases.store(slot, segment); }
    /// Ground is a segment with zeta = 0: its acceleration stands in the biases of the joints to it.
    CATENA_HD void close(Root const& root, Segment const& floating) const {
        Segment const held = root.tip == TipTo::ground ? joined(floating, Segment::zero(), root.next) : floating;
        s.close(root, s.joints.load(root.first), held);
    }
    CATENA_HD Node node(std::int64_t joint) const { return s.node(joint); }
    CATENA_HD Directions force(Node const& node, Directions const& first, Directions const& next) const {
        return disassemble(node.joint, node.offset, first, next);
    }
    struct NothingYet {};
    CATENA_HD NothingYet read(std::int64_t /*begin*/, std::int64_t /*end*/) const { return {}; }
    CATENA_HD void down(Run const& run, int p, NothingYet, Directions const& first, Directions next) const {
        std::int64_t const begin = begin_of(run, p), end = end_of(run, p);
        each_body<Leaf::K>(0, static_cast<int>(end - begin), [&](int passed) {
            std::int64_t const k = end - 1 - passed;
            Directions const at_k = k == begin ? first : force(node(k), first, next);
            s.leaf.accelerate(loads, k, at_k, next, out);
            store_forces(s.leaf.group(), out, k, at_k, next);
            next = at_k;
        });
    }

  private:
    CATENA_HD void append(Segment& segment, Segment const& outboard, std::int64_t k) const {
        Directions offset;
        dca::append(segment, outboard, s.joints.load(k), offset);
        s.offsets.store(k, offset);
    }
};

/// A run's parts join one after the other.
template <class Sweep>
CATENA_HD void climb_run(Sweep const& sweep, Run const& run) {
    auto segment = sweep.part(run, 0);
    for (int p = 1; p < parts_of(run); ++p) segment = sweep.joined(segment, sweep.part(run, p), begin_of(run, p));
    sweep.store(run.slot, segment);
}
template <class Sweep>
CATENA_HD void climb_merge(Sweep const& sweep, Merge const& m) {
    sweep.store(m.slot, sweep.joined(sweep.load(m.inboard), sweep.load(m.outboard), m.joint));
}
template <class Sweep>
CATENA_HD void descend_merge(Sweep const& sweep, Merge const& m, typename Sweep::Node const& node) {
    sweep.s.forces.store(m.joint, sweep.force(node, sweep.s.forces.load(m.first), sweep.s.forces.load(m.next)));
}
template <class Sweep>
CATENA_HD void close_root(Sweep const& sweep, Root const& root) {
    sweep.close(root, sweep.load(root.slot));
}
/// Part p alone, from the forces at the run's ends: those at its own follow part after part from the far end.
template <class Sweep>
CATENA_HD void descend_part(Sweep const& sweep, Run const& run, int p, typename Sweep::Directions const& first,
                            typename Sweep::Directions next) {
    if (p >= parts_of(run)) return;
    auto bodies = sweep.read(begin_of(run, p), end_of(run, p));
    CATENA_NO_UNROLL
    for (int q = parts_of(run) - 1; q > p; --q) next = sweep.force(sweep.node(begin_of(run, q)), first, next);
    sweep.down(run, p, bodies, p == 0 ? first : sweep.force(sweep.node(begin_of(run, p)), first, next), next);
}
template <class Sweep>
CATENA_HD void descend_run(Sweep const& sweep, Run const& run) {
    auto const first = sweep.s.forces.load(run.body);
    auto next = sweep.s.forces.load(run.next);
    for (int p = parts_of(run) - 1; p >= 0; --p) {
        auto const at_begin = p == 0 ? first : sweep.force(sweep.node(begin_of(run, p)), first, next);
        auto bodies = sweep.read(begin_of(run, p), end_of(run, p));
        sweep.down(run, p, bodies, at_begin, next);
        next = at_begin;
    }
}

/// Forces at the top of chains that several ranks share, to this rank's own joints.
template <class Leaf>
struct CopyForces {
    TreeSweeps<Leaf> s;
    CATENA_HD void operator()(TopCopy const& copy) const { s.forces.store(copy.to, s.forces.load(copy.from)); }
};
/// The force of the joint after this rank's last body, which the next rank's first body feels.
template <class Leaf>
struct ForceOfNextRank {
    TreeSweeps<Leaf> s;
    DirectionsView out;
    std::int64_t from, to;
    CATENA_HD void operator()(std::int64_t) const { out.template store<Leaf::K>(to, s.forces.load(from)); }
};

}  // namespace catena::dca
