// Particles of a Context for ghosts that come and go. One has its parameters for good, because to change them takes OpenMM long: a ghost
// takes one of its kind.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace catena {

class GhostSlots {
  public:
    /// `kind_of_bead`: of every bead that may ever come; must outlive it.
    explicit GhostSlots(std::vector<int> const& kind_of_bead) : kind_of_bead_(kind_of_bead) {}

    /// Slots of these beads' kinds, all free. What was there before is forgotten.
    void make(std::vector<std::int64_t> like);
    /// Gives each of `beads` a slot; those that have one keep it. False, and nothing is changed, where there are too few of some kind.
    bool take(std::span<std::int64_t const> beads);
    /// The same with slots of other kinds where there are too few; how kinds have changed is told by like(). False, and nothing is
    /// changed, where there are too few in all.
    bool take_of_any_kind(std::span<std::int64_t const> beads);

    std::int64_t size() const { return static_cast<std::int64_t>(bead_.size()); }
    /// Of a bead that has one.
    int slot(std::int64_t bead) const { return slot_[static_cast<std::size_t>(bead)]; }
    /// A bead of the slot's kind.
    std::int64_t like(std::int64_t slot) const { return like_[static_cast<std::size_t>(slot)]; }
    /// Slots that no bead has, ascending.
    std::vector<int> idle() const;

  private:
    int kind(std::int64_t bead) const { return kind_of_bead_[static_cast<std::size_t>(bead)]; }
    bool take(std::span<std::int64_t const> beads, bool of_any_kind);

    std::vector<int> const& kind_of_bead_;
    int kinds_ = 0;
    std::vector<int> slot_;                  // of each bead; -1: it has none
    std::vector<std::int64_t> bead_, like_;  // of each slot; -1: none
};

}  // namespace catena
