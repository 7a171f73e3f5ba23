// Computation of entries of the inverse of the links' matrix T over a group's tree, on the host.
#pragma once

#include <span>

#include "dca/inverse_sweep.hpp"

namespace catena::dca {

/// Entries of T^-1 of a group of link chains, computed from the roots to the leaves (InverseSweep).
template <class Leaf, class Space>
class LinksInverse {
    using Numbers = typename Space::template Records<double, Order::plain>;

  public:
    /// Allocates the arrays of the sweep.
    explicit LinksInverse(Schedule const& schedule)
        : own_(schedule.joints), across_(schedule.slots) {}

    /// Computes the entries from the matrices that were assembled last in the arrays of `sweeps`.
    void compute(Space const& space, ChainGroup const& group, TreeSweeps<Leaf> const& sweeps,
                 InverseView const& out) {
        Schedule const& schedule = group.schedule;
        InverseSweep<Leaf> const sweep{sweeps, own_.view(), across_.view(), out.beside};
        auto const each = [&](auto const& items) { space.over(std::span(items), sweep); };
        auto const each_level = [&](auto const& levels) {
            for (std::size_t l = levels.size(); l-- > 0;) each(levels[l]);
        };
        each(schedule.top_roots);
        each_level(schedule.top_levels);
        each(schedule.roots);
        each_level(schedule.levels);
        each(schedule.runs);
        // Returns the pivot of a joint; its inverse is 0 if nothing is restricted there.
        auto const pivot = [&](std::int64_t joint) {
            double const inverse = sweeps.joints.load(joint).factor(0, 0);
            return inverse != 0 ? 1 / inverse : 1.0;
        };
        space.for_each(group.size, [&](std::int64_t k) { out.pivot.at(k, 0) = pivot(k); });
        for (std::size_t i = 0; i < group.ends.tips.size(); ++i)
            out.tip_pivot.at(group.ends.tips[i].body, 0) =
                pivot(schedule.first_tip() + static_cast<std::int64_t>(i));
    }

  private:
    Numbers own_, across_;
};

}  // namespace catena::dca
