// Pieces of chains: runs of consecutive beads that become ghosts together.
//
// OpenMM sorts its particles in space molecule by molecule, among molecules of the same kind only.
// It computes on 32 consecutive particles of its arrays at once. Single ghosts are molecules of as
// many kinds as there are kinds of beads. If there are many kinds, neighbours in the arrays are
// therefore far apart in space. The beads of a piece are close to each other by themselves. Pieces
// pay if there are many kinds of beads but few kinds of pieces, as with many identical chains.
#pragma once

#include <cstdint>
#include <vector>

#include "force/openmm_force.hpp"

namespace catena {

/// Division of all beads of a scene into pieces; both arrays are indexed by bead.
struct BeadPieces {
    static int constexpr longest = 32;  // longest piece, beads
    /// Pieces are single beads if there are at most `few_kinds` kinds of beads, or on average fewer
    /// than `least_alike` pieces of a kind. Longer pieces bring up to half as many ghosts more.
    /// Blocks of single beads are as wide as a piece.
    static int constexpr few_kinds = 4, least_alike = 16;

    /// Length of the piece that begins at a bead; 0 if none begins there. Empty if each bead is a
    /// piece.
    std::vector<std::uint8_t> length;
    /// Kind of the piece that begins at a bead. Pieces of one kind have beads of the same kinds, in
    /// the same order.
    std::vector<int> kind;

    /// Returns the length of the piece that begins at `bead`; 0 if none does.
    int of(std::int64_t bead) const {
        return length.empty() ? 1 : length[static_cast<std::size_t>(bead)];
    }
};

/// Divides the chains that lie on one rank into pieces. A chain is left as single beads if one of
/// its beads shares a bonded term with another rank's (`joined`: 1 per such bead). All other beads
/// are pieces by themselves. The result is the same on every rank.
BeadPieces pieces_of(BeadSystem const& beads, std::vector<int> const& kind_of_bead,
                     std::vector<char> const& joined);

/// Returns a division in which each bead is a piece.
BeadPieces single_beads(std::vector<int> kind_of_bead);

}  // namespace catena
