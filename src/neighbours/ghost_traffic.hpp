// Statistics of ghosts and of their exchange.
#pragma once

#include <cstdint>

namespace catena {

/// Counters of one rank since the start.
struct GhostTraffic {
    /// Numbers of position updates and of rebuilds; of several layers, the largest.
    std::int64_t updates = 0, rebuilds = 0;
    /// Point-to-point messages and bytes sent, including those of rebuilds; collectives are not
    /// counted.
    std::int64_t messages = 0, bytes = 0;
    bool direct = false;          // true if positions are exchanged from GPU to GPU
    double seconds_of_lists = 0;  // time spent in rebuilds, s
    /// Current number of ghosts, and its maximum so far; of several layers, the sums.
    std::int64_t ghosts = 0, most_ghosts = 0;
};

}  // namespace catena
