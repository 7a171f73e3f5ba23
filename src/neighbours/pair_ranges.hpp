// Interaction ranges of pairs of beads, which determine the ghosts. Some beads act over longer
// ranges than others. This file does not depend on OpenMM.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace catena {

/// Range of a pair interaction: two beads that both take part interact up to the distance `reach`,
/// nm.
struct PairRange {
    double reach = 0;
    std::vector<char> acts;  // flag of each bead; empty: all beads take part

    /// True if the bead takes part in the interaction.
    bool is_for(std::int64_t bead) const {
        return acts.empty() || acts[static_cast<std::size_t>(bead)] != 0;
    }
};

/// Largest `reach`, nm; 0 without ranges.
inline double longest_reach(std::vector<PairRange> const& ranges) {
    double reach = 0;
    for (PairRange const& range : ranges) reach = std::max(reach, range.reach);
    return reach;
}

}  // namespace catena
