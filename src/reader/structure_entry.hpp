// Reader of the keys of a chain entry that names a structure: `pdb`, `chain`, `conformer`, `gaps`,
// `sites`, `rigid`.
#pragma once

#include <string>
#include <vector>

#include "bodies/domains.hpp"
#include "reader/chain_request.hpp"
#include "structure/pdb_sites.hpp"

namespace catena::scene {

/// One chain that an entry's structure file yields.
struct StructurePart {
    /// Name of the chain; unique among the parts of an entry.
    std::string name;
    PdbSites from;
    /// Rigid domains, in beads of this part.
    std::vector<Domain> rigid = {};
    /// True if the chain was cut at a gap there: that end is no terminus.
    bool cut_front = false, cut_back = false;
    /// True for `sites: com`: links may change more than those of alpha carbons.
    bool mass_centres = false;
};

/// Reads the structure that `file` names into one part per chain. `chain` chooses; several chains
/// need it. `gaps: split` makes several parts of a chain, `gaps: model` grows what is missing. Adds
/// notes to the scene. Throws InputError for gaps without such a rule, for several chains without a
/// choice, and for keys that fit one chain only.
std::vector<StructurePart> read_structure(ChainRequest& request, Node const& file);

}  // namespace catena::scene
