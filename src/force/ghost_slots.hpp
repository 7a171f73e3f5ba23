// GhostSlots: particles of a Context that are assigned to changing ghosts.
//
// A particle keeps its parameters, because OpenMM takes long to change them. A ghost is therefore
// assigned to a particle of its kind. A slot holds the particles of one piece of beads. A piece is
// named by its first bead.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "force/bead_pieces.hpp"

namespace catena {

/// Assignment of ghost pieces to slots of equal kind.
class GhostSlots {
  public:
    /// `pieces`: division of all beads into pieces; must outlive this object.
    explicit GhostSlots(BeadPieces const& pieces) : pieces_(pieces) {}

    /// Makes free slots of the kinds of the pieces `like`, after `idle_before` idle particles.
    /// Earlier slots and assignments are dropped.
    void make(std::vector<std::int64_t> like, int idle_before);
    /// Assigns a slot of its kind to each of `pieces`; pieces that have a slot keep it. Returns
    /// false and changes nothing if slots of some kind run out.
    bool take(std::span<std::int64_t const> pieces);
    /// Assigns slots as take() does, and uses slots of other kinds and the same length if those of
    /// a kind run out. like() tells the new kinds. Returns false and changes nothing if slots of
    /// some length run out.
    bool take_of_any_kind(std::span<std::int64_t const> pieces);

    /// Returns the first particle of a piece that has a slot.
    int particle(std::int64_t piece) const {
        return offset_[static_cast<std::size_t>(slot_[static_cast<std::size_t>(piece)])];
    }
    /// Number of particles, idle ones before the slots included.
    std::int64_t particles() const { return offset_.empty() ? 0 : offset_.back(); }
    /// Returns for each particle a bead with its parameters; for idle particles before the slots,
    /// an arbitrary one.
    std::vector<std::int64_t> like() const;
    /// Returns the particles that are not the first of their slot.
    std::vector<int> after() const;
    /// Returns the particles without a piece, slot by slot, then those before the slots.
    std::vector<int> idle() const;

  private:
    std::int64_t slots() const { return static_cast<std::int64_t>(piece_.size()); }
    int kind(std::int64_t piece) const { return pieces_.kind[static_cast<std::size_t>(piece)]; }
    /// Implements take() and take_of_any_kind().
    bool take(std::span<std::int64_t const> pieces, bool of_any_kind);
    /// Assigns free slots of equal length to the pieces without one, and changes the slots' kinds.
    bool give_others(std::span<std::int64_t const> pieces, std::vector<std::vector<int>>& free,
                     std::vector<int>& slot_of_piece);

    BeadPieces const& pieces_;
    int kinds_ = 0, idle_before_ = 0;
    /// Slot of each piece (-1: none); first particle of each slot, then the number of particles.
    std::vector<int> slot_, offset_;
    /// Piece in each slot (-1: none); piece whose kinds the slot has.
    std::vector<std::int64_t> piece_, like_;
};

}  // namespace catena
