// Implements the tree of segments of a schedule.
#include "tree/segments.hpp"

#include <algorithm>
#include <utility>

namespace catena::dca {

Segments::Segments(std::vector<Run> const& runs, std::vector<std::vector<Merge>> const& levels,
                   std::int64_t slots)
    : levels_(levels), all_(static_cast<std::size_t>(slots)) {
    for (Run const& run : runs) know(run.slot, run.body, run.next);
    for (std::size_t l = 0; l < levels.size(); ++l)
        for (Merge const& m : levels[l]) {
            know(m.slot, m.first, m.next);
            know(m.inboard, m.first, m.joint);
            know(m.outboard, m.joint, m.next);
            at(m.inboard).met = at(m.outboard).met = static_cast<int>(l);
            at(m.inboard).up = at(m.outboard).up = m.slot;
            at(m.slot).leaves = of(m.inboard).leaves + of(m.outboard).leaves;
        }
    for (Segment& segment : all_) segment.whole = segment.joint;
    for (std::size_t l = levels.size(); l-- > 0;)
        for (Merge const& m : levels[l]) {
            Segment const& joined = of(m.slot);
            at(m.inboard).whole = at(m.outboard).whole = joined.whole;
            at(m.inboard).along = joined.along;
            at(m.outboard).along = joined.along + of(m.inboard).leaves;
        }
}

void Segments::know(std::int64_t slot, std::int64_t joint, std::int64_t next) {
    at(slot).joint = joint, at(slot).next = next;
}

std::int64_t Segments::ancestor(std::int64_t slot, int end_level) const {
    while (!is_top(slot, end_level)) slot = of(slot).up;
    return slot;
}

void Segments::sort(std::vector<std::int64_t>& slots) const {
    std::sort(slots.begin(), slots.end(), [&](std::int64_t a, std::int64_t b) {
        return std::pair(of(a).whole, of(a).along) < std::pair(of(b).whole, of(b).along);
    });
}

std::vector<std::int64_t> Segments::needed(int first, int end_level) const {
    std::vector<std::uint8_t> made(all_.size(), 0);
    std::vector<std::int64_t> slots;
    for (int l = first; l < end_level; ++l)
        for (Merge const& m : levels_[static_cast<std::size_t>(l)]) {
            for (std::int64_t const slot : {m.inboard, m.outboard})
                if (!made[static_cast<std::size_t>(slot)]) slots.push_back(slot);
            made[static_cast<std::size_t>(m.slot)] = 1;
        }
    sort(slots);
    return slots;
}

}  // namespace catena::dca
