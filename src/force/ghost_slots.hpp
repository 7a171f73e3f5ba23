// Particles of a Context for ghosts that come and go. One has its parameters for good, because to
// change them takes OpenMM long: a ghost takes those of its kind. A slot has particles for one
// piece of beads, which are named by the one at which they begin.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "force/bead_pieces.hpp"

namespace catena {

class GhostSlots {
  public:
    /// `pieces`: of all beads; must outlive it.
    explicit GhostSlots(BeadPieces const& pieces) : pieces_(pieces) {}

    /// Slots of these pieces' kinds, all free, after so many idle particles. What was there before
    /// is forgotten.
    void make(std::vector<std::int64_t> like, int idle_before);
    /// Gives each of `pieces` a slot; those that have one keep it. False, and nothing is changed,
    /// where there are too few of some kind.
    bool take(std::span<std::int64_t const> pieces);
    /// The same with slots of other kinds and the same length where there are too few; how kinds
    /// have changed is told by like(). False, and nothing is changed, where there are too few of
    /// some length.
    bool take_of_any_kind(std::span<std::int64_t const> pieces);

    /// Of a piece that has a slot, the first of its particles.
    int particle(std::int64_t piece) const {
        return offset_[static_cast<std::size_t>(slot_[static_cast<std::size_t>(piece)])];
    }
    std::int64_t particles() const { return offset_.empty() ? 0 : offset_.back(); }
    /// A bead of each particle's kind; of those before the slots whichever.
    std::vector<std::int64_t> like() const;
    /// Particles that follow one of the same slot.
    std::vector<int> after() const;
    /// Particles that no piece has, slot by slot, then those before the slots.
    std::vector<int> idle() const;

  private:
    std::int64_t slots() const { return static_cast<std::int64_t>(piece_.size()); }
    int kind(std::int64_t piece) const { return pieces_.kind[static_cast<std::size_t>(piece)]; }
    bool take(std::span<std::int64_t const> pieces, bool of_any_kind);
    bool give_others(std::span<std::int64_t const> pieces, std::vector<std::vector<int>>& free,
                     std::vector<int>& slot_of_piece);

    BeadPieces const& pieces_;
    int kinds_ = 0, idle_before_ = 0;
    std::vector<int> slot_, offset_;  // of each piece, -1: it has none; the first particle of each
                                      // slot, and one past the last
    std::vector<std::int64_t> piece_, like_;  // of each slot; -1: none
};

}  // namespace catena
