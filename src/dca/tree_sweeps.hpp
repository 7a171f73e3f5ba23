// One item of every sweep over the canonical tree, host and device: a part of a run, a run, a
// merge, a root. The driver (tree_solver.hpp) and the space that runs the kernels decide which
// items to call.
//
// A sweep is an object with these members:
// - `s`, its arrays: TreeSweeps, or another SweepsOf<Leaf>::Sweeps with all members of TreeSweeps;
// - Segment, the record that travels inward; load and store of its slots;
// - Part, the data of a part's bodies that read(begin, end) returns;
// - part(Run, p, Part), which returns the segment of a part;
// - joined(inboard, outboard, JointAt), which merges two segments;
// - close(Root, segment), which computes the forces at a chain's ends.
//
// A sweep that `descends` also has an outward pass:
// - node(joint) and force(node, first, next);
// - down<unroll>(Run, p, Part, first, next), from the states at the two ends of part p;
// - ShownNumbers, the numbers that ranks exchange between the passes (frontier_records.hpp).
//
// A sweep that `keeps_nodes` has joined(..., node) and keep(joint, node) as well.
//
// A sweep that `supports_short_chains` serves short chains (cuda/short/short_chain.cuh,
// cuda/sweeps/group_lanes.cuh). Its bodies are read one by one (body_at). It has join_bodies() or
// join_bodies_at_once(), joined_at_once(), first_force(), and accelerate() or accelerate_turned();
// part_descent.hpp has the outward pass of its parts. Its joints, forces and slots are not read
// afterwards, so that not all of them are written.
//
// A sweep with matrices() and biases() may leave stages with runs to these two, one after the other
// (cuda/sweeps/stage_walk.cuh). A sweep whose members accept `factors` has joined(..., factors),
// close_free(), and PassagesHere for descend_part(), which other storage may replace
// (cuda/sweeps/run_parts.cuh).
#pragma once

#include "dca/body_leaf.hpp"
#include "dca/loop_closure.hpp"
#include "tree/frontier_records.hpp"
#include "tree/stages.hpp"

namespace catena::dca {

/// A joint to be eliminated, with the number of directions that it restricts.
struct JointAt {
    std::int64_t k = 0;
    int restricted = 0;
};

/// The smallest joint whose matrix is not positive definite; no joint at first.
struct PivotFailure {
    unsigned long long joint = ~0ULL;
    CATENA_HD void add(std::int64_t k) {
        auto const bad = static_cast<unsigned long long>(k);
        joint = bad < joint ? bad : joint;
    }
    CATENA_HD bool none() const { return joint == ~0ULL; }
};
/// True if `inverse` is the reciprocal of a pivot of a positive definite matrix: positive and
/// finite.
CATENA_HD bool is_good(double inverse) { return inverse > 0 && inverse - inverse == 0; }

/// The arrays of all sweeps over one group of chains, and the operations at their joints.
template <class Leaf_>
struct TreeSweeps {
    using Leaf = Leaf_;
    static constexpr int K = Leaf::K;
    using Matrices = SegmentMatrix<double, K>;
    using Biases = SegmentBias<double, K>;
    using Joint = JointMatrix<double, K>;
    using Directions = Vector<double, K>;
    using Offset = Directions;
    using State = Directions;  // State of a joint that the outward pass hands on: its force.
    /// Numbers of doubles per segment and joint that a GPU stage stores in a block (StageRecords).
    static constexpr StageRecords in_stage = stage_records(K, Leaf::projected),
                                  in_stage_of_whole_runs = stage_records(K, Leaf::projected, true);

    Leaf leaf;
    // Number of restricted directions of every joint (LocalJoints::restricted).
    std::uint8_t const* restricted = nullptr;
    RecordsView<Matrices, Order::plain> matrices;  // Indexed by slot.
    RecordsView<Biases, Order::plain> biases;
    RecordsView<Joint, Order::by_body> joints;  // Indexed by joint.
    RecordsView<Directions, Order::by_body> offsets, forces;
    // Smallest joint whose matrix was not positive definite.
    unsigned long long* lost = nullptr;

    /// Returns the size of the arrays for a schedule, in bytes.
    static std::int64_t bytes(Schedule const& schedule) {
        return schedule.slots * static_cast<std::int64_t>(sizeof(Matrices) + sizeof(Biases)) +
               schedule.joints * static_cast<std::int64_t>(sizeof(Joint) + 2 * sizeof(Directions));
    }
    CATENA_HD JointAt at(std::int64_t k) const { return {k, restricted[k]}; }
    /// Checks the pivots of `joint` and records it in `found`, if they are bad and no smaller joint
    /// is recorded.
    CATENA_HD static void watch(JointAt const& joint, Symmetric<double, K> const& factor,
                                PivotFailure& found) {
        bool good = true;
        CATENA_UNROLL
        for (int i = 0; i < K; ++i) good = good && (i >= joint.restricted || is_good(factor(i, i)));
        auto const bad = static_cast<unsigned long long>(joint.k);
        found.joint = good || bad > found.joint ? found.joint : bad;
    }
    /// Reports a pivot failure to `lost`. Checking and reporting are separate, so that the atomic
    /// operation does not delay the reads of a loop.
    CATENA_HD void note(PivotFailure const& found) const {
        if (!found.none()) lower_to(lost, found.joint);
    }
    /// Returns number n of a slot's record: its matrices, followed by its biases.
    CATENA_HD double& number_of_segment(std::int64_t slot, int n) const {
        constexpr int of_matrices = sizeof(Matrices) / sizeof(double);
        return n < of_matrices ? matrices.number(slot, n) : biases.number(slot, n - of_matrices);
    }
    /// Data of a joint that the outward pass needs.
    struct Node {
        Joint joint;
        Directions offset;
    };
    CATENA_HD Node node(std::int64_t k) const {
        return {joints.load_last(k), offsets.load_last(k)};
    }
    /// Returns number n of a joint's node.
    CATENA_HD double& number_of_node(std::int64_t k, int n) const {
        constexpr int of_joint = sizeof(Joint) / sizeof(double);
        return n < of_joint ? joints.number(k, n) : offsets.number(k, n - of_joint);
    }
    /// Computes the forces at a chain's ends (chapter, eqs 2.10-2.11) from the bias of the chain
    /// held at its tip. `first` is what factorize_closing_joint() returned.
    CATENA_HD void close(Root const& root, Joint const& first, Biases const& held) const {
        if (root.tip == TipTo::nothing)
            return forces.store(root.first,
                                solve_upper(first.factor, solve_lower(first.factor, -held.b1)));
        bool const ring = root.tip == TipTo::first_body;
        Directions const force = closing_force(first, ring ? held.b2 - held.b1 : -held.b1);
        forces.store(root.first, force);
        if (ring) return forces.store(root.next, force);
        Node const tip = node(root.next);
        forces.store(root.next, disassemble(tip.joint, tip.offset, force, Directions::zero()));
    }
    /// Factorizes and returns the joint that is closed last: between a chain's first body and the
    /// ground, or in a ring between its first and its last body. `floating` belongs to the chain
    /// with a free tip, `held` to the chain with its tip on the ground.
    CATENA_HD Joint factorize_closing_joint(Root const& root, Matrices const& floating,
                                            Matrices const& held) const {
        PivotFailure found;
        JointAt const at_first = at(root.first);
        Joint first{};
        bool has_least_norm = false;
        if (root.tip == TipTo::nothing) {
            first.factor = factorize(held.z11, at_first.restricted);
        } else {
            bool const ring = root.tip == TipTo::first_body;
            auto const closing = closing_joint(ring ? ring_matrix(floating) : held.z11,
                                               open_response(floating, ring), at_first.restricted);
            first = closing.joint;
            has_least_norm = closing.has_least_norm;
        }
        joints.store(root.first, first);
        if (!has_least_norm) watch(at_first, first.factor, found);
        note(found);
        return first;
    }
};

/// True if loops over a part's bodies are always unrolled. With larger handles, unrolled code would
/// overflow a GPU's instruction cache.
template <int K>
constexpr bool unrolled = K == 1;
/// Calls action(i) for the bodies i of a part in [begin, end), in increasing order.
template <bool unroll, class Action>
CATENA_HD void each_body(int begin, int end, Action const& action) {
    if constexpr (unroll) {
        CATENA_UNROLL
        for (int i = 0; i < part_length; ++i)
            if (i >= begin && i < end) action(i);
    } else {
        CATENA_NO_UNROLL
        for (int i = begin; i < end; ++i) action(i);
    }
}
/// Calls action(i) for the bodies i of a part in [begin, end), in decreasing order.
template <bool unroll, class Action>
CATENA_HD void each_body_back(int begin, int end, Action const& action) {
    if constexpr (unroll) {
        CATENA_UNROLL
        for (int i = part_length - 1; i >= 0; --i)
            if (i >= begin && i < end) action(i);
    } else {
        CATENA_NO_UNROLL
        for (int i = end - 1; i >= begin; --i) action(i);
    }
}

/// Empty Part of sweeps that read bodies one by one.
struct NothingRead {};

/// The matrix sweep: matrices of every segment and joint.
template <class Leaf>
struct MatrixSweep {
    static constexpr bool descends = false, keeps_nodes = false, supports_short_chains = false;
    using Sweeps = TreeSweeps<Leaf>;
    using Joint = typename Sweeps::Joint;
    using Segment = typename Sweeps::Matrices;
    using Part = NothingRead;
    Sweeps s;

    /// Reads nothing in advance; the bodies are read one by one in part().
    CATENA_HD Part read(std::int64_t /*begin*/, std::int64_t /*end*/) const { return {}; }
    /// Returns the segment of part p and stores the joints inside it.
    CATENA_HD Segment part(Run const& run, int p, Part) const {
        std::int64_t const begin = begin_of(run, p);
        PivotFailure found;
        Segment segment = s.leaf.matrix(begin);
        each_body<unrolled<Leaf::K>>(1, static_cast<int>(end_of(run, p) - begin), [&](int i) {
            std::int64_t const k = begin + i;
            append(segment, s.leaf.matrix(k), s.at(k), found);
        });
        s.note(found);
        return segment;
    }
    /// Returns the merged segment and stores its joint.
    CATENA_HD Segment joined(Segment const& inboard, Segment const& outboard,
                             JointAt const& at) const {
        PivotFailure found;
        Segment segment = inboard;
        append(segment, outboard, at, found);
        s.note(found);
        return segment;
    }
    CATENA_HD Segment load(std::int64_t slot) const { return s.matrices.load(slot); }
    CATENA_HD void store(std::int64_t slot, Segment const& segment) const {
        s.matrices.store(slot, segment);
    }
    /// Closes a chain at its root: factorizes the joint that is closed last.
    CATENA_HD void close(Root const& root, Segment const& floating) const {
        s.factorize_closing_joint(root, floating,
                                  root.tip == TipTo::ground
                                      ? joined(floating, Segment::zero(), s.at(root.next))
                                      : floating);
    }

  private:
    CATENA_HD void append(Segment& segment, Segment const& outboard, JointAt const& at,
                          PivotFailure& found) const {
        Joint joint;
        dca::append(segment, outboard, at.restricted, joint);
        s.joints.store(at.k, joint);
        s.watch(at, joint.factor, found);
    }
};

/// The bias sweep: biases, joint forces and accelerations, with the matrices assembled last.
template <class Leaf>
struct BiasSweep {
    static constexpr bool descends = true, keeps_nodes = false, supports_short_chains = false;
    using Sweeps = TreeSweeps<Leaf>;
    using Segment = typename Sweeps::Biases;
    using ShownNumbers = RecordNumbers<Segment>;
    using Directions = typename Sweeps::Directions;
    using Node = typename Sweeps::Node;
    using Part = NothingRead;
    Sweeps s;
    LoadsView loads;
    AccelerationsView out;

    CATENA_HD Part read(std::int64_t /*begin*/, std::int64_t /*end*/) const { return {}; }
    /// Returns the bias of part p and stores the offsets of the joints inside it.
    CATENA_HD Segment part(Run const& run, int p, Part) const {
        std::int64_t const begin = begin_of(run, p);
        Segment segment = s.leaf.bias(loads, begin);
        each_body<unrolled<Leaf::K>>(1, static_cast<int>(end_of(run, p) - begin), [&](int i) {
            std::int64_t const k = begin + i;
            append(segment, s.leaf.bias(loads, k), k);
        });
        return segment;
    }
    /// Returns the merged bias and stores the joint's offset.
    CATENA_HD Segment joined(Segment const& inboard, Segment const& outboard,
                             JointAt const& at) const {
        Segment segment = inboard;
        append(segment, outboard, at.k);
        return segment;
    }
    CATENA_HD Segment load(std::int64_t slot) const { return s.biases.load(slot); }
    CATENA_HD void store(std::int64_t slot, Segment const& segment) const {
        s.biases.store(slot, segment);
    }
    /// Closes a chain at its root. The ground is a segment with zeta = 0; its acceleration is
    /// contained in the biases of the joints to it.
    CATENA_HD void close(Root const& root, Segment const& floating) const {
        Segment const held = root.tip == TipTo::ground
                                 ? joined(floating, Segment::zero(), s.at(root.next))
                                 : floating;
        s.close(root, s.joints.load(root.first), held);
    }
    CATENA_HD Node node(std::int64_t joint) const { return s.node(joint); }
    CATENA_HD Directions force(Node const& node, Directions const& first,
                               Directions const& next) const {
        return disassemble(node.joint, node.offset, first, next);
    }
    /// Outward pass of part p from the forces at its two ends: writes joint forces and
    /// accelerations.
    template <bool /*unroll*/>
    CATENA_HD void down(Run const& run, int p, Part, Directions const& first,
                        Directions next) const {
        std::int64_t const begin = begin_of(run, p), end = end_of(run, p);
        each_body<unrolled<Leaf::K>>(0, static_cast<int>(end - begin), [&](int passed) {
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

/// A sweep that computes runs on revolute joints as a whole (RevoluteRun): whole(run) has their
/// passes.
template <class Sweep>
concept takes_whole_runs = requires { requires Sweep::takes_whole_runs; };

/// Inward pass of a run that joins its parts one after the other: part(p) returns each segment,
/// join(segment, outboard, joint) merges two.
template <class Sweep, class Part, class Join>
CATENA_HD void climb_parts(Sweep const& sweep, Run const& run, Part const& part, Join const& join) {
    typename Sweep::Segment segment;
    CATENA_NO_UNROLL
    for (int p = 0; p < parts_of(run); ++p) {
        auto const next = part(p);
        segment = p == 0 ? next : join(segment, next, sweep.s.at(begin_of(run, p)));
    }
    sweep.store(run.slot, segment);
}
/// Inward pass of one run: stores its segment.
template <class Sweep>
CATENA_HD void climb_run(Sweep const& sweep, Run const& run) {
    if constexpr (takes_whole_runs<Sweep>)
        if (auto const whole = sweep.whole(run); whole.is_on_revolutes())
            return sweep.store(run.slot, whole.climb());
    climb_parts(
        sweep, run,
        [&](int p) { return sweep.part(run, p, sweep.read(begin_of(run, p), end_of(run, p))); },
        [&](auto const& inboard, auto const& outboard, JointAt const& at) {
            return sweep.joined(inboard, outboard, at);
        });
}
/// Inward pass of one merge: stores the merged segment.
template <class Sweep>
CATENA_HD void climb_merge(Sweep const& sweep, Merge const& m) {
    sweep.store(m.slot,
                sweep.joined(sweep.load(m.inboard), sweep.load(m.outboard), sweep.s.at(m.joint)));
}
/// Outward pass of one merge: stores the state of its joint.
template <class Sweep>
CATENA_HD void descend_merge(Sweep const& sweep, Merge const& m, typename Sweep::Node const& node) {
    sweep.s.forces.store(
        m.joint, sweep.force(node, sweep.s.forces.load(m.first), sweep.s.forces.load(m.next)));
}
/// Closes one chain at its root.
template <class Sweep>
CATENA_HD void close_root(Sweep const& sweep, Root const& root) {
    sweep.close(root, sweep.load(root.slot));
}
/// Outward pass of one run, from the states at its two ends.
template <class Sweep>
CATENA_HD void descend_run(Sweep const& sweep, Run const& run) {
    auto const first = sweep.s.forces.load(run.body);
    auto next = sweep.s.forces.load(run.next);
    if constexpr (takes_whole_runs<Sweep>)
        if (auto const whole = sweep.whole(run); whole.is_on_revolutes())
            return whole.descend(first, next);
    for (int p = parts_of(run) - 1; p >= 0; --p) {
        auto const at_begin =
            p == 0 ? first : sweep.force(sweep.node(begin_of(run, p)), first, next);
        sweep.template down<true>(run, p, sweep.read(begin_of(run, p), end_of(run, p)), at_begin,
                                  next);
        next = at_begin;
    }
}

/// The sweeps of a kind of leaf. Specializations replace these defaults.
template <class Leaf>
struct SweepsOf {
    using Sweeps = TreeSweeps<Leaf>;
    using OfMatrices = MatrixSweep<Leaf>;
    using OfBiases = BiasSweep<Leaf>;
};

/// Returns the force in a joint's state.
template <int K>
CATENA_HD Vector<double, K> const& force_of(Vector<double, K> const& force) {
    return force;
}
/// Writes the force of the joint after this rank's last body. It acts on the next rank's first
/// body.
template <class Sweeps>
struct ForceOfNextRank {
    Sweeps s;
    DirectionsView out;
    std::int64_t from, to;
    CATENA_HD void operator()(std::int64_t) const {
        out.template store<Sweeps::K>(to, force_of(s.forces.load(from)));
    }
};

}  // namespace catena::dca
