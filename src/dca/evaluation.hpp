// Matrices, biases, forces and accelerations in one sweep, for where nothing is to be hidden and nothing repeated: leaves are computed
// again on the way down, because that is cheaper than to keep what became of them.
#pragma once

#include <utility>

#include "dca/tree_sweeps.hpp"

namespace catena::dca {

/// Bodies read one by one with what a leaf takes from the configuration.
template <class Leaf>
struct Resting {
    template <class Place>
    struct Body : Leaf::template Body<Place> {
        int restricted;
    };
    Leaf leaf;
    std::uint8_t const* restricted = nullptr;
    LoadsView loads;

    /// Bodies from `begin` on.
    struct Part {
        Resting const& bodies;
        std::int64_t begin;
        CATENA_HD_IN_PLACE Body<std::int64_t> body(int i) const {
            return {bodies.leaf.body(bodies.loads, begin + i), bodies.restricted[begin + i]};
        }
    };
    CATENA_HD_IN_PLACE Part part(std::int64_t begin, std::int64_t /*end*/) const { return {*this, begin}; }
    /// What is needed to accelerate it.
    template <class Place>
    CATENA_HD static Place keep(Body<Place> const& body) {
        return body.k;
    }

    /// Of several bodies side by side, whose joints restrict what handles carry: as Part.
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
        return leaf.segment(loads, body);
    }
    template <class Place>
    CATENA_HD void accelerate(Place kept, Vector<RealAt<Place>, Leaf::K> const& inboard, Vector<RealAt<Place>, Leaf::K> const& outboard,
                              AccelerationsView const& out) const {
        leaf.accelerate(loads, kept, inboard, outboard, out);
    }
};

/// On the way down a part is eliminated again from the force at its first joint. `Bodies`: as Resting.
template <class Leaf, class Bodies>
struct Evaluation {
    static constexpr bool descends = true, keeps_nodes = true;
    static constexpr int K = Leaf::K;
    using Sweeps = TreeSweeps<Leaf>;
    using Segment = BiasedSegment<double, K>;
    using Joint = typename Sweeps::Joint;
    using Directions = typename Sweeps::Directions;
    using Node = typename Sweeps::Node;
    using Body = typename Bodies::template Body<std::int64_t>;
    using Kept = decltype(Bodies::keep(std::declval<Body const&>()));
    Sweeps s;
    Bodies bodies;
    AccelerationsView out;

    CATENA_HD Segment part(Run const& run, int p) const {
        Lost found;
        std::int64_t const begin = begin_of(run, p), end = end_of(run, p);
        auto part = bodies.part(begin, end);
        Segment segment = bodies.segment(part.body(0));
        each_body<K>(1, static_cast<int>(end - begin), [&](int i) {
            Body const body = part.body(i);
            Joint joint;
            Directions offset;
            append(segment, bodies.segment(body), begin + i, body.restricted, joint, offset, found);
        });
        s.note(found);
        return segment;
    }
    CATENA_HD Segment joined(Segment const& inboard, Segment const& outboard, std::int64_t k) const {
        Node node;
        Segment const segment = joined(inboard, outboard, k, node);
        keep(k, node);
        return segment;
    }
    CATENA_HD Segment joined(Segment const& inboard, Segment const& outboard, std::int64_t k, Node& node) const {
        Lost found;
        Segment segment = inboard;
        append(segment, outboard, k, s.restricted[k], node.joint, node.offset, found);
        s.note(found);
        return segment;
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
        Segment const held = root.tip == TipTo::ground ? joined(floating, Segment::zero(), root.next) : floating;
        s.close(root, s.fasten(root, floating.matrix, held.matrix), held.bias);
    }
    CATENA_HD Node node(std::int64_t joint) const { return s.node(joint); }
    CATENA_HD Directions force(Node const& node, Directions const& first, Directions const& next) const {
        return disassemble(node.joint, node.offset, first, next);
    }
    CATENA_HD_IN_PLACE typename Bodies::Part read(std::int64_t begin, std::int64_t end) const { return bodies.part(begin, end); }
    CATENA_HD_IN_PLACE void down(Run const& run, int p, typename Bodies::Part& part, Directions const& first, Directions next) const {
        std::int64_t const k = begin_of(run, p), end = end_of(run, p);
        Body body = part.body(0);
        Kept kept[part_length] = {bodies.keep(body)};
        Elimination<double, K> passed[part_length] = {};
        Segment segment = bodies.segment(body);
        Symmetric<double, K> z22 = segment.matrix.z22;
        Directions b2 = segment.bias.b2 + transposed_times(segment.matrix.z12, first);
        CATENA_UNROLL
        for (int i = 1; i < part_length; ++i)
            if (k + i < end) {
                body = part.body(i);
                kept[i] = bodies.keep(body);
                segment = bodies.segment(body);
                passed[i] = eliminate(z22, b2, segment.matrix, segment.bias, body.restricted);
            }
        CATENA_UNROLL
        for (int i = part_length - 1; i > 0; --i)
            if (k + i < end) {
                Directions const at_i = passed[i].gain * next + passed[i].offset;
                give(kept[i], k + i, at_i, next);
                next = at_i;
            }
        give(kept[0], k, first, next);
    }

  private:
    CATENA_HD void append(Segment& segment, Segment const& outboard, std::int64_t k, int restricted, Joint& joint, Directions& offset,
                          Lost& found) const {
        dca::append(segment.matrix, outboard.matrix, restricted, joint);
        s.watch(k, restricted, joint.factor, found);
        dca::append(segment.bias, outboard.bias, joint, offset);
    }
    CATENA_HD void give(Kept const& body, std::int64_t k, Directions const& inboard, Directions const& outboard) const {
        bodies.accelerate(body, inboard, outboard, out);
        store_forces(s.leaf.group(), out, k, inboard, outboard);
    }
};

/// MatrixSweep and BiasSweep at once.
template <class Leaf>
struct BothSweeps {
    static constexpr bool descends = true, keeps_nodes = false;
    static constexpr int K = Leaf::K;
    using Sweeps = TreeSweeps<Leaf>;
    using Segment = BiasedSegment<double, K>;
    using Directions = Vector<double, K>;
    using Node = typename TreeSweeps<Leaf>::Node;
    TreeSweeps<Leaf> s;
    MatrixSweep<Leaf> matrices;
    BiasSweep<Leaf> biases;

    CATENA_HD Segment part(Run const& run, int p) const {
        auto const matrix = matrices.part(run, p);  // whose joints the biases need
        return {matrix, biases.part(run, p)};
    }
    CATENA_HD Segment joined(Segment const& inboard, Segment const& outboard, std::int64_t k) const {
        auto const matrix = matrices.joined(inboard.matrix, outboard.matrix, k);
        return {matrix, biases.joined(inboard.bias, outboard.bias, k)};
    }
    CATENA_HD Segment load(std::int64_t slot) const { return {matrices.load(slot), biases.load(slot)}; }
    CATENA_HD void store(std::int64_t slot, Segment const& segment) const {
        matrices.store(slot, segment.matrix);
        biases.store(slot, segment.bias);
    }
    CATENA_HD void close(Root const& root, Segment const& floating) const {
        matrices.close(root, floating.matrix);
        biases.close(root, floating.bias);
    }
    CATENA_HD Node node(std::int64_t joint) const { return biases.node(joint); }
    CATENA_HD Directions force(Node const& node, Directions const& first, Directions const& next) const {
        return biases.force(node, first, next);
    }
    CATENA_HD auto read(std::int64_t begin, std::int64_t end) const { return biases.read(begin, end); }
    CATENA_HD void down(Run const& run, int p, typename BiasSweep<Leaf>::NothingYet bodies, Directions const& first,
                        Directions const& next) const {
        biases.down(run, p, bodies, first, next);
    }
};

}  // namespace catena::dca
