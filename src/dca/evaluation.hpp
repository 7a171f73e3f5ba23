// Matrices, biases, forces and accelerations in one sweep, for where nothing is to be hidden and nothing repeated: leaves are computed
// again on the way down, because that is cheaper than to keep what became of them.
#pragma once

#include "dca/tree_sweeps.hpp"

namespace catena::dca {

/// Bodies read one by one with what a leaf takes from the configuration.
template <class Leaf>
struct Resting {
    struct Body {
        std::int64_t k;
    };
    Leaf leaf;
    LoadsView loads;

    CATENA_HD Body at(std::int64_t k) const { return {k}; }
    CATENA_HD Body after(Body const& body) const { return {body.k + 1}; }
    CATENA_HD BiasedSegment<Leaf::K> segment(Body const& body) const { return {leaf.matrix(body.k), leaf.bias(loads, body.k)}; }
    CATENA_HD void accelerate(Body const& body, Vector<double, Leaf::K> const& inboard, Vector<double, Leaf::K> const& outboard,
                              AccelerationsView const& out) const {
        leaf.accelerate(loads, body.k, inboard, outboard, out);
    }
};

/// On the way down a part is eliminated again from the force at its first joint. `Bodies`: as Resting.
template <class Leaf, class Bodies>
struct Evaluation {
    static constexpr bool descends = true;
    static constexpr int K = Leaf::K;
    using Sweeps = TreeSweeps<Leaf>;
    using Segment = BiasedSegment<K>;
    using Joint = typename Sweeps::Joint;
    using Directions = typename Sweeps::Directions;
    using Node = typename Sweeps::Node;
    using Body = typename Bodies::Body;
    Sweeps s;
    Bodies bodies;
    AccelerationsView out;

    CATENA_HD Segment part(Run const& run, int p) const {
        Lost found;
        Body body = bodies.at(begin_of(run, p));
        Segment segment = bodies.segment(body);
        each_body<K>(begin_of(run, p) + 1, end_of(run, p), [&](std::int64_t k) {
            body = bodies.after(body);
            Joint joint;
            Directions offset;
            segment = joined(segment, bodies.segment(body), k, joint, offset, found);
        });
        s.note(found);
        return segment;
    }
    CATENA_HD Segment joined(Segment const& inboard, Segment const& outboard, std::int64_t k) const {
        Lost found;
        Joint joint;
        Directions offset;
        Segment const segment = joined(inboard, outboard, k, joint, offset, found);
        s.note(found);
        s.joints.store(k, joint);
        s.offsets.store(k, offset);
        return segment;
    }
    CATENA_HD Segment load(std::int64_t slot) const { return {s.matrices.load(slot), s.biases.load(slot)}; }
    CATENA_HD void store(std::int64_t slot, Segment const& segment) const {
        s.matrices.store(slot, segment.matrix);
        s.biases.store(slot, segment.bias);
    }
    CATENA_HD void close(Root const& root) const {
        Segment const floating = load(root.slot);
        Segment const held = root.jointed_tip ? joined(floating, Segment::zero(), root.next) : floating;
        s.close(root, s.fasten(root, floating.matrix, held.matrix).factor, held.bias);
    }
    CATENA_HD Node node(std::int64_t joint) const { return s.node(joint); }
    CATENA_HD Directions force(Node const& node, Directions const& first, Directions const& next) const {
        return disassemble(node.joint, node.offset, first, next);
    }
    CATENA_HD void down(Run const& run, int p, Directions const& first, Directions next) const {
        std::int64_t const k = begin_of(run, p), end = end_of(run, p);
        Body body[part_length] = {bodies.at(k)};
        Elimination<double, K> passed[part_length] = {};
        Segment segment = bodies.segment(body[0]);
        Symmetric<double, K> z22 = segment.matrix.z22;
        Directions b2 = segment.bias.b2 + transposed_times(segment.matrix.z12, first);
        CATENA_UNROLL
        for (int i = 1; i < part_length; ++i)
            if (k + i < end) {
                body[i] = bodies.after(body[i - 1]);
                segment = bodies.segment(body[i]);
                passed[i] = eliminate(z22, b2, segment.matrix, segment.bias, s.restricted[k + i]);
            }
        CATENA_UNROLL
        for (int i = part_length - 1; i > 0; --i)
            if (k + i < end) {
                Directions const at_i = passed[i].gain * next + passed[i].offset;
                give(body[i], k + i, at_i, next);
                next = at_i;
            }
        give(body[0], k, first, next);
    }

  private:
    CATENA_HD Segment joined(Segment const& inboard, Segment const& outboard, std::int64_t k, Joint& joint, Directions& offset,
                             Lost& found) const {
        Segment segment;
        segment.matrix = assemble(inboard.matrix, outboard.matrix, s.restricted[k], joint);
        s.watch(k, joint.factor, found);
        segment.bias = assemble(inboard.bias, outboard.bias, joint, offset);
        return segment;
    }
    CATENA_HD void give(Body const& body, std::int64_t k, Directions const& inboard, Directions const& outboard) const {
        bodies.accelerate(body, inboard, outboard, out);
        store_forces(s.leaf.group(), out, k, inboard, outboard);
    }
};

}  // namespace catena::dca
