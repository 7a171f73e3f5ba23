// Check that consecutive residues of a structure can be neighbours in a chain.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "reader/chain_request.hpp"
#include "structure/pdb_sites.hpp"

namespace catena::scene {

/// Treatments of gaps: refused, the chain ends there, or missing residues are modelled.
enum class GapRule : std::uint8_t { refuse, split, model };

/// Returns the indices k of the sites of one chain for which residues are missing between sites k -
/// 1 and k: no link of the model can have that distance. Under GapRule::refuse such a distance
/// throws InputError with both residues; with `links: as_given` it is a note instead. Decreasing
/// numbers without a visible peptide bond, residues that are too close, and chains that are wrapped
/// into a cell are refused under every rule. Numbers that skip between residues at a link's
/// distance get a note. If the scene names a System, a distance that fits its bond between two
/// neighbours is accepted, too.
std::vector<std::size_t> find_gaps(PdbSites const& from, ChainRequest const& request,
                                   Node const& at, GapRule rule);

}  // namespace catena::scene
