// Ghosts whose positions are exchanged by messages and kept in host memory.
#pragma once

#include <span>
#include <vector>

#include "neighbours/ghost_lists.hpp"

namespace catena {

/// Ghosts of one rank and their positions in host memory.
class GhostExchange {
  public:
    GhostExchange(Communicator const& communicator, GhostLists::Plan plan)
        : lists_(communicator, std::move(plan)) {}

    /// Updates the ghosts' positions. `own`: positions of this rank's beads in the order of
    /// `by_rank`, nm. The lists are rebuilt first if a bead of any rank has moved half the skin, or
    /// if renew() was called. Collective. Throws SharedError if a position is not finite.
    void update(std::span<Vec3 const> own);
    void renew() { lists_.renew(); }
    bool is_due() const { return lists_.is_due(); }
    /// Checks the ghosts against a search among all beads (GhostLists::audit()). Collective.
    void audit(std::span<Vec3 const> own) const { lists_.audit(own, positions_); }

    /// Ghosts in the order of positions().
    std::vector<std::int64_t> const& beads() const { return lists_.beads(); }
    std::span<Vec3 const> positions() const { return positions_; }
    Vec3 aside(std::int64_t i, std::int64_t count) const { return lists_.aside(i, count); }
    GhostTraffic const& traffic() const { return lists_.traffic(); }

  private:
    /// State of the own beads since the lists were built.
    GhostLists::Moves moves(std::span<Vec3 const> own) const;

    GhostLists lists_;
    /// Positions of ghosts (`positions_`), in messages (`out_`, `in_`), and of own beads when the
    /// lists were built (`listed_`), nm.
    std::vector<Vec3> positions_, out_, in_, listed_;
};

}  // namespace catena
