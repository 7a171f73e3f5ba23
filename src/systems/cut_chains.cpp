// Implements the cut of chains at bonds that stay forces.
#include <fmt/format.h>

#include <algorithm>

#include "scene/node.hpp"
#include "scene/unique_names.hpp"
#include "systems/links.hpp"

namespace catena {

namespace {

/// The bonds at which chains are cut.
struct Cuts {
    std::int64_t bonds = 0;
    /// Kind and name of the first bond's force, and the name of its chain.
    std::string kind, name, chain;
    std::size_t longest = 0;  // piece, in beads
};

/// Appends the pieces of one chain that begins with particle `first`.
void append_pieces(PdbChain const& chain, int first, Joinings const& joinings, Cuts& cuts,
                   std::vector<PdbChain>& pieces) {
    for (std::size_t k = 0; k < chain.size(); ++k) {
        int const p = first + static_cast<int>(k);
        bool const cut = k > 0 && joinings.bond_stays_force(p);
        if (cut && cuts.bonds++ == 0) {
            cuts.kind = joinings.custom_bond(p);
            cuts.name = joinings.custom_name(p);
            cuts.chain = chain.name;
        }
        if (k == 0 || cut) pieces.emplace_back().name = chain.name;
        PdbChain& piece = pieces.back();
        piece.residue.push_back(chain.residue[k]);
        piece.position.push_back(chain.position[k]);
        cuts.longest = std::max(cuts.longest, piece.size());
    }
}

/// Sentence on the cuts.
std::string note_on(Cuts const& cuts, std::size_t chains, std::size_t pieces) {
    return fmt::format(
        "{} {} of a {} between neighbours {} (the first in chain {}), so {} of the topology {} "
        "simulated as {} of up to {} on links; to make such bonds rigid links, name their length: "
        "`links: {{{}: LENGTH}}` in forces.openmm (catena import --links {}=LENGTH).",
        cuts.bonds, cuts.bonds == 1 ? "bond" : "bonds", cuts.kind,
        cuts.bonds == 1 ? "stays a force" : "stay forces", scene::shown(cuts.chain),
        chains == 1 ? "1 chain" : fmt::format("{} chains", chains), chains == 1 ? "is" : "are",
        pieces == 1 ? "1 piece" : fmt::format("{} pieces", pieces),
        cuts.longest == 1 ? "1 bead" : fmt::format("{} beads", cuts.longest),
        scene::shown(cuts.name), scene::shown(cuts.name));
}

}  // namespace

std::vector<PdbChain> cut_at_bonds(std::vector<PdbChain> const& chains, Joinings const& joinings,
                                   std::vector<std::string>* notes) {
    std::vector<PdbChain> pieces;
    Cuts cuts;
    int first = 0;
    for (PdbChain const& chain : chains) {
        append_pieces(chain, first, joinings, cuts, pieces);
        first += static_cast<int>(chain.size());
    }
    if (cuts.bonds == 0) return chains;
    scene::UniqueNames names;
    for (PdbChain& piece : pieces) piece.name = names.make(piece.name);
    if (notes) notes->push_back(note_on(cuts, chains.size(), pieces.size()));
    return pieces;
}

}  // namespace catena
