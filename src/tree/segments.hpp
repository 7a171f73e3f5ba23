// Segments of a schedule as a tree: which merges contain each of them.
#pragma once

#include <cstdint>
#include <vector>

#include "tree/tree.hpp"

namespace catena::dca {

/// Runs and merged segments of a schedule, by slot.
class Segments {
  public:
    /// A segment and the merges that contain it.
    struct Segment {
        std::int64_t joint = 0, next = 0;  // storage indices of the joints at its ends
        std::int64_t up = -1;              // slot of the segment that it is merged into; -1: none
        int met = -1;                      // level of that merge; -1: none
        std::int64_t whole = 0;            // first joint of the largest segment that contains it
        // Number of its leaves, and number of leaves of the largest segment that precede them.
        std::int64_t leaves = 1, along = 0;
    };
    /// `levels` must outlive the object.
    Segments(std::vector<Run> const& runs, std::vector<std::vector<Merge>> const& levels,
             std::int64_t slots);

    Segment const& of(std::int64_t slot) const { return all_[static_cast<std::size_t>(slot)]; }
    /// True if the segment is not merged below `end_level`.
    bool is_top(std::int64_t slot, int end_level) const {
        return of(slot).met < 0 || of(slot).met >= end_level;
    }
    /// Slot of the largest segment below `end_level` that contains the given one.
    std::int64_t ancestor(std::int64_t slot, int end_level) const;
    /// Sorts segments along the chains. Joint indices would not do: joints above the units of a
    /// shared chain are stored in another order.
    void sort(std::vector<std::int64_t>& slots) const;
    /// Returns the segments that merges of levels `first` to `end_level` - 1 need and do not
    /// produce themselves, along the chains.
    std::vector<std::int64_t> needed(int first, int end_level) const;

  private:
    Segment& at(std::int64_t slot) { return all_[static_cast<std::size_t>(slot)]; }
    /// Sets the joints at the ends of a segment.
    void know(std::int64_t slot, std::int64_t joint, std::int64_t next);

    std::vector<std::vector<Merge>> const& levels_;
    std::vector<Segment> all_;
};

}  // namespace catena::dca
