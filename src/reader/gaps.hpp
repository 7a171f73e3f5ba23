// Whether neighbours in a PDB file can be neighbours in a chain.
#pragma once

#include "reader/chain_request.hpp"
#include "scene/pdb_sites.hpp"

namespace catena::scene {

/// InputError, with both residues and their distance, where residues are missing between two that
/// no link of the model can join (with `links: as_given` a note), and where numbers fall between
/// two without a peptide bond that the file shows. Numbers that skip between residues at a link's
/// distance get a note. Where the scene names a System, its bond between two neighbours says how
/// far apart they may be.
void refuse_gaps(PdbSites const& from, ChainRequest const& request, Node const& at);

}  // namespace catena::scene
