// Positions of ghosts in the host's memory, brought by messages.
#pragma once

#include <span>
#include <vector>

#include "neighbours/ghost_lists.hpp"

namespace catena {

class GhostExchange {
  public:
    GhostExchange(Communicator const& communicator, GhostLists::Plan plan)
        : lists_(communicator, std::move(plan)) {}

    /// Brings the ghosts' positions. `own`: this rank's beads in the order of `by_rank`. Where some
    /// bead of any rank has moved half the skin since the lists were made, or renew() was called,
    /// they are made anew first. Collective. Throws SharedError where a position is not finite.
    void update(std::span<Vec3 const> own);
    void renew() { lists_.renew(); }
    bool is_due() const { return lists_.is_due(); }
    void audit(std::span<Vec3 const> own) const { lists_.audit(own, positions_); }

    std::vector<std::int64_t> const& beads() const { return lists_.beads(); }
    std::span<Vec3 const> positions() const { return positions_; }
    Vec3 aside(std::int64_t i, std::int64_t count) const { return lists_.aside(i, count); }
    GhostTraffic const& traffic() const { return lists_.traffic(); }

  private:
    GhostLists::Moves moves(std::span<Vec3 const> own) const;

    GhostLists lists_;
    std::vector<Vec3> positions_, out_, in_,
        listed_;  // of ghosts; in messages; of own beads when the lists were made
};

}  // namespace catena
