// The fused sweep: matrices, biases, joint forces and accelerations in one inward and one outward
// pass. It serves where no other work could be overlapped with the matrix sweep, and where no sweep
// is repeated. The outward pass computes leaves again, except for data that take longer to compute
// than to store.
#pragma once

#include "dca/part_descent.hpp"
#include "dca/revolute_run.hpp"

namespace catena::dca {

/// Reads bodies one by one; their handles come from the configuration that the leaf holds. This
/// class defines the interface of `Bodies` in FusedSweep.
template <class Leaf>
struct Resting {
    static constexpr bool one_by_one = true;
    // One body's data, with the number of directions that its inboard joint restricts.
    template <class Place>
    struct Body : Leaf::template Body<Place> {
        int restricted;
    };
    Leaf leaf;
    // Number of restricted directions of every joint (LocalJoints::restricted).
    std::uint8_t const* restricted = nullptr;
    LoadsView loads;

    /// The bodies of one part, from `begin` on; nothing is read in advance.
    struct Part {
        std::int64_t begin;
    };
    template <class InverseLength, class Reader>
    CATENA_HD_IN_PLACE Part part(std::int64_t begin, std::int64_t /*end*/,
                                 InverseLength const& /*inverse_length*/,
                                 Reader const& /*by*/) const {
        return {begin};
    }
    template <class InverseLength>
    CATENA_HD_IN_PLACE Body<std::int64_t> body_at(std::int64_t k,
                                                  InverseLength const& /*inverse_length*/) const {
        return body(Part{k}, 0);
    }
    /// Returns body `i` of a part; `by` reads its numbers.
    template <class Reader = ReadHere>
    CATENA_HD_IN_PLACE Body<std::int64_t> body(Part const& part, int i,
                                               Reader const& by = {}) const {
        return {leaf.body(loads, part.begin + i, by), restricted[part.begin + i]};
    }
    /// Returns body `i` of a part that another reader has loaded (cuda/sweeps/prefetch.cuh).
    template <class AnyPart>
        requires requires(AnyPart const& part) { part.body(0); }
    CATENA_HD_IN_PLACE Body<std::int64_t> body(AnyPart const& part, int i) const {
        return part.body(i);
    }
    /// Intermediate results of a body's segment that its accelerations need again.
    template <class Place>
    struct Kept : Leaf::template Turned<Place> {
        Place k;
    };
    /// Computes the intermediate results of one body.
    template <class Place>
    CATENA_HD Kept<Place> keep(Body<Place> const& body) const {
        return {leaf.turned(loads, body), body.k};
    }

    /// Smaller intermediate results, for callers that store fewer numbers per body.
    using Turning = typename Leaf::template Turning<std::int64_t>;
    template <class Factorizer>
    CATENA_HD Turning turning(Body<std::int64_t> const& body, Factorizer const& factors) const {
        return leaf.turning(loads, body, factors);
    }
    /// Writes the accelerations of one body from the forces at its two joints, if they are
    /// requested.
    CATENA_HD_IN_PLACE void accelerate(Body<std::int64_t> const& body, Turning const& turning,
                                       Vector<double, Leaf::K> const& inboard,
                                       Vector<double, Leaf::K> const& outboard,
                                       AccelerationsView const& out) const {
        if (out.acceleration.origin)
            leaf.accelerate(body, leaf.turned(body, turning), inboard, outboard, out);
    }
    template <class Factorizer = dca::Factorizer>
    CATENA_HD_IN_PLACE void accelerate(Body<std::int64_t> const& body,
                                       Vector<double, Leaf::K> const& inboard,
                                       Vector<double, Leaf::K> const& outboard,
                                       AccelerationsView const& out,
                                       Factorizer const& factors = {}) const {
        if (out.acceleration.origin)
            accelerate(body, turning(body, factors), inboard, outboard, out);
    }
    template <class Factorizer>
    CATENA_HD_IN_PLACE void accelerate(Part const& part, int i,
                                       Vector<double, Leaf::K> const& inboard,
                                       Vector<double, Leaf::K> const& outboard,
                                       AccelerationsView const& out,
                                       Factorizer const& factors) const {
        accelerate(body(part, i), inboard, outboard, out, factors);
    }
    /// Reads bodies of several runs side by side. Each of their joints restricts all K directions
    /// of the handles.
    template <class Place>
    struct Walk {
        Resting const& bodies;
        Place begin;
        CATENA_HD_IN_PLACE Body<Place> body(int i) const {
            return {bodies.leaf.body(bodies.loads, begin + i), Leaf::K};
        }
    };
    template <class Place>
    CATENA_HD_IN_PLACE Walk<Place> walk(Place begin) const {
        return {*this, begin};
    }

    /// Returns the segment of one body: its matrices and its biases.
    template <class Place, class Factorizer = dca::Factorizer>
    CATENA_HD BiasedSegment<RealAt<Place>, Leaf::K> segment(Body<Place> const& body,
                                                            Factorizer const& factors = {}) const {
        return leaf.segment(loads, body, leaf.turned(body, leaf.turning(loads, body, factors)));
    }
    CATENA_HD BiasedSegment<double, Leaf::K> segment(Body<std::int64_t> const& body,
                                                     Turning const& turning) const {
        return leaf.segment(loads, body, leaf.turned(body, turning));
    }
    template <class Place>
    CATENA_HD BiasedSegment<RealAt<Place>, Leaf::K> segment(Body<Place> const& body,
                                                            Kept<Place> const& kept) const {
        return leaf.segment(loads, body, kept);
    }
    template <class Place>
    CATENA_HD void accelerate(Kept<Place> const& kept,
                              Vector<RealAt<Place>, Leaf::K> const& inboard,
                              Vector<RealAt<Place>, Leaf::K> const& outboard,
                              AccelerationsView const& out) const {
        if (out.acceleration.origin)
            leaf.accelerate(leaf.body(loads, kept.k), kept, inboard, outboard, out);
    }
};

/// One item of the fused sweep: matrices and biases in a single pass. The outward pass eliminates
/// each part again, starting from the force at the part's first joint. Runs on revolute joints are
/// computed by articulated-body inertias instead (floating_run.hpp). `Bodies` has the interface of
/// Resting.
template <class Leaf, class Bodies>
struct FusedSweep {
    static constexpr int K = Leaf::K;
    using Sweeps = TreeSweeps<Leaf>;
    using Segment = BiasedSegment<double, K>;
    using ShownNumbers = NumbersOfBoth<typename Sweeps::Matrices, typename Sweeps::Biases>;
    using Directions = typename Sweeps::Directions;
    using Joint = typename Sweeps::Joint;
    using Node = typename Sweeps::Node;
    using Part = typename Bodies::Part;
    using Body = typename Bodies::template Body<std::int64_t>;
    using Passed = OneSided<double, K>;
    using Passage = Elimination<double, K>;
    static constexpr bool descends = true, one_by_one = Bodies::one_by_one;
    // True if a node fits into the storage of a segment and replaces it there.
    static constexpr bool keeps_nodes = sizeof(Node) <= sizeof(Segment);
    static constexpr bool takes_whole_runs = Leaf::by_inertia;
    /// True if short chains can be processed as a whole (tree_sweeps.hpp).
    static constexpr bool supports_short_chains = !takes_whole_runs;
    /// True if parts are always processed in rolled loops: with larger handles, unrolled code
    /// overflows a processor's instruction cache.
    static constexpr bool in_loops = K > 3;
    /// Storage of a part's passages in registers.
    using PassagesHere = PassagesInRegisters<Passage, in_loops>;
    /// Arrays, bodies and results of the sweep.
    Sweeps s;
    Bodies bodies;
    AccelerationsView out;

    /// Bias sweep for stages that compute matrices and biases one after the other, because both at
    /// once need too many registers. Its outward pass is that of the fused sweep.
    struct Biases : BiasSweep<Leaf> {
        FusedSweep whole;
        template <bool unroll>
        CATENA_HD_IN_PLACE void down(Run const& run, int p, NothingRead, Directions const& first,
                                     Directions const& next) const {
            whole.template down<unroll>(run, p, whole.read(begin_of(run, p), end_of(run, p)), first,
                                        next);
        }
    };
    MatrixSweep<Leaf> matrices() const { return {s}; }
    Biases biases() const { return {{s, bodies.loads, out}, *this}; }

    /// Returns a run as one that may be computed by articulated-body inertias.
    CATENA_HD RevoluteRun<Leaf> whole(Run const& run) const { return {s, bodies.loads, out, run}; }

    /// Reads the bodies [begin, end) of one part.
    template <class InverseLength = dca::InverseLength, class Reader = ReadHere>
    CATENA_HD_IN_PLACE Part read(std::int64_t begin, std::int64_t end,
                                 InverseLength const& inverse_length = {},
                                 Reader const& by = {}) const {
        return bodies.part(begin, end, inverse_length, by);
    }
    /// Returns the segment of part `p`. `factors` factorizes joint matrices as factorize() does,
    /// but may fail; the part is then computed again without it.
    template <class AnyPart, class Factorizer = dca::Factorizer>
    CATENA_HD_IN_PLACE Segment part(Run const& run, int p, AnyPart const& part,
                                    Factorizer const& factors = {}) const {
        std::int64_t const begin = begin_of(run, p);
        int const count = static_cast<int>(end_of(run, p) - begin);
        PivotFailure found;
        Segment segment = bodies.segment(bodies.body(part, 0), factors);
        each_body<unrolled<K>>(1, count, [&](int i) {
            Body const body = bodies.body(part, i);
            pass_up(segment, i, bodies.segment(body, factors), {begin + i, body.restricted},
                    Forgotten{}, found, factors);
        });
        if constexpr (Factorizer::may_fail)
            if (!found.none()) return this->part(run, p, part);
        s.note(found);
        return segment;
    }
    /// Joins `count` bodies whose segments kept.get<Segment>(i) returns. restricted(i) is the
    /// number of restricted directions of joint i, and 0 from `count` on.
    ///
    /// kept.put(i, OneSided) gets what the outward pass needs of each joint. For the first body,
    /// whose joint is not eliminated here, that is z12 and the biases.
    template <class Restricted, class Kept>
    CATENA_HD_IN_PLACE Segment join_bodies(std::int64_t begin, int count,
                                           Restricted const& restricted, Kept&& kept) const {
        Segment segment = first_of(kept.template get<Segment>(0), kept);
        PivotFailure found;
        each_body<unrolled<K>>(1, count, [&](int i) {
            pass_up(segment, i, kept.template get<Segment>(i), {begin + i, restricted(i)}, kept,
                    found, Factorizer{});
        });
        s.note(found);
        return segment;
    }
    /// Joins bodies as join_bodies() does, without branches. Missing bodies have zero() segments
    /// and joints without restricted directions. `factors` records pivot failures itself.
    template <class Restricted, class Kept, class Factorizer>
    CATENA_HD_IN_PLACE Segment join_bodies_at_once(int count, Restricted const& restricted,
                                                   Kept&& kept, Factorizer const& factors) const {
        Segment own[part_length];
        CATENA_UNROLL
        for (int i = 0; i < part_length; ++i) own[i] = kept.template get<Segment>(i);
        Segment segment = first_of(own[0], kept);
        CATENA_UNROLL
        for (int i = 1; i < part_length; ++i) {
            Directions const b1 = segment.bias.b1;
            PivotFailure found;
            pass_up(segment, i, own[i], {0, restricted(i)}, kept, found, factors);
            if (i >= count) segment.bias.b1 = b1;
        }
        return segment;
    }
    /// Merges two segments at joint `at` and stores the joint's node.
    CATENA_HD Segment joined(Segment const& inboard, Segment const& outboard,
                             JointAt const& at) const {
        Node node;
        Segment const segment = joined(inboard, outboard, at, node);
        keep(at.k, node);
        return segment;
    }
    /// Merges two segments at joint `at`. The joint's node is returned in `node`, not stored.
    template <class Factorizer = dca::Factorizer>
    CATENA_HD Segment joined(Segment const& inboard, Segment const& outboard, JointAt const& at,
                             Node& node, Factorizer const& factors = {}) const {
        PivotFailure found;
        Segment segment = inboard;
        append(segment, outboard, at, node.joint, node.offset, found, factors);
        if constexpr (Factorizer::may_fail)
            if (!found.none()) return joined(inboard, outboard, at, node);
        s.note(found);
        return segment;
    }
    /// Merges two segments as joined() does; `factors` records pivot failures itself. Beyond a free
    /// tip, `outboard` may be zero() at a joint without restricted directions. The inboard handle
    /// then stays as it was, except that a zero of the bias may change its sign.
    template <class Factorizer>
    CATENA_HD Segment joined_at_once(Segment const& inboard, Segment const& outboard,
                                     int restricted, Node& node, Factorizer const& factors) const {
        PivotFailure found;
        Segment segment = inboard;
        append(segment, outboard, {0, restricted}, node.joint, node.offset, found, factors);
        return segment;
    }
    /// Stores the node of joint `k`.
    CATENA_HD void keep(std::int64_t k, Node const& node) const {
        s.joints.store(k, node.joint);
        s.offsets.store(k, node.offset);
    }
    CATENA_HD Segment load(std::int64_t slot) const {
        return {s.matrices.load(slot), s.biases.load(slot)};
    }
    CATENA_HD void store(std::int64_t slot, Segment const& segment) const {
        s.matrices.store(slot, segment.matrix);
        s.biases.store(slot, segment.bias);
    }
    /// Closes a chain at its root: computes the forces at its two ends.
    CATENA_HD void close(Root const& root, Segment const& floating) const {
        Segment const held = root.tip == TipTo::ground
                                 ? joined(floating, Segment::zero(), s.at(root.next))
                                 : floating;
        s.close(root, s.factorize_closing_joint(root, floating.matrix, held.matrix), held.bias);
    }
    /// Closes a chain whose tip is free, as close() does. `factors` must not fail.
    template <class Factorizer>
    CATENA_HD void close_free(JointAt const& first, Segment const& floating,
                              Factorizer const& factors) const {
        static_assert(!Factorizer::may_fail);
        Joint joint{};
        s.forces.store(first.k, first_force(first, floating, factors, joint.factor));
        s.joints.store(first.k, joint);
    }
    /// Returns the force at the first joint of a whole chain whose tip is free.
    template <class Factorizer = dca::Factorizer>
    CATENA_HD Directions first_force(JointAt const& at, Segment const& floating,
                                     Factorizer const& factors = {}) const {
        Symmetric<double, K> factor;
        return first_force(at, floating, factors, factor);
    }

    CATENA_HD Node node(std::int64_t joint) const { return s.node(joint); }
    /// Returns the force at an eliminated joint from those at its segment's two ends.
    CATENA_HD Directions force(Node const& node, Directions const& first,
                               Directions const& next) const {
        return disassemble(node.joint, node.offset, first, next);
    }
    CATENA_HD static Directions force(Passage const& passed, Directions const& next) {
        return passed.gain * next + passed.offset;
    }
    /// Outward pass of part `p`, with the passages in registers. `first` is the force at its first
    /// joint, `next` that at the joint after it.
    template <bool unroll>
    CATENA_HD_IN_PLACE void down(Run const& run, int p, Part const& part, Directions const& first,
                                 Directions next) const {
        PassagesHere passages;
        descend_part<unroll && !in_loops>(*this, run, p, part, first, next, passages);
    }
    /// Writes the results of body `k` from the forces at its joints and the intermediate results of
    /// its segment.
    template <class Turning>
    CATENA_HD_IN_PLACE void accelerate_turned(std::int64_t k, Body const& body,
                                              Turning const& turning, Directions const& inboard,
                                              Directions const& outboard) const {
        bodies.accelerate(body, turning, inboard, outboard, out);
        store_forces(s.leaf.group(), out, k, inboard, outboard);
    }
    /// Writes the results of body `k` from the forces at its joints.
    template <class Factorizer>
    CATENA_HD_IN_PLACE void accelerate(std::int64_t k, Body const& body, Directions const& inboard,
                                       Directions const& outboard,
                                       Factorizer const& factors) const {
        bodies.accelerate(body, inboard, outboard, out, factors);
        store_forces(s.leaf.group(), out, k, inboard, outboard);
    }

  private:
    template <class Factorizer>
    CATENA_HD Directions first_force(JointAt const& at, Segment const& floating,
                                     Factorizer const& factors,
                                     Symmetric<double, K>& factor) const {
        PivotFailure found;
        factor = factors(floating.matrix.z11, at.restricted);
        s.watch(at, factor, found);
        if constexpr (Factorizer::may_fail)
            if (!found.none()) return first_force(at, floating, dca::Factorizer{}, factor);
        s.note(found);
        return solve_upper(factor, solve_lower(factor, -floating.bias.b1));
    }
    /// Discards what the outward pass would need, where it computes it again.
    struct Forgotten {
        CATENA_HD static void put(int, Passed const&) {}
    };
    template <class Kept>
    CATENA_HD_IN_PLACE static Segment first_of(Segment const& own, Kept&& kept) {
        kept.put(0, Passed{{}, own.matrix.z12, own.bias});
        return own;
    }
    template <class Kept, class Factorizer>
    CATENA_HD_IN_PLACE void pass_up(Segment& segment, int i, Segment const& own, JointAt const& at,
                                    Kept&& kept, PivotFailure& found,
                                    Factorizer const& factors) const {
        Joint joint;
        Directions offset;
        append(segment, own, at, joint, offset, found, factors);
        kept.put(i, Passed{joint.factor, joint.outboard, own.bias});
    }
    template <class Factorizer>
    CATENA_HD void append(Segment& segment, Segment const& outboard, JointAt const& at,
                          Joint& joint, Directions& offset, PivotFailure& found,
                          Factorizer const& factors) const {
        dca::append(segment.matrix, outboard.matrix, at.restricted, joint, factors);
        s.watch(at, joint.factor, found);
        dca::append(segment.bias, outboard.bias, joint, offset);
    }
};

}  // namespace catena::dca
