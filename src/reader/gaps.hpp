// Check that consecutive residues of a PDB file can be neighbours in a chain.
#pragma once

#include "reader/chain_request.hpp"
#include "scene/pdb_sites.hpp"

namespace catena::scene {

/// Throws InputError, with both residues and their distance, for a distance that no link of the
/// model can have. Residues are missing there; with `links: as_given` it is a note. Decreasing
/// numbers without a visible peptide bond are refused, too. Numbers that skip between residues at a
/// link's distance get a note. If the scene names a System, a distance that fits its bond between
/// two neighbours is accepted, too.
void refuse_gaps(PdbSites const& from, ChainRequest const& request, Node const& at);

}  // namespace catena::scene
