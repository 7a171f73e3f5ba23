// What a rank holds of other ranks' beads and has sent them of its own.
#pragma once

#include <cstdint>

namespace catena {

struct GhostTraffic {
    std::int64_t updates = 0, rebuilds = 0;  // of ghosts' positions, and of their lists; of several
                                             // layers the most of one
    std::int64_t messages = 0,
                 bytes = 0;  // sent from rank to rank, for the lists too; collectives not counted
    bool direct = false;     // positions go from GPU to GPU, not through the host
    double seconds_of_lists = 0;  // that making them took
    std::int64_t ghosts = 0,
                 most_ghosts = 0;  // now, and of all lists so far; of several layers the sums
};

}  // namespace catena
