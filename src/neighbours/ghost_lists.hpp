// The beads of other ranks that a rank's own ones feel, its ghosts: which they are, and what of
// them travels from rank to rank.
//
// The ghosts lie within reach + skin of an own bead when the lists are made, or in a piece with one
// that does, so that none is missed until some bead has moved half the skin. Where beads act on
// each other over several ranges a bead is looked for in those alone in which it acts: neutral ones
// are not ghosts as far out as charged ones. Then every rank makes its lists anew, all at the same
// evaluation. Each tells the others which cells of space its beads are in, shows another its pieces
// that are in or around that rank's cells, and is told which of them are ghosts there. From then on
// only those positions travel, between the ranks concerned.
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

/// Throws the SharedError about bead number `bead`; `trouble`: "the position of bead {:.0f} is not
/// finite".
[[noreturn]] void throw_trouble(double bead, char const* trouble);

class GhostLists {
  public:
    struct Plan {
        std::vector<std::int64_t> first_of_rank, by_rank;  // who owns what: BeadSystem's
        std::vector<std::int64_t> partners;  // beads that are ghosts wherever they are, ascending
        std::vector<PairRange> ranges;       // without any: no other ghosts
        double skin = 0;
        std::optional<Vec3> box;
        int threads = 0;                  // that search; 0: the rank's cores
        std::vector<std::uint8_t> piece;  // BeadPieces::length; partners are pieces by themselves
        std::vector<std::int64_t> number = {};  // of each bead in messages; empty: as they are
    };
    GhostLists(Communicator const&, Plan);

    /// What a rank says of its own beads.
    struct Moves {
        bool far = false;        // one has moved half the skin since the lists were made
        std::int64_t bead = -1;  // whose position is not finite; -1: none
    };
    /// Whether the lists are to be made anew, because beads of some rank have moved far or renew()
    /// was called. Collective. Throws SharedError where a bead is in trouble; `trouble`: "the
    /// position of bead {} is not finite".
    bool are_used_up(Moves const&, char const* trouble);
    /// Throws the SharedError of are_used_up() where a bead of some rank is in trouble. Collective.
    void refuse_trouble(std::int64_t bead, char const* trouble) const;
    /// Makes them anew. `own`: this rank's beads in the order of `by_rank`. Collective.
    void make(std::span<Vec3 const> own);
    /// They are used up. On every rank or none.
    void renew() { renew_ = true; }
    bool is_due() const { return renew_; }
    /// How far beads may move, nm; none matters where there are no ghosts but partners.
    std::optional<double> farthest() const {
        return plan_.ranges.empty() ? std::nullopt : std::optional(plan_.skin / 2);
    }

    /// Positions to and from a rank.
    struct Neighbour {
        int rank;
        std::size_t sent, received;
    };
    std::vector<Neighbour> const& neighbours() const { return neighbours_; }
    /// Of own beads, those whose positions are sent, rank after rank; a bead may be there more than
    /// once.
    std::vector<std::int64_t> const& sent() const { return sent_; }
    /// Of beads(), those whose positions are received, rank after rank: each once.
    std::vector<std::int64_t> const& received() const { return received_; }
    /// The positions' messages. Collective.
    void carry(std::span<Vec3 const> sent, std::span<Vec3> received);
    /// They went from GPU to GPU.
    void note_carried();
    /// Compares ghosts and their positions (of beads()) with a search among all beads. Collective;
    /// throws SharedError where one is missed or stale.
    void audit(std::span<Vec3 const> own, std::span<Vec3 const> ghosts) const;

    /// Number of this rank's bead k among all.
    std::int64_t own_bead(std::int64_t k) const {
        return plan_.by_rank.empty() ? first() + k : plan_.by_rank[first() + k];
    }
    /// A bead's in messages.
    std::int64_t number(std::int64_t bead) const {
        return plan_.number.empty() ? bead : plan_.number[static_cast<std::size_t>(bead)];
    }
    /// Partners, ascending, then the others, piece by piece.
    std::vector<std::int64_t> const& beads() const { return beads_; }
    /// The bead at which each piece begins, without partners.
    std::vector<std::int64_t> const& pieces() const { return pieces_; }
    /// Places for `count` particles that must not be felt by own beads before the lists are made
    /// anew. Precondition: not every bead of another rank is a ghost.
    Vec3 aside(std::int64_t i, std::int64_t count) const;
    GhostTraffic const& traffic() const { return traffic_; }

  private:
    /// To and from a rank: of own beads and of beads().
    struct Lists {
        std::vector<std::int64_t> send, receive;
    };
    using ListsOfRank = std::map<int, Lists>;
    /// Pieces, by the beads at which they begin, and their positions.
    struct Shown {
        void clear();
        void add(std::int64_t bead, std::span<Vec3 const> positions);
        std::vector<std::int64_t> piece, first{0};  // first: PointGroups'
        std::vector<Vec3> position;
    };
    /// Two ranks whose beads may be near each other's.
    struct Meeting {
        Shown mine, theirs;
        std::vector<char> asked,
            taken;  // of my pieces those that the other takes, of its ones those that I do
        std::int64_t shown = 0, expected = 0;
    };
    /// Those of positions shown whose beads act over a range.
    struct Acting {
        std::vector<Vec3> position;
        std::vector<std::int64_t> first;
    };
    std::int64_t first() const { return plan_.first_of_rank[communicator_.rank()]; }
    int owner(std::int64_t bead) const;
    std::int64_t piece(std::int64_t bead) const {
        return plan_.piece.empty() ? 1 : plan_.piece[static_cast<std::size_t>(bead)];
    }

    std::vector<Vec3> all_positions(std::span<Vec3 const> own) const;
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
    std::vector<std::int64_t> place_;           // of each bead in by_rank
    std::vector<std::int64_t> first_of_piece_;  // of own beads, then their number
    std::unique_ptr<Executor> executor_;        // of searches
    ListsOfRank partners_;                      // those of each rank, and own beads that are one's
    std::map<int, Meeting> meetings_;           // which keep their memory
    Acting here_, there_;
    std::vector<Neighbour> neighbours_;
    std::vector<std::int64_t> sent_, received_, beads_, pieces_;
    Vec3 aside_ = Vec3::zero(),
         edge_ = Vec3::zero();  // the first place aside where space has no end; of a cell
    std::vector<Vec3> free_;    // middles of cells aside, where it has
    bool has_partners_ = false, renew_ = true;
    GhostTraffic traffic_;
};

}  // namespace catena
