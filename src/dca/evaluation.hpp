// Matrices, biases, forces and accelerations in one sweep, for where nothing is to be hidden and nothing repeated: leaves are computed
// again on the way down, but for what takes longer than to keep it.
#pragma once

#include "dca/tree_sweeps.hpp"

namespace catena::dca {

/// Bodies read one by one with what a leaf takes from the configuration.
template <class Leaf>
struct Resting {
    static constexpr bool one_by_one = true;
    template <class Place>
    struct Body : Leaf::template Body<Place> {
        int restricted;
    };
    Leaf leaf;
    std::uint8_t const* restricted = nullptr;
    LoadsView loads;

    /// Bodies from `begin` on.
    struct Part {
        std::int64_t begin;
    };
    template <class InverseLength = dca::InverseLength>
    CATENA_HD_IN_PLACE Part part(std::int64_t begin, std::int64_t /*end*/, InverseLength const& /*inverse_length*/ = {}) const {
        return {begin};
    }
    CATENA_HD_IN_PLACE Body<std::int64_t> body(Part const& part, int i) const {
        return {leaf.body(loads, part.begin + i), restricted[part.begin + i]};
    }
    /// What its accelerations need of what its segment needed.
    template <class Place>
    struct Kept : Leaf::template Turned<Place> {
        Place k;
    };
    template <class Place>
    CATENA_HD Kept<Place> keep(Body<Place> const& body) const {
        return {leaf.turned(loads, body), body.k};
    }

    CATENA_HD_IN_PLACE void accelerate(Part const& part, int i, Vector<double, Leaf::K> const& inboard,
                                       Vector<double, Leaf::K> const& outboard, AccelerationsView const& out) const {
        leaf.accelerate(loads, part.begin + i, inboard, outboard, out);
    }
    CATENA_HD_IN_PLACE void accelerate(Body<std::int64_t> const& body, Vector<double, Leaf::K> const& inboard,
                                       Vector<double, Leaf::K> const& outboard, AccelerationsView const& out) const {
        if (out.acceleration.origin) leaf.accelerate(body, leaf.turned(loads, body), inboard, outboard, out);
    }
    /// Of several bodies side by side, whose joints restrict what handles carry.
    template <class Place>
    struct Walk {
        Resting const& bodies;
        Place begin;
        CATENA_HD_IN_PLACE Body<Place> body(int i) const { return {bodies.leaf.body(bodies.loads, begin + i), Leaf::K}; }
    };
    template <class Place>
    CATENA_HD_IN_PLACE Walk<Place> walk(Place begin) const {
        return {*this, begin};
    }

    template <class Place>
    CATENA_HD BiasedSegment<RealAt<Place>, Leaf::K> segment(Body<Place> const& body) const {
        return leaf.segment(loads, body, leaf.turned(loads, body));
    }
    template <class Place>
    CATENA_HD BiasedSegment<RealAt<Place>, Leaf::K> segment(Body<Place> const& body, Kept<Place> const& kept) const {
        return leaf.segment(loads, body, kept);
    }
    template <class Place>
    CATENA_HD void accelerate(Kept<Place> const& kept, Vector<RealAt<Place>, Leaf::K> const& inboard,
                              Vector<RealAt<Place>, Leaf::K> const& outboard, AccelerationsView const& out) const {
        if (out.acceleration.origin) leaf.accelerate(leaf.body(loads, kept.k), kept, inboard, outboard, out);
    }
};

/// What joins segments with their biases, whatever they are made of.
template <class Leaf>
struct JoinsBoth {
    static constexpr int K = Leaf::K;
    using Sweeps = TreeSweeps<Leaf>;
    using Segment = BiasedSegment<double, K>;
    using Joint = typename Sweeps::Joint;
    using Directions = typename Sweeps::Directions;
    using Node = typename Sweeps::Node;
    static constexpr bool descends = true, keeps_nodes = sizeof(Node) <= sizeof(Segment);  // a node takes a segment's place
    Sweeps s;

    CATENA_HD Segment joined(Segment const& inboard, Segment const& outboard, JointAt const& at) const {
        Node node;
        Segment const segment = joined(inboard, outboard, at, node);
        keep(at.k, node);
        return segment;
    }
    template <class Factors = dca::Factors>
    CATENA_HD Segment joined(Segment const& inboard, Segment const& outboard, JointAt const& at, Node& node,
                             Factors const& factors = {}) const {
        Lost found;
        Segment segment = inboard;
        append(segment, outboard, at, node.joint, node.offset, found, factors);
        if constexpr (Factors::may_fail)
            if (!found.none()) return joined(inboard, outboard, at, node);
        s.note(found);
        return segment;
    }
    template <class Factors>
    CATENA_HD void append(Segment& segment, Segment const& outboard, JointAt const& at, Joint& joint, Directions& offset, Lost& found,
                          Factors const& factors) const {
        dca::append(segment.matrix, outboard.matrix, at.restricted, joint, factors);
        s.watch(at, joint.factor, found);
        dca::append(segment.bias, outboard.bias, joint, offset);
    }
    CATENA_HD void keep(std::int64_t k, Node const& node) const {
        s.joints.store(k, node.joint);
        s.offsets.store(k, node.offset);
    }
    CATENA_HD Segment load(std::int64_t slot) const { return {s.matrices.load(slot), s.biases.load(slot)}; }
    CATENA_HD void store(std::int64_t slot, Segment const& segment) const {
        s.matrices.store(slot, segment.matrix);
        s.biases.store(slot, segment.bias);
    }
    CATENA_HD void close(Root const& root, Segment const& floating) const {
        Segment const held = root.tip == TipTo::ground ? joined(floating, Segment::zero(), s.at(root.next)) : floating;
        s.close(root, s.fasten(root, floating.matrix, held.matrix), held.bias);
    }
    /// Of a whole chain whose tip is free, at its first joint: as close().
    CATENA_HD Directions first_force(JointAt const& at, Segment const& floating) const {
        Lost found;
        auto const factor = factorize(floating.matrix.z11, at.restricted);
        s.watch(at, factor, found);
        s.note(found);
        return solve_upper(factor, solve_lower(factor, -floating.bias.b1));
    }
    CATENA_HD Node node(std::int64_t joint) const { return s.node(joint); }
    CATENA_HD Directions force(Node const& node, Directions const& first, Directions const& next) const {
        return disassemble(node.joint, node.offset, first, next);
    }
};

/// On the way down a part is eliminated again from the force at its first joint. `Bodies`: as Resting.
template <class Leaf, class Bodies>
struct Evaluation : JoinsBoth<Leaf> {
    static constexpr bool goes_short = true, one_by_one = Bodies::one_by_one;
    using Base = JoinsBoth<Leaf>;
    using Base::K, Base::s;
    using typename Base::Directions, typename Base::Joint, typename Base::Segment;
    using Part = typename Bodies::Part;
    using Body = typename Bodies::template Body<std::int64_t>;
    using Passed = OneSided<double, K>;
    using Passage = Elimination<double, K>;
    Bodies bodies;
    AccelerationsView out;

    template <class InverseLength = dca::InverseLength>
    CATENA_HD_IN_PLACE Part read(std::int64_t begin, std::int64_t end, InverseLength const& inverse_length = {}) const {
        return bodies.part(begin, end, inverse_length);
    }
    CATENA_HD_IN_PLACE Segment part(Run const& run, int p, Part const& part) const {
        std::int64_t const begin = begin_of(run, p);
        return this->part(begin, static_cast<int>(end_of(run, p) - begin), part, Forgotten{}, Factors{});
    }
    /// `kept`: put(i, OneSided) of each of its joints, for the way down; of the first body's, which is not passed, z12 and its biases.
    /// `factors`: as factorize(), if not always.
    template <class Kept, class Factors>
    CATENA_HD_IN_PLACE Segment part(std::int64_t begin, int count, Part const& part, Kept&& kept, Factors const& factors) const {
        Lost found;
        Segment segment{};
        each_body<unrolled<K>>(0, count, [&](int i) {
            Body const body = bodies.body(part, i);
            pass_up(segment, i, bodies.segment(body), {begin + i, body.restricted}, kept, found, factors);
        });
        if constexpr (Factors::may_fail)
            if (!found.none()) return this->part(begin, count, part, kept, dca::Factors{});
        s.note(found);
        return segment;
    }
    /// The same of `count` bodies whose segments `kept` has. `restricted(i)`: of their joints.
    template <class Restricted, class Kept, class Factors>
    CATENA_HD_IN_PLACE Segment join_bodies(std::int64_t begin, int count, Restricted const& restricted, Kept&& kept,
                                           Factors const& factors) const {
        static_assert(!Factors::may_fail);
        Lost found;
        Segment segment{};
        each_body<unrolled<K>>(
            0, count, [&](int i) { pass_up(segment, i, kept.template get<Segment>(i), {begin + i, restricted(i)}, kept, found, factors); });
        s.note(found);
        return segment;
    }
    template <bool unroll>
    CATENA_HD_IN_PLACE void down(Run const& run, int p, Part const& part, Directions const& first, Directions next) const {
        constexpr bool unrolled_here = unroll || unrolled<K>;
        std::int64_t const k = begin_of(run, p);
        int const count = static_cast<int>(end_of(run, p) - k);
        Elimination<double, K> passed[part_length] = {};
        Symmetric<double, K> z22{};
        Directions b2{};
        each_body<unrolled_here>(0, count, [&](int i) {
            Body const body = bodies.body(part, i);
            Segment const segment = bodies.segment(body);
            if (i > 0) {
                passed[i] = eliminate(z22, b2, segment.matrix, segment.bias, body.restricted);
            } else {
                z22 = segment.matrix.z22;
                b2 = segment.bias.b2 + transposed_times(segment.matrix.z12, first);
            }
        });
        each_body_back<unrolled_here>(0, count, [&](int i) {
            Directions const at_i = i > 0 ? passed[i].gain * next + passed[i].offset : first;
            bodies.accelerate(part, i, at_i, next, out);
            store_forces(s.leaf.group(), out, k + i, at_i, next);
            next = at_i;
        });
    }

    /// The same with what was kept on the way up: action(i, inboard force, outboard force), from the last body to the first.
    template <class Kept, class Action>
    CATENA_HD_IN_PLACE void forces(int count, Kept&& kept, Directions const& first, Directions next, Action const& action) const {
        Directions b2{};
        each_body<unrolled<K>>(0, count, [&](int i) {
            Passed const joint = kept.template get<Passed>(i);
            if (i > 0)
                kept.put(i, pass(b2, joint));
            else
                b2 = joint.bias.b2 + transposed_times(joint.outboard, first);
        });
        each_body_back<unrolled<K>>(0, count, [&](int i) {
            Directions at_i = first;
            if (i > 0) {
                Passage const passed = kept.template get<Passage>(i);
                at_i = passed.gain * next + passed.offset;
            }
            action(i, at_i, next);
            next = at_i;
        });
    }
    /// What the forces at its joints do to body k.
    CATENA_HD_IN_PLACE void accelerate(std::int64_t k, Body const& body, Directions const& inboard, Directions const& outboard) const {
        bodies.accelerate(body, inboard, outboard, out);
        store_forces(s.leaf.group(), out, k, inboard, outboard);
    }

  private:
    struct Forgotten {
        CATENA_HD static void put(int, Passed const&) {}
    };
    template <class Kept, class Factors>
    CATENA_HD_IN_PLACE void pass_up(Segment& segment, int i, Segment const& own, JointAt const& at, Kept&& kept, Lost& found,
                                    Factors const& factors) const {
        if (i == 0) {
            segment = own;
            return kept.put(i, Passed{{}, own.matrix.z12, own.bias});
        }
        Joint joint;
        Directions offset;
        this->append(segment, own, at, joint, offset, found, factors);
        kept.put(i, Passed{joint.factor, joint.outboard, own.bias});
    }
};

/// MatrixSweep and BiasSweep at once, with the same bits. What joins a part's bodies is found again on the way down, not kept: where bodies
/// are many, memory takes longer than that.
template <class Leaf>
struct ForgetfulSweeps : JoinsBoth<Leaf> {
    static constexpr bool goes_short = false;
    using Base = JoinsBoth<Leaf>;
    using Base::K, Base::s;
    using typename Base::Directions, typename Base::Segment, typename Base::Node;
    using Bodies = Resting<Leaf>;
    using Part = typename Bodies::Part;
    Bodies bodies;
    AccelerationsView out;

    /// What the way down keeps of a part's joints, but the first body's and the last one's.
    using Kept = HalfDisassembled<double, K>;
    static constexpr int kept_of_part = part_length - 2;

    CATENA_HD Part read(std::int64_t begin, std::int64_t end) const { return bodies.part(begin, end); }
    CATENA_HD Segment part(Run const& run, int p, Part const& part) const {
        return join_bodies(run, p, part, [](int, Node const&) {});
    }
    /// `kept`: put(i, Kept) and get(i), i < kept_of_part.
    template <bool /*unroll*/, class Memory>
    CATENA_HD void down(Run const& run, int p, Part const& part, Directions const& first, Directions next, Memory const& kept) const {
        std::int64_t const begin = begin_of(run, p);
        int const last = static_cast<int>(end_of(run, p) - begin) - 1;
        Directions at_last = first;
        join_bodies(run, p, part, [&](int i, Node const& node) {
            Kept const half = half_disassemble(node.joint, node.offset, first);
            if (i == last)
                at_last = disassemble(half, next);
            else
                kept.put(i - 1, half);
        });
        each_body_back<unrolled<K>>(0, last + 1, [&](int i) {
            Directions const at_i = i == last ? at_last : i == 0 ? first : disassemble(kept.get(i - 1), next);
            bodies.accelerate(part, i, at_i, next, out);
            store_forces(s.leaf.group(), out, begin + i, at_i, next);
            next = at_i;
        });
    }

  private:
    /// see(i, node) of all joints but the first body's.
    template <class See>
    CATENA_HD Segment join_bodies(Run const& run, int p, Part const& part, See const& see) const {
        std::int64_t const begin = begin_of(run, p);
        Segment segment = bodies.segment(bodies.body(part, 0));
        each_body<unrolled<K>>(1, static_cast<int>(end_of(run, p) - begin), [&](int i) {
            auto const own = bodies.body(part, i);
            Node node;
            segment = this->joined(segment, bodies.segment(own), {begin + i, own.restricted}, node);
            see(i, node);
        });
        return segment;
    }
};

/// MatrixSweep and BiasSweep at once.
template <class Leaf>
struct BothSweeps : JoinsBoth<Leaf> {
    static constexpr bool goes_short = false;
    using Base = JoinsBoth<Leaf>;
    using typename Base::Directions, typename Base::Segment;
    using Part = NothingRead;
    MatrixSweep<Leaf> matrices;
    BiasSweep<Leaf> biases;

    /// For runs that are apart from the stages above them (StagePlan).
    ForgetfulSweeps<Leaf> apart() const { return {{this->s}, {this->s.leaf, this->s.restricted, biases.loads}, biases.out}; }
    CATENA_HD Part read(std::int64_t /*begin*/, std::int64_t /*end*/) const { return {}; }
    CATENA_HD Segment part(Run const& run, int p, Part read) const {
        auto const matrix = matrices.part(run, p, read);  // whose joints the biases need
        return {matrix, biases.part(run, p, read)};
    }
    template <bool unroll>
    CATENA_HD void down(Run const& run, int p, Part read, Directions const& first, Directions const& next) const {
        biases.template down<unroll>(run, p, read, first, next);
    }
};

/// With the same bits for chains that one launch takes: joints within parts are kept as well, and bodies read one by one.
template <class Leaf>
struct ShortSweeps : BothSweeps<Leaf> {
    static constexpr bool goes_short = true, one_by_one = true;
    using Base = BothSweeps<Leaf>;
    using Base::s, Base::K;
    using typename Base::Directions, typename Base::Segment, typename Base::Node;
    using Bodies = Resting<Leaf>;
    using Part = typename Bodies::Part;
    using Body = typename Bodies::template Body<std::int64_t>;
    using Passed = Node;
    using Passage = Node;
    Bodies bodies;

    CATENA_HD Part read(std::int64_t begin, std::int64_t end) const { return bodies.part(begin, end); }
    CATENA_HD Segment part(Run const& run, int p, Part const&) const { return Base::part(run, p, {}); }
    template <bool unroll>
    CATENA_HD void down(Run const& run, int p, Part const&, Directions const& first, Directions const& next) const {
        Base::template down<unroll>(run, p, {}, first, next);
    }
    /// As Evaluation's, but that `kept` gets nodes: of all joints but the first body's.
    template <class Restricted, class Kept, class Factors>
    CATENA_HD_IN_PLACE Segment join_bodies(std::int64_t begin, int count, Restricted const& restricted, Kept&& kept,
                                           Factors const& factors) const {
        Segment segment{};
        each_body<unrolled<K>>(0, count, [&](int i) {
            Segment const own = kept.template get<Segment>(i);
            if (i == 0) {
                segment = own;
                return;
            }
            Node node;
            segment = this->joined(segment, own, {begin + i, restricted(i)}, node, factors);
            kept.put(i, node);
        });
        return segment;
    }
    template <class Kept, class Action>
    CATENA_HD_IN_PLACE void forces(int count, Kept&& kept, Directions const& first, Directions next, Action const& action) const {
        each_body_back<unrolled<K>>(0, count, [&](int i) {
            Directions const at_i = i > 0 ? this->force(kept.template get<Node>(i), first, next) : first;
            action(i, at_i, next);
            next = at_i;
        });
    }
    CATENA_HD_IN_PLACE void accelerate(std::int64_t k, Body const& body, Directions const& inboard, Directions const& outboard) const {
        bodies.accelerate(body, inboard, outboard, this->biases.out);
        store_forces(s.leaf.group(), this->biases.out, k, inboard, outboard);
    }
};

}  // namespace catena::dca
