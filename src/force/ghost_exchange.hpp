// The beads of other ranks that a rank's own ones feel, its ghosts: which they are, and the messages that bring their positions.
//
// The ghosts lie within reach + skin of an own bead when the lists are made, so that none is missed until some bead has moved half the
// skin. Then every rank makes its lists anew, all at the same evaluation. Each tells the others which cells of space its beads are in,
// sends those of its beads that are in or around another's cells, and gets that rank's: from the two sets both find the same pairs, so
// that the sender knows what the receiver keeps. From then on only those positions travel, between the ranks concerned.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "dca/linear.hpp"
#include "force/ghost_traffic.hpp"
#include "force/grid.hpp"
#include "mpi/communicator.hpp"

namespace catena {

class GhostExchange {
  public:
    struct Plan {
        std::vector<std::int64_t> first_of_rank, by_rank;  // who owns what: BeadSystem's
        std::vector<std::int64_t> partners;                // beads that are ghosts wherever they are, ascending
        double reach = 0, skin = 0;                        // reach 0: no other ghosts
        std::optional<Vec3> box;
    };
    GhostExchange(Communicator const&, Plan);

    /// Brings the ghosts' positions. `own`: this rank's beads in the order of `by_rank`. Where some bead of any rank has moved half the
    /// skin since the lists were made, or renew() was called, they are made anew first. Collective. Throws SharedError where a position is
    /// not finite.
    void update(std::span<Vec3 const> own);
    /// The next update makes the lists anew. On every rank or none.
    void renew() { renew_ = true; }
    bool is_due() const { return renew_; }
    /// Compares ghosts and their positions with a search among all beads. Collective; throws SharedError where one is missed or stale.
    void audit(std::span<Vec3 const> own) const;

    /// Partners, then the others; each ascending.
    std::vector<std::int64_t> const& beads() const { return beads_; }
    std::span<Vec3 const> positions() const { return positions_; }
    /// Places for `count` particles that must not be felt by own beads before the lists are made anew. Precondition: not every bead of
    /// another rank is a ghost.
    Vec3 aside(std::int64_t i, std::int64_t count) const;
    GhostTraffic const& traffic() const { return traffic_; }

  private:
    struct Lists {
        std::vector<std::int64_t> send, receive;  // beads
    };
    using ListsOfRank = std::map<int, Lists>;
    struct Candidate {
        std::int64_t bead;
        Vec3 position;
    };
    struct Neighbour {
        int rank;
        std::vector<std::int64_t> send, receive;  // local index of own beads, index in beads_
        std::vector<Vec3> out, in;
    };

    std::int64_t first() const { return plan_.first_of_rank[communicator_.rank()]; }
    std::int64_t own_count() const { return plan_.first_of_rank[communicator_.rank() + 1] - first(); }
    std::int64_t own_bead(std::int64_t k) const { return plan_.by_rank.empty() ? first() + k : plan_.by_rank[first() + k]; }
    int owner(std::int64_t bead) const;

    std::vector<Vec3> all_positions(std::span<Vec3 const> own) const;
    void share_partners();
    bool must_rebuild(std::span<Vec3 const> own);
    void rebuild(std::span<Vec3 const> own);
    void add_near(std::span<Vec3 const> own, ListsOfRank& lists);
    std::vector<std::vector<Cell>> cells_of_ranks(CellMap const& own) const;
    std::map<int, std::vector<Candidate>> swap_candidates(std::map<int, std::vector<Candidate>> const& own);
    void find_place_aside(Grid const&, CellSet const& felt, std::optional<Vec3> const& near_by);
    void take(ListsOfRank lists);
    void bring(std::span<Vec3 const> own);
    void exchange(std::vector<Outgoing> const& out, std::vector<Incoming> const& in);

    Communicator const& communicator_;
    Plan plan_;
    std::vector<std::int64_t> place_;  // of each bead in by_rank
    ListsOfRank partners_;             // those of each rank, and own beads that are one's
    std::vector<Neighbour> neighbours_;
    std::vector<std::int64_t> beads_;
    std::vector<Vec3> positions_, listed_;  // of ghosts; of own beads when the lists were made
    Vec3 aside_ = Vec3::zero();
    double aside_length_ = 0;  // from one place to the next where space has no end, in all along x where it has
    bool has_partners_ = false, renew_ = true;
    GhostTraffic traffic_;
};

}  // namespace catena
