// Entries of the inverse of the links' matrix T (src/dca/README.md, "Link chains") next to its
// diagonal, computed from the roots to the leaves after a matrix sweep. They give the derivative of
// log det T: the derivative with respect to an entry of T is the corresponding entry of T^-1.
//
// A joint's force follows from those at its segment's ends, phi = in phi_first + out phi_next + w
// r, where w is the inverse of its pivot. T^-1 is computed from the ends inwards in the same way.
#pragma once

#include "dca/tree_sweeps.hpp"

namespace catena::dca {

/// Outward sweep that computes the entries of T^-1. Precondition: at most one restricted direction
/// per joint, no rings.
template <class Leaf>
struct InverseSweep {
    TreeSweeps<Leaf> s;
    RecordsView<double, Order::plain> own;  // Diagonal entry (T^-1)_jj, indexed by joint.
    // Off-diagonal entry (T^-1)_jk of the joints at a segment's two ends, indexed by slot.
    RecordsView<double, Order::plain> across;
    View<1> beside;  // Output, see InverseView.

    /// Starts a chain: entries of its first joint and of its tip's joint.
    void operator()(Root const& root) const {
        double const first = s.joints.load(root.first).factor(0, 0);
        Entries const tip = root.tip == TipTo::ground ? entries(root.next, first, 0, 0) : Entries{};
        own.store(root.first, first);
        across.store(root.slot, tip.inboard);
        if (root.tip == TipTo::ground) own.store(root.next, tip.own);
    }
    /// Computes the entries of a merge's joint and the off-diagonal entries of its two segments.
    void operator()(Merge const& m) const {
        Entries const e =
            entries(m.joint, own.load(m.first), across.load(m.slot), own.load(m.next));
        own.store(m.joint, e.own);
        across.store(m.inboard, e.inboard);
        across.store(m.outboard, e.outboard);
    }
    /// Computes a run from its last part to its first, and each part body by body.
    void operator()(Run const& run) const {
        Ends rest{own.load(run.body), across.load(run.slot), own.load(run.next)};
        for (int p = parts_of(run) - 1; p > 0; --p)
            bodies(begin_of(run, p), end_of(run, p), take_off(begin_of(run, p), rest));
        bodies(run.body, end_of(run, 0), rest);
    }

  private:
    /// Entries of T^-1 of the joint where two segments meet: with the first joint, with itself and
    /// with the next joint.
    struct Entries {
        double inboard = 0, own = 0, outboard = 0;
    };
    /// Returns the entries of a joint from those of its segment's ends: `first` and `next` are
    /// diagonal entries, `between` is the off-diagonal one.
    CATENA_HD Entries entries(std::int64_t joint, double first, double between, double next) const {
        typename TreeSweeps<Leaf>::Joint const j = s.joints.load(joint);
        double const w = j.factor(0, 0), in = w * j.inboard(0, 0), out = w * j.outboard(0, 0);
        double const inboard = fused(in, first, out * between),
                     outboard = fused(in, between, out * next);
        return {inboard, fused(in, inboard, fused(out, outboard, w)), outboard};
    }
    /// Entries of T^-1 at the two ends of a segment: diagonal, off-diagonal, diagonal.
    struct Ends {
        double first, between, next;
    };
    /// Splits `rest` at joint k: returns the ends of the segment outboard of it and leaves those of
    /// the inboard segment in `rest`.
    CATENA_HD Ends take_off(std::int64_t k, Ends& rest) const {
        Entries const e = entries(k, rest.first, rest.between, rest.next);
        Ends const beyond{e.own, e.outboard, rest.next};
        own.store(k, e.own);
        rest = {rest.first, e.inboard, e.own};
        return beyond;
    }
    /// Writes the entries of the bodies [begin, end), from the last to the first.
    CATENA_HD void bodies(std::int64_t begin, std::int64_t end, Ends rest) const {
        for (std::int64_t k = end - 1; k > begin; --k) beside.at(k, 0) = take_off(k, rest).between;
        beside.at(begin, 0) = rest.between;
    }
};

}  // namespace catena::dca
