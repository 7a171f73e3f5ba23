// Chain identifiers and residue numbers of the beads that a structure file yields.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "io/members.hpp"
#include "structure/pdb_sites.hpp"

namespace catena::scene {

/// Collects the residues of a chain of the scene in the order of its beads.
class MemberNames {
  public:
    /// Announces a chain of the file, or a piece of one, with its number of residues. Pieces of one
    /// chain are announced in the chain's order; they belong to one member, and no bond joins them.
    /// Returns the index of the piece.
    std::size_t announce(PdbSiteChain const& chain, std::size_t residues);
    /// Appends the next bead: residue `residue` of a piece, from 0.
    void add(std::size_t piece, std::size_t residue, PdbSite const& site);
    /// Returns the members. Residues of a member whose numbers are missing or not unique are
    /// numbered from 1.
    Members take() const;

  private:
    /// One bead's residue.
    struct Residue {
        std::size_t member;
        std::int64_t place, number;
        char insertion;
        bool numbered;
    };
    /// True for each member whose residues have numbers that tell them apart.
    std::vector<bool> numbered_members() const;

    /// Name and label of each member's chain.
    std::vector<std::array<std::string, 2>> members_;
    /// Number of places of each member so far.
    std::vector<std::int64_t> places_;
    /// A chain of the file, or a piece of one. `place` is that of its first residue.
    struct Piece {
        std::size_t member;
        std::int64_t place;
    };
    std::vector<Piece> pieces_;
    std::vector<Residue> residues_;
};

/// Returns the names of a single chain.
Members members_of(PdbSites const& one_chain);

}  // namespace catena::scene
