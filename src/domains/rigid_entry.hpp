// Reader of `rigid`: a list of ranges of residues, a domain file, or domains of a prediction.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "domains/assembly.hpp"
#include "domains/confident_domains.hpp"
#include "domains/residue_numbers.hpp"
#include "scene/node.hpp"

namespace catena::scene {

/// Residues and files that `rigid` may refer to.
struct RigidSource {
    ResidueNumbers numbers;
    /// Name of the entry, which chooses a protein of a domain file.
    std::string name;
    std::string scene_file;
    /// B factor of each residue; nothing for a residue without one. Empty without a structure.
    std::vector<std::optional<double>> b_factors = {};
    /// True for each residue that is missing in the file and was grown; empty without a structure.
    std::vector<bool> grown = {};
};

/// A predicted structure with the domains that were found in it.
struct Prediction {
    std::vector<double> plddt;
    PredictedError error;
    DomainThresholds thresholds;
    /// Domains as ranges of residues, ascending.
    std::vector<Segment> domains;
};

/// Rigid bodies of the chains of one entry.
struct RigidBodies {
    /// Bodies by their first residues.
    std::vector<RigidSet> sets;
    /// Sentences on what was decided.
    std::vector<std::string> notes;
    /// Only with `pae`.
    std::shared_ptr<Prediction const> prediction;
};

/// Reads `rigid`. An item of a list is [first, last], "CHAIN:FIRST-LAST", or a list of such ranges,
/// which may be of several chains. A map has `domains` or `pae`. Throws InputError for ranges
/// outside the chain, bodies with fewer than three residues and ranges that overlap.
RigidBodies read_rigid_bodies(Node const& rigid, RigidSource const& source);

}  // namespace catena::scene
