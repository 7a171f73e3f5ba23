// Matrices, biases, forces and accelerations in one sweep, for where nothing is to be hidden and
// nothing repeated: leaves are computed again on the way down, but for what takes longer than to
// keep it.
#pragma once

#include <cstddef>

#include "dca/run_kinematics.hpp"
#include "dca/run_workspace.hpp"

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
    template <class Reader = ReadHere>
    CATENA_HD_IN_PLACE Body<std::int64_t> body(Part const& part, int i,
                                               Reader const& by = {}) const {
        return {leaf.body(loads, part.begin + i, by), restricted[part.begin + i]};
    }
    /// Of bodies that come by another way (cuda/sweeps/prefetch.cuh).
    template <class AnyPart>
        requires requires(AnyPart const& part) { part.body(0); }
    CATENA_HD_IN_PLACE Body<std::int64_t> body(AnyPart const& part, int i) const {
        return part.body(i);
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

    /// What its segment and its accelerations need, for one that keeps less.
    using Turning = typename Leaf::template Turning<std::int64_t>;
    template <class Factorizer>
    CATENA_HD Turning turning(Body<std::int64_t> const& body, Factorizer const& factors) const {
        return leaf.turning(loads, body, factors);
    }
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
    /// Of several bodies side by side, whose joints restrict what handles carry.
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

/// Matrices and biases at once; on the way down a part is eliminated again from the force at its
/// first joint, but for runs on revolute joints, which go by their inertias. `Bodies`: as Resting.
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
    static constexpr bool keeps_nodes =
        sizeof(Node) <= sizeof(Segment);  // a node takes a segment's place
    static constexpr bool takes_whole_runs = Leaf::by_inertia;
    static constexpr bool goes_short = !takes_whole_runs;
    /// Whether parts are walked in loops in any case: larger handles fill a processor's instruction
    /// cache.
    static constexpr bool in_loops = K > 3;
    Sweeps s;
    Bodies bodies;
    AccelerationsView out;

    /// One after the other, where both at once find no registers; the way down is this one.
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

    /// Runs on revolute joints go by their inertias.
    CATENA_HD bool takes(Run const& run) const {
        bool revolutes =
            run.count > 1 && !has_jointed_tip(s.leaf.group(), run.body + run.count - 1);
        if (run.count == longest_run) {  // asked for together
        CATENA_UNROLL
            for (int i = 1; i < longest_run; ++i) revolutes &= s.restricted[run.body + i] == K;
            return revolutes;
        }
        for (int i = 1; i < run.count; ++i) revolutes &= s.restricted[run.body + i] == K;
        return revolutes;
    }
    CATENA_HD_IN_PLACE Segment climb(Run const& run) const {
        RunWorkspace<Sweeps> kept(s, run, goes_by_all());
        int const count = static_cast<int>(run.count);
        Segment segment;
        if (follows()) {
            RunWithLoads<Leaf> const loaded = with_loads(run);
            segment = climb_revolutes<double>(
                count, FollowedBodies<Leaf, RunWorkspace<Sweeps>>(loaded, goes_by_all(), kept),
                [&](int i) { return loaded.torque_about(i); }, kept);
        } else {
            auto const body = [&](int i) { return s.leaf.revolute(bodies.loads, run.body + i); };
            segment = climb_revolutes<double>(count, BodiesOfRun<double, decltype(body)>(body), [](int) { return Undriven{}; }, kept);
        }
        s.note(kept.lost());
        return segment;
    }
    CATENA_HD_IN_PLACE void descend(Run const& run, Directions const& first, Directions const& next) const {
        RunWorkspace<Sweeps> const kept(s, run, goes_by_all());
        typename RunWithLoads<Leaf>::PassedOn passed{next};
        Directions& outboard = passed.force;
        descend_revolutes<double>(
            static_cast<int>(run.count), goes_by_all(), [&](int i) { return frame(run, kept, i); }, kept, first, next,
            [&](int i, RevoluteFrame<double> const& frame, BodyAcceleration<double> const& a) {
                std::int64_t const k = run.body + i;
                accelerate(run, i, frame, a);
                if (!out.joint_force) return;
                if (i == 0)
                    outboard = first;
                else if (follows())
                    with_loads(run).pass_on(i, frame, a, kept, passed);
                else
                    outboard = inboard_force(s.leaf.revolute(bodies.loads, k), a, outboard);
                write_directions<K>(out.joint_force, k, outboard);
            },
            [](int, BodyAcceleration<double>&) {}, [&](int i, double of_revolute) { turn(run, i, of_revolute); });
    }
    /// Whether what moves within runs is found on the way.
    CATENA_HD bool follows() const { return bodies.loads.revolutes.given; }
    CATENA_HD RunWithLoads<Leaf> with_loads(Run const& run) const { return {s.leaf, bodies.loads, run}; }
    CATENA_HD RevoluteFrame<double> frame(Run const& run, RunWorkspace<Sweeps> const& kept, int i) const {
        return follows() ? with_loads(run).frame(i, kept) : s.leaf.revolute_frame(bodies.loads, run.body + i);
    }
    /// Whether anything is wanted of each of a run's bodies.
    CATENA_HD bool goes_by_all() const { return out.by_all_bodies(); }
    /// What is wanted of body i of a run on revolute joints.
    CATENA_HD void accelerate(Run const& run, int i, RevoluteFrame<double> const& frame, BodyAcceleration<double> const& a) const {
        std::int64_t const k = run.body + i;
        if (out.revolute_acceleration.origin) {
            bool const begins = i == 0, ends = i == static_cast<int>(run.count) - 1;
            if (begins) out.revolute_acceleration.at(k, 0) = about_inboard_revolute(frame, a);
            if (ends) out.revolute_acceleration.at(k + 1, 1) = about_outboard_revolute(frame, a);
            if (!(begins && begins_chain(s.leaf.group(), k)) && !(ends && comes_before_one(s.leaf.group(), k))) return;
        }
        if (!out.acceleration.origin) return;
        write(out.alpha, k, a.alpha);
        write(out.acceleration, k, a.a);
    }
    /// And of its revolute joint.
    CATENA_HD void turn(Run const& run, int i, double of_revolute) const {
        if (out.revolute_acceleration.origin) out.revolute_acceleration.at(run.body + i, 0) = of_revolute;
    }

    template <class InverseLength = dca::InverseLength, class Reader = ReadHere>
    CATENA_HD_IN_PLACE Part read(std::int64_t begin, std::int64_t end, InverseLength const& inverse_length = {},
                                 Reader const& by = {}) const {
        return bodies.part(begin, end, inverse_length, by);
    }
    /// `factors`: as factorize(), if not always.
    template <class AnyPart, class Factorizer = dca::Factorizer>
    CATENA_HD_IN_PLACE Segment part(Run const& run, int p, AnyPart const& part, Factorizer const& factors = {}) const {
        std::int64_t const begin = begin_of(run, p);
        int const count = static_cast<int>(end_of(run, p) - begin);
        PivotFailure found;
        Segment segment = bodies.segment(bodies.body(part, 0), factors);
        each_body<unrolled<K>>(1, count, [&](int i) {
            Body const body = bodies.body(part, i);
            pass_up(segment, i, bodies.segment(body, factors), {begin + i, body.restricted}, Forgotten{}, found, factors);
        });
        if constexpr (Factorizer::may_fail)
            if (!found.none()) return this->part(run, p, part);
        s.note(found);
        return segment;
    }
    /// Of `count` bodies whose segments `kept` has: get<Segment>(i). It takes what the way down wants of their joints, put(i, OneSided): of
    /// the first body's, which is not passed, z12 and its biases. `restricted(i)`: of their joints, 0 from `count` on.
    template <class Restricted, class Kept>
    CATENA_HD_IN_PLACE Segment join_bodies(std::int64_t begin, int count, Restricted const& restricted, Kept&& kept) const {
        Segment segment = first_of(kept.template get<Segment>(0), kept);
        PivotFailure found;
        each_body<unrolled<K>>(1, count, [&](int i) {
            pass_up(segment, i, kept.template get<Segment>(i), {begin + i, restricted(i)}, kept, found, Factorizer{});
        });
        s.note(found);
        return segment;
    }
    /// The same without branches: missing bodies have zero() there and joints that are free. `factors` look after what is lost.
    template <class Restricted, class Kept, class Factorizer>
    CATENA_HD_IN_PLACE Segment join_bodies_at_once(int count, Restricted const& restricted, Kept&& kept, Factorizer const& factors) const {
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
    CATENA_HD Segment joined(Segment const& inboard, Segment const& outboard, JointAt const& at) const {
        Node node;
        Segment const segment = joined(inboard, outboard, at, node);
        keep(at.k, node);
        return segment;
    }
    template <class Factorizer = dca::Factorizer>
    CATENA_HD Segment joined(Segment const& inboard, Segment const& outboard, JointAt const& at, Node& node,
                             Factorizer const& factors = {}) const {
        PivotFailure found;
        Segment segment = inboard;
        append(segment, outboard, at, node.joint, node.offset, found, factors);
        if constexpr (Factorizer::may_fail)
            if (!found.none()) return joined(inboard, outboard, at, node);
        s.note(found);
        return segment;
    }
    /// The same by factors that look after what is lost. Beyond a free tip `outboard` may be zero() at a free joint: of the segment what
    /// counts there, its inboard handle, stays as it was, but that the bias may be another zero.
    template <class Factorizer>
    CATENA_HD Segment joined_at_once(Segment const& inboard, Segment const& outboard, int restricted, Node& node,
                                     Factorizer const& factors) const {
        PivotFailure found;
        Segment segment = inboard;
        append(segment, outboard, {0, restricted}, node.joint, node.offset, found, factors);
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
    CATENA_HD void store_row(std::int64_t slot, int i, SegmentRow<double, K> const& row) const {
        constexpr int at_z22 = Symmetric<double, K>::size, at_z12 = 2 * at_z22;
        using Matrices = SegmentMatrix<double, K>;
        static_assert(offsetof(Matrices, z22) == at_z22 * sizeof(double) && offsetof(Matrices, z12) == at_z12 * sizeof(double));
        int const begin = i * (i + 1) / 2;
        CATENA_UNROLL
        for (int j = 0; j < K; ++j) {
            if (j <= i) {
                s.matrices.number(slot, begin + j) = row.z11[j];
                s.matrices.number(slot, at_z22 + begin + j) = row.z22[j];
            }
            s.matrices.number(slot, at_z12 + i * K + j) = row.z12[j];
        }
        s.biases.number(slot, i) = row.b1;
        s.biases.number(slot, K + i) = row.b2;
    }
    CATENA_HD void close(Root const& root, Segment const& floating) const {
        Segment const held = root.tip == TipTo::ground ? joined(floating, Segment::zero(), s.at(root.next)) : floating;
        s.close(root, s.fasten(root, floating.matrix, held.matrix), held.bias);
    }
    /// The same of a chain whose tip is free. `factors`: as factorize(), always.
    template <class Factorizer>
    CATENA_HD void close_free(JointAt const& first, Segment const& floating, Factorizer const& factors) const {
        static_assert(!Factorizer::may_fail);
        Joint joint{};
        s.forces.store(first.k, first_force(first, floating, factors, joint.factor));
        s.joints.store(first.k, joint);
    }
    /// Of a whole chain whose tip is free, at its first joint: as close().
    template <class Factorizer = dca::Factorizer>
    CATENA_HD Directions first_force(JointAt const& at, Segment const& floating, Factorizer const& factors = {}) const {
        Symmetric<double, K> factor;
        return first_force(at, floating, factors, factor);
    }

    CATENA_HD Node node(std::int64_t joint) const { return s.node(joint); }
    CATENA_HD Directions force(Node const& node, Directions const& first, Directions const& next) const {
        return disassemble(node.joint, node.offset, first, next);
    }
    CATENA_HD static Directions force(Passage const& passed, Directions const& next) { return passed.gain * next + passed.offset; }
    template <bool unroll>
    CATENA_HD_IN_PLACE void down(Run const& run, int p, Part const& part, Directions const& first, Directions next) const {
        PassagesHere passages;
        down<unroll && !in_loops>(run, p, part, first, next, passages);
    }
    /// In registers.
    struct PassagesHere {
        static constexpr int most = part_length - (in_loops ? 2 : 1);
        Passage passage[part_length - 1] = {};  // some leave the last one unused, which compilers do not see
        CATENA_HD void put(int i, Passage const& passed) { passage[i] = passed; }
        CATENA_HD Passage const& get(int i) const { return passage[i]; }
    };
    /// `passages`: put(i, Passage) and get(i), i < `most`, of what a part's joints pass on, the last one's apart where there is no place
    /// for it; one that `keeps_turnings`: keep(i, Bodies::Turning) and turning(i), i < part_length, as well. `factors`: as factorize(),
    /// always.
    template <bool unroll, class Passages, class Factorizer = dca::Factorizer>
    CATENA_HD_IN_PLACE void down(Run const& run, int p, Part const& part, Directions const& first, Directions next, Passages&& passages,
                                 Factorizer const& factors = {}) const {
        static_assert(!Factorizer::may_fail);
        constexpr bool unrolled_here = unroll || unrolled<K>, last_apart = std::remove_reference_t<Passages>::most < part_length - 1;
        std::int64_t const k = begin_of(run, p);
        int const last = static_cast<int>(end_of(run, p) - k) - 1;
        Directions at_last = first;
        Segment const begins = segment_of(body_of<Passages>(part, 0), 0, passages, factors);
        Symmetric<double, K> z22 = begins.matrix.z22;
        Directions b2 = begins.bias.b2 + transposed_times(begins.matrix.z12, first);
        each_body<unrolled_here>(1, last + 1, [&](int i) {
            Body const body = body_of<Passages>(part, i);
            Segment const segment = segment_of(body, i, passages, factors);
            Passage const passed = eliminate(z22, b2, segment.matrix, segment.bias, body.restricted, factors);
            if (last_apart && i == last)
                at_last = force(passed, next);
            else
                passages.put(i - 1, passed);
        });
        each_body_back<unrolled_here>(0, last + 1, [&](int i) {
            Directions const at_i = i == 0 ? first : last_apart && i == last ? at_last : force(passages.get(i - 1), next);
            if constexpr (turnings_kept<Passages>)
                bodies.accelerate(bodies.body(part, i, ReadLast{}), passages.turning(i), at_i, next, out);
            else
                bodies.accelerate(part, i, at_i, next, out, factors);
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
            Directions const at_i = i > 0 ? force(kept.template get<Passage>(i), next) : first;
            action(i, at_i, next);
            next = at_i;
        });
    }
    /// The same where `kept` has gain(i) of every joint but the first and takes offset(i), put_offset(i).
    template <class Kept, class Action>
    CATENA_HD_IN_PLACE void forces_by_gains(int count, Kept&& kept, Directions const& first, Directions next, Action const& action) const {
        Passed const begins = kept.template get<Passed>(0);
        Directions b2 = begins.bias.b2 + transposed_times(begins.outboard, first);
        each_body<unrolled<K>>(1, count, [&](int i) { kept.put_offset(i, pass_bias(b2, kept.template get<Passed>(i))); });
        each_body_back<unrolled<K>>(0, count, [&](int i) {
            Directions const at_i = i > 0 ? force(Passage{kept.gain(i), kept.offset(i)}, next) : first;
            action(i, at_i, next);
            next = at_i;
        });
    }
    /// What the forces at its joints do to body k, with what its segment needed as well.
    template <class Turning>
    CATENA_HD_IN_PLACE void accelerate_turned(std::int64_t k, Body const& body, Turning const& turning, Directions const& inboard,
                                              Directions const& outboard) const {
        bodies.accelerate(body, turning, inboard, outboard, out);
        store_forces(s.leaf.group(), out, k, inboard, outboard);
    }
    /// What the forces at its joints do to body k.
    template <class Factorizer>
    CATENA_HD_IN_PLACE void accelerate(std::int64_t k, Body const& body, Directions const& inboard, Directions const& outboard,
                                       Factorizer const& factors) const {
        bodies.accelerate(body, inboard, outboard, out, factors);
        store_forces(s.leaf.group(), out, k, inboard, outboard);
    }

  private:
    template <class Factorizer>
    CATENA_HD Directions first_force(JointAt const& at, Segment const& floating, Factorizer const& factors,
                                     Symmetric<double, K>& factor) const {
        PivotFailure found;
        factor = factors(floating.matrix.z11, at.restricted);
        s.watch(at, factor, found);
        if constexpr (Factorizer::may_fail)
            if (!found.none()) return first_force(at, floating, dca::Factorizer{}, factor);
        s.note(found);
        return solve_upper(factor, solve_lower(factor, -floating.bias.b1));
    }
    template <class Passages>
    static constexpr bool turnings_kept = requires { requires std::remove_reference_t<Passages>::keeps_turnings; };
    template <class Passages>
    CATENA_HD_IN_PLACE Body body_of(Part const& part, int i) const {
        if constexpr (turnings_kept<Passages>)
            return bodies.body(part, i, ReadFirst{});
        else
            return bodies.body(part, i);
    }
    template <class Passages, class Factorizer>
    CATENA_HD_IN_PLACE Segment segment_of(Body const& body, [[maybe_unused]] int i, [[maybe_unused]] Passages& passages,
                                          Factorizer const& factors) const {
        if constexpr (turnings_kept<Passages>) {
            auto const turning = bodies.turning(body, factors);
            passages.keep(i, turning);
            return bodies.segment(body, turning);
        } else {
            return bodies.segment(body, factors);
        }
    }
    struct Forgotten {
        CATENA_HD static void put(int, Passed const&) {}
    };
    template <class Kept>
    CATENA_HD_IN_PLACE static Segment first_of(Segment const& own, Kept&& kept) {
        kept.put(0, Passed{{}, own.matrix.z12, own.bias});
        return own;
    }
    template <class Kept, class Factorizer>
    CATENA_HD_IN_PLACE void pass_up(Segment& segment, int i, Segment const& own, JointAt const& at, Kept&& kept, PivotFailure& found,
                                    Factorizer const& factors) const {
        Joint joint;
        Directions offset;
        append(segment, own, at, joint, offset, found, factors);
        kept.put(i, Passed{joint.factor, joint.outboard, own.bias});
    }
    template <class Factorizer>
    CATENA_HD void append(Segment& segment, Segment const& outboard, JointAt const& at, Joint& joint, Directions& offset, PivotFailure& found,
                          Factorizer const& factors) const {
        dca::append(segment.matrix, outboard.matrix, at.restricted, joint, factors);
        s.watch(at, joint.factor, found);
        dca::append(segment.bias, outboard.bias, joint, offset);
    }
};

}  // namespace catena::dca
