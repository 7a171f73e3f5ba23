// Division of pairs among ranks in a force decomposition, in which all ranks know every bead.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace catena {

/// Returns cuts of equal shares. Rank r computes the blocks from cuts[r] to cuts[r + 1], where 0
/// and 1 are the ends of the row of blocks.
inline std::vector<double> equal_cuts(int ranks) {
    std::vector<double> cuts;
    for (int r = 0; r <= ranks; ++r) cuts.push_back(static_cast<double>(r) / ranks);
    return cuts;
}

/// Returns cuts that give every rank equal work, if the measured `work` of each is spread evenly
/// over its present share. Without any work the cuts are unchanged. Every rank keeps at least an
/// eighth of an equal share: a rank without pairs could not measure that the others are now
/// overloaded with its former share.
inline std::vector<double> evened_cuts(std::vector<double> const& cuts,
                                       std::span<double const> work) {
    std::size_t const ranks = work.size();
    double total = 0;
    for (double const w : work) total += w;
    if (!(total > 0)) return cuts;
    double const least = 0.125 / static_cast<double>(ranks);
    std::vector<double> evened{0};
    std::size_t r = 0;
    double before = 0;  // work of the ranks before r
    for (std::size_t next = 1; next < ranks; ++next) {
        double const wanted = total * static_cast<double>(next) / static_cast<double>(ranks);
        while (r + 1 < ranks && before + work[r] < wanted) before += work[r++];
        double const part = work[r] > 0 ? std::min(1.0, (wanted - before) / work[r]) : 1.0;
        double const most = 1 - least * static_cast<double>(ranks - next),
                     even = cuts[r] + part * (cuts[r + 1] - cuts[r]);
        evened.push_back(std::min(most, std::max(evened.back() + least, even)));
    }
    evened.push_back(1);
    return evened;
}

}  // namespace catena
