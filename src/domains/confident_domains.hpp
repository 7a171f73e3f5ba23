// Domains of a predicted structure: residues whose places relative to each other are known.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "domains/predicted_error.hpp"

namespace catena::scene {

/// Criteria of a domain. The defaults are those of AlphaFold's own scale of confidence.
struct DomainThresholds {
    /// Least pLDDT of a residue, 0 to 100.
    double plddt = 70;
    /// Largest mean error between two parts of a domain, angstrom.
    double pae = 5;
    /// Least number of residues of a segment.
    std::int64_t min_length = 20;
    /// Largest number of residues, of any confidence, between two segments that are joined.
    std::int64_t longest_loop = 10;
};

/// First and last residue of a segment, from 0, both included.
using Segment = std::array<std::size_t, 2>;

/// Domains, each a list of segments in ascending order, and segments that are too short.
struct ConfidentDomains {
    std::vector<std::vector<Segment>> domains;
    std::vector<Segment> short_segments;
};

/// Clusters the residues of at least the threshold's pLDDT by average linkage: the two clusters of
/// least mean error are joined as long as that is at most the threshold. A cluster's residues form
/// segments along the chain. Segments are joined across loops of at most `longest_loop` residues,
/// and are left out below `min_length`. Domains are in the order of their first residues.
ConfidentDomains confident_domains(std::vector<double> const& plddt, PredictedError const& error,
                                   DomainThresholds const& thresholds);

}  // namespace catena::scene
