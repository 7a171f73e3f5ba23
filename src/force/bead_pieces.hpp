// Pieces of chains: beads that are ghosts together.
//
// OpenMM sorts its particles in space by molecules, each among those alike, and computes on 32
// neighbours in its arrays at once. Single ghosts are molecules of as many kinds as beads have:
// neighbours of one kind are far apart where there are many. Pieces of chains lie together by
// themselves. They pay where beads are of many kinds and pieces of few, as in many chains alike.
#pragma once

#include <cstdint>
#include <vector>

#include "force/openmm_force.hpp"

namespace catena {

struct BeadPieces {
    static int constexpr longest = 32;  // beads
    /// Where beads are of no more kinds than this, or pieces of a kind are fewer on average, each
    /// bead is a piece: pieces bring up to half as many ghosts more, and blocks of single ones are
    /// a piece's width.
    static int constexpr few_kinds = 4, least_alike = 16;

    std::vector<std::uint8_t>
        length;  // of the piece that begins at a bead; 0: none does. Empty: each bead is one
    std::vector<int>
        kind;  // of the piece that begins at a bead: those of one kind have beads of the same kinds

    int of(std::int64_t bead) const {
        return length.empty() ? 1 : length[static_cast<std::size_t>(bead)];
    }
};

/// Of chains that lie on one rank, without beads that share a term with another rank's (`joined`,
/// of each bead); other beads are pieces by themselves. The same on every rank.
BeadPieces pieces_of(BeadSystem const& beads, std::vector<int> const& kind_of_bead,
                     std::vector<char> const& joined);

/// Each bead a piece.
BeadPieces single_beads(std::vector<int> kind_of_bead);

}  // namespace catena
