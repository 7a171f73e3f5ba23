// Outward passes of the bodies of one part: by eliminating the part again, or from data that the
// inward pass kept. `Sweep` is a FusedSweep (fused_sweep.hpp). Host and device.
#pragma once

#include <type_traits>

#include "dca/tree_sweeps.hpp"

namespace catena::dca {

/// Storage of a part's passages in registers.
template <class Passage, bool in_loops>
struct PassagesInRegisters {
    /// Number of passages that have room; the last joint's passage is apart if parts are
    /// processed in rolled loops.
    static constexpr int most = part_length - (in_loops ? 2 : 1);
    // Some callers leave the last element unused, which compilers do not detect.
    Passage passage[part_length - 1] = {};
    CATENA_HD void put(int i, Passage const& passed) { passage[i] = passed; }
    CATENA_HD Passage const& get(int i) const { return passage[i]; }
};
/// True if `Passages` stores the intermediate results of each body.
template <class Passages>
constexpr bool turnings_kept =
    requires { requires std::remove_reference_t<Passages>::keeps_turnings; };
/// Returns body `i` of a part where the outward pass eliminates it.
template <class Passages, class Bodies>
CATENA_HD_IN_PLACE typename Bodies::template Body<std::int64_t> body_to_descend(
    Bodies const& bodies, typename Bodies::Part const& part, int i) {
    if constexpr (turnings_kept<Passages>)
        return bodies.body(part, i, ReadFirst{});
    else
        return bodies.body(part, i);
}
/// Returns the segment of body `i` and keeps its intermediate results if `passages` stores them.
template <class Bodies, class Body, class Passages, class Factorizer>
CATENA_HD_IN_PLACE auto segment_to_descend(Bodies const& bodies, Body const& body,
                                           [[maybe_unused]] int i,
                                           [[maybe_unused]] Passages& passages,
                                           Factorizer const& factors) {
    if constexpr (turnings_kept<Passages>) {
        auto const turning = bodies.turning(body, factors);
        passages.keep(i, turning);
        return bodies.segment(body, turning);
    } else {
        return bodies.segment(body, factors);
    }
}
/// Outward pass of part `p`, which eliminates it again. `first` is the force at its first joint,
/// `next` that at the joint after it. `factors` must not fail.
///
/// `passages` stores the recursion of the part's joints: put(i, Passage) and get(i), i <
/// `most`. The last joint's passage is kept apart if there is no room for it. If `passages` has
/// `keeps_turnings`, it also has keep(i, Bodies::Turning) and turning(i), i < part_length.
template <bool unroll, class Sweep, class Passages, class Factorizer = dca::Factorizer>
CATENA_HD_IN_PLACE void descend_part(Sweep const& sweep, Run const& run, int p,
                                     typename Sweep::Part const& part,
                                     typename Sweep::Directions const& first,
                                     typename Sweep::Directions next, Passages&& passages,
                                     Factorizer const& factors = {}) {
    static_assert(!Factorizer::may_fail);
    using Directions = typename Sweep::Directions;
    using Segment = typename Sweep::Segment;
    auto const& bodies = sweep.bodies;
    constexpr bool unrolled_here = unroll || unrolled<Sweep::K>,
                   last_apart = std::remove_reference_t<Passages>::most < part_length - 1;
    std::int64_t const k = begin_of(run, p);
    int const last = static_cast<int>(end_of(run, p) - k) - 1;
    Directions at_last = first;
    Segment const begins = segment_to_descend(bodies, body_to_descend<Passages>(bodies, part, 0), 0,
                                              passages, factors);
    Symmetric<double, Sweep::K> z22 = begins.matrix.z22;
    Directions b2 = begins.bias.b2 + transposed_times(begins.matrix.z12, first);
    each_body<unrolled_here>(1, last + 1, [&](int i) {
        auto const body = body_to_descend<Passages>(bodies, part, i);
        Segment const segment = segment_to_descend(bodies, body, i, passages, factors);
        typename Sweep::Passage const passed =
            eliminate(z22, b2, segment.matrix, segment.bias, body.restricted, factors);
        if (last_apart && i == last)
            at_last = Sweep::force(passed, next);
        else
            passages.put(i - 1, passed);
    });
    each_body_back<unrolled_here>(0, last + 1, [&](int i) {
        Directions const at_i = i == 0                    ? first
                                : last_apart && i == last ? at_last
                                                          : Sweep::force(passages.get(i - 1), next);
        if constexpr (turnings_kept<Passages>)
            bodies.accelerate(bodies.body(part, i, ReadLast{}), passages.turning(i), at_i, next,
                              sweep.out);
        else
            bodies.accelerate(part, i, at_i, next, sweep.out, factors);
        store_forces(sweep.s.leaf.group(), sweep.out, k + i, at_i, next);
        next = at_i;
    });
}

/// Outward pass from data that the inward pass kept: calls action(i, inboard force, outboard
/// force) from the last body to the first.
template <class Sweep, class Kept, class Action>
CATENA_HD_IN_PLACE void forces_within(int count, Kept&& kept,
                                      typename Sweep::Directions const& first,
                                      typename Sweep::Directions next, Action const& action) {
    using Directions = typename Sweep::Directions;
    Directions b2{};
    each_body<unrolled<Sweep::K>>(0, count, [&](int i) {
        typename Sweep::Passed const joint = kept.template get<typename Sweep::Passed>(i);
        if (i > 0)
            kept.put(i, pass(b2, joint));
        else
            b2 = joint.bias.b2 + transposed_times(joint.outboard, first);
    });
    each_body_back<unrolled<Sweep::K>>(0, count, [&](int i) {
        Directions const at_i =
            i > 0 ? Sweep::force(kept.template get<typename Sweep::Passage>(i), next) : first;
        action(i, at_i, next);
        next = at_i;
    });
}
/// Outward pass as forces_within(), where kept.gain(i) is known for every joint but the first.
/// put_offset(i) and offset(i) store the offsets.
template <class Sweep, class Kept, class Action>
CATENA_HD_IN_PLACE void forces_by_gains(int count, Kept&& kept,
                                        typename Sweep::Directions const& first,
                                        typename Sweep::Directions next, Action const& action) {
    using Directions = typename Sweep::Directions;
    typename Sweep::Passed const begins = kept.template get<typename Sweep::Passed>(0);
    Directions b2 = begins.bias.b2 + transposed_times(begins.outboard, first);
    each_body<unrolled<Sweep::K>>(1, count, [&](int i) {
        kept.put_offset(i, pass_bias(b2, kept.template get<typename Sweep::Passed>(i)));
    });
    each_body_back<unrolled<Sweep::K>>(0, count, [&](int i) {
        Directions const at_i =
            i > 0 ? Sweep::force(typename Sweep::Passage{kept.gain(i), kept.offset(i)}, next)
                  : first;
        action(i, at_i, next);
        next = at_i;
    });
}

}  // namespace catena::dca
