// Members of a chain: chains of a structure file that a rigid body joins to one chain of the scene.
// The members of all other chains from structure files are the chains themselves.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace catena {

/// Consecutive beads of a chain, or sites of a trajectory, that are consecutive residues of one
/// member. Residue k of the run has the number `number + step k` and the place `place + step k`.
struct ResidueRun {
    std::int64_t first = 0, count = 0;  // beads or sites [first, first + count)
    std::size_t member = 0;             // index in Members::identifiers
    /// Place of the first residue along its member, from 0. Residues are bonded if their places
    /// differ by 1; a gap of the structure leaves a place out.
    std::int64_t place = 0;
    std::int64_t number = 1;  // residue number of the first residue
    std::int64_t step = 1;    // 1, or -1 for residues that run towards the start of the member
    char insertion = ' ';     // insertion code of all residues of the run; blank for none
};

/// Names of residues as structure files have them. Both lists are empty if the residues have no
/// names of their own: sites are then numbered from 1 along each chain.
struct Members {
    /// Chain identifier of each member in its file; empty for a chain without one.
    std::vector<std::string> identifiers;
    /// Runs in the order of beads or sites.
    std::vector<ResidueRun> runs;

    bool empty() const { return runs.empty(); }
};

}  // namespace catena
