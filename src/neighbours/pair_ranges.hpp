// How far pairs of beads act on each other, where some act farther than others: what decides which
// beads are ghosts. No OpenMM here.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace catena {

/// Two beads that both act in it feel each other up to `reach`, nm.
struct PairRange {
    double reach = 0;
    std::vector<char> acts;  // of each bead; empty: every one

    bool is_for(std::int64_t bead) const {
        return acts.empty() || acts[static_cast<std::size_t>(bead)] != 0;
    }
};

inline double longest_reach(std::vector<PairRange> const& ranges) {
    double reach = 0;
    for (PairRange const& range : ranges) reach = std::max(reach, range.reach);
    return reach;
}

}  // namespace catena
