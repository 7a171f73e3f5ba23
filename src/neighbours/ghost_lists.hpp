// Ghosts are the beads of other ranks that act on a rank's own beads. This file determines the
// ghosts of every rank and exchanges their positions.
//
// A ghost lies within reach + skin of an own bead when the lists are built, or belongs to a piece
// with such a bead. No ghost is missed until some bead has moved half the skin. If beads interact
// over several ranges, a bead is searched only within the ranges in which it acts; neutral ghosts
// thus lie closer than charged ones.
//
// All ranks rebuild their lists at the same evaluation. Each rank announces which cells of space
// contain its beads. It sends another rank its pieces in or around that rank's cells, and learns
// which of them are ghosts there. From then on only the ghosts' positions are exchanged, between
// the ranks concerned.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "math/executor.hpp"
#include "math/linear.hpp"
#include "mpi/communicator.hpp"
#include "neighbours/ghost_traffic.hpp"
#include "neighbours/grid.hpp"
#include "neighbours/pair_ranges.hpp"
#include "neighbours/point_blocks.hpp"

namespace catena {

/// Throws the SharedError about bead number `bead`. `trouble` is a format such as "the position of
/// bead {:.0f} is not finite".
[[noreturn]] void throw_trouble(double bead, char const* trouble);

/// Ghost lists of one rank.
class GhostLists {
  public:
    /// Owners of the beads, and parameters of the search.
    struct Plan {
        /// Ownership of beads, as in BeadSystem: first index of each rank, and beads ordered by
        /// rank.
        std::vector<std::int64_t> first_of_rank, by_rank;
        std::vector<std::int64_t> partners;  // beads that are ghosts at any distance, ascending
        std::vector<PairRange> ranges;       // empty: partners are the only ghosts
        /// Margin of the lists, nm, and edges of the periodic box, nm.
        double skin = 0;
        std::optional<Vec3> box;
        int threads = 0;  // threads of the search; 0: the rank's cores
        /// Length of the piece that begins at each bead (BeadPieces::length). Every partner is a
        /// piece by itself.
        std::vector<std::uint8_t> piece;
        /// Number of each bead in error messages; empty: its index.
        std::vector<std::int64_t> number = {};
    };
    /// Collective.
    GhostLists(Communicator const&, Plan);

    /// State of a rank's own beads.
    struct Moves {
        /// True if a bead has moved half the skin since the lists were built.
        bool far = false;
        std::int64_t bead = -1;  // number of a bead whose position is not finite; -1: none
    };
    /// True if the lists must be rebuilt, because beads of some rank have moved far or renew() was
    /// called. Collective. Throws SharedError if a bead's position is not finite; `trouble`: see
    /// throw_trouble().
    bool are_used_up(Moves const&, char const* trouble);
    /// Throws the SharedError of are_used_up() if `bead` >= 0 on some rank. Collective.
    void refuse_trouble(std::int64_t bead, char const* trouble) const;
    /// Rebuilds the lists. `own`: positions of this rank's beads in the order of `by_rank`, nm.
    /// Collective.
    void make(std::span<Vec3 const> own);
    /// Requests a rebuild. To be called on every rank or none.
    void renew() { renew_ = true; }
    /// True if renew() requested a rebuild.
    bool is_due() const { return renew_; }
    /// Limit of displacements, nm; none if partners are the only ghosts.
    std::optional<double> farthest() const {
        return plan_.ranges.empty() ? std::nullopt : std::optional(plan_.skin / 2);
    }

    /// Numbers of positions sent to and received from a rank.
    struct Neighbour {
        int rank;
        std::size_t sent, received;
    };
    std::vector<Neighbour> const& neighbours() const { return neighbours_; }
    /// Own beads whose positions are sent, rank by rank. A bead may occur several times.
    std::vector<std::int64_t> const& sent() const { return sent_; }
    /// Indices in beads() of the positions received, rank by rank; each occurs once.
    std::vector<std::int64_t> const& received() const { return received_; }
    /// Exchanges positions by messages, in the order of sent() and received(). Collective.
    void carry(std::span<Vec3 const> sent, std::span<Vec3> received);
    /// Records that an exchange of positions took place from GPU to GPU.
    void note_carried();
    /// Compares the ghosts and their positions (in the order of beads()) with a search among all
    /// beads. Collective. Throws SharedError if a ghost is missing or its position is stale.
    void audit(std::span<Vec3 const> own, std::span<Vec3 const> ghosts) const;

    /// Global index of this rank's bead k.
    std::int64_t own_bead(std::int64_t k) const {
        return plan_.by_rank.empty() ? first() + k : plan_.by_rank[first() + k];
    }
    /// Number of a bead in error messages.
    std::int64_t number(std::int64_t bead) const {
        return plan_.number.empty() ? bead : plan_.number[static_cast<std::size_t>(bead)];
    }
    /// The ghosts: partners in ascending order, then the others, piece by piece.
    std::vector<std::int64_t> const& beads() const { return beads_; }
    /// First bead of each piece; partners are left out.
    std::vector<std::int64_t> const& pieces() const { return pieces_; }
    /// Position i of `count` for idle particles that must not act on own beads before the next
    /// rebuild, nm. Precondition: at least one bead of another rank is no ghost.
    Vec3 aside(std::int64_t i, std::int64_t count) const;
    GhostTraffic const& traffic() const { return traffic_; }

  private:
    /// Own beads to send to a rank, and indices in beads() to receive from it.
    struct Lists {
        std::vector<std::int64_t> send, receive;
    };
    using ListsOfRank = std::map<int, Lists>;
    /// Pieces, identified by their first beads, and their positions.
    struct Shown {
        void clear();
        void add(std::int64_t bead, std::span<Vec3 const> positions);
        std::vector<std::int64_t> piece, first{0};  // first: offsets as in PointGroups
        std::vector<Vec3> position;
    };
    /// Exchange with a rank whose beads may be near own beads.
    struct Meeting {
        Shown mine, theirs;
        /// Flags of own pieces that are ghosts on the other rank, and of its pieces that are ghosts
        /// here.
        std::vector<char> asked, taken;
        /// Numbers of pieces sent and received.
        std::int64_t shown = 0, expected = 0;
    };
    /// Positions of those beads of pieces that act over one range.
    struct Acting {
        std::vector<Vec3> position;
        std::vector<std::int64_t> first;
    };
    /// Index of this rank's first bead in `by_rank` order.
    std::int64_t first() const { return plan_.first_of_rank[communicator_.rank()]; }
    /// Rank that owns a bead.
    int owner(std::int64_t bead) const;
    /// Length of the piece that begins at a bead.
    std::int64_t piece(std::int64_t bead) const {
        return plan_.piece.empty() ? 1 : plan_.piece[static_cast<std::size_t>(bead)];
    }

    /// Positions of all beads, gathered from all ranks. Collective.
    std::vector<Vec3> all_positions(std::span<Vec3 const> own) const;
    /// Exchanges the lists of partners. Collective.
    void share_partners();
    void add_near(std::span<Vec3 const> own, ListsOfRank& lists);
    bool find_place_aside(Grid const&, CellSet const& own);
    void meet(std::span<Vec3 const> own, std::vector<PointBlock> const& blocks, Grid const&,
              std::vector<Cell> const& cells);
    void show();
    std::vector<char> near_ones(Meeting const&, std::vector<PairRange> const& ranges);
    void find_acting(Shown const&, PairRange const&, std::vector<char> const& left_out,
                     Acting&) const;
    void find_place_among(Shown const& theirs, std::vector<char> const& near);
    template <class Out, class In>
    void swap(Out const& out, In const& in);
    void take(ListsOfRank const& lists);
    void exchange(std::vector<Outgoing> const& out, std::vector<Incoming> const& in);

    Communicator const& communicator_;
    Plan plan_;
    std::vector<std::int64_t> place_;  // index of each bead in by_rank
    std::vector<std::int64_t>
        first_of_piece_;  // first own bead of each piece, then the number of own beads
    std::unique_ptr<Executor> executor_;  // executor of searches
    ListsOfRank partners_;             // partners per rank, and own beads that are partners there
    std::map<int, Meeting> meetings_;  // kept between rebuilds for their memory
    Acting here_, there_;
    std::vector<Neighbour> neighbours_;
    std::vector<std::int64_t> sent_, received_, beads_, pieces_;
    /// First idle position if space is unbounded, and edges of a cell, nm.
    Vec3 aside_ = Vec3::zero(), edge_ = Vec3::zero();
    std::vector<Vec3> free_;  // midpoints of cells for idle particles, if space is periodic
    bool has_partners_ = false, renew_ = true;
    GhostTraffic traffic_;
};

}  // namespace catena
