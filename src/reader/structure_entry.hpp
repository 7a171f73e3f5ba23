// Reader of the keys of a chain entry that names a structure: `pdb`, `chain`, `conformer`, `gaps`,
// `sites`, `rigid`.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bodies/domains.hpp"
#include "domains/rigid_entry.hpp"
#include "io/members.hpp"
#include "reader/chain_request.hpp"
#include "structure/pdb_sites.hpp"

namespace catena::scene {

/// A free end of a chain that is part of a complex.
struct ComplexEnd {
    std::size_t bead;
    /// True for an N-terminus.
    bool n;
};

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
    /// Names of the file's chains that a shared rigid body makes one chain; empty for one chain.
    std::vector<std::string> members = {};
    /// Chain identifiers and residue numbers of the beads.
    Members names = {};
    /// Termini of the members. Ends that were cut at a gap are not among them.
    std::vector<ComplexEnd> ends = {};
    /// Residues of the beads of a complex in words: "A 1-95, B 1-88".
    std::string order = {};
};

/// Reads the structure that `file` names into one part per chain. `chain` chooses; several chains
/// need it. `gaps: split` makes several parts of a chain, `gaps: model` grows what is missing. Adds
/// notes to the scene. Throws InputError for gaps without such a rule, for several chains without a
/// choice, and for keys that fit one chain only. Chains that share a rigid body become one part.
std::vector<StructurePart> read_structure(ChainRequest& request, Node const& file);

/// Returns the prediction that decides the rigid domains of the structure, with the domains that
/// were found; nullptr without `rigid: {pae: ...}`. Accepts domains that a chain cannot hold.
std::shared_ptr<Prediction const> read_prediction(ChainRequest& request, Node const& file);

}  // namespace catena::scene
