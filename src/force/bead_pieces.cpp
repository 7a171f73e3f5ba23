// Division of chains into pieces of consecutive beads.
#include "force/bead_pieces.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace catena {
namespace {

/// Returns 1 for each chain whose beads all lie on one rank, in consecutive order.
std::vector<char> are_together(BeadSystem const& beads) {
    auto const chains = beads.chain_offset.size() - 1;
    std::vector<char> together(chains, 0);
    auto const chain_of = [&](std::int64_t bead) {
        auto const& offset = beads.chain_offset;
        return static_cast<std::size_t>(std::upper_bound(offset.begin(), offset.end(), bead) -
                                        offset.begin()) -
               1;
    };
    auto const bead_at = [&](std::int64_t i) {
        return beads.by_rank.empty() ? i : beads.by_rank[static_cast<std::size_t>(i)];
    };
    for (std::size_t rank = 0; rank + 1 < beads.first_of_rank.size(); ++rank)
        for (std::int64_t i = beads.first_of_rank[rank], end = beads.first_of_rank[rank + 1],
                          next = i;
             i < end; i = next) {
            for (next = i + 1; next < end && bead_at(next) == bead_at(next - 1) + 1;) ++next;
            // Beads i .. next - 1 are a run of consecutive numbers, possibly of several chains.
            for (std::size_t c = chain_of(bead_at(i));
                 c < chains && beads.chain_offset[c + 1] <= bead_at(next - 1) + 1; ++c)
                together[c] = beads.chain_offset[c] >= bead_at(i) ? 1 : 0;
        }
    return together;
}

}  // namespace

BeadPieces single_beads(std::vector<int> kind_of_bead) { return {{}, std::move(kind_of_bead)}; }

BeadPieces pieces_of(BeadSystem const& beads, std::vector<int> const& kind_of_bead,
                     std::vector<char> const& joined) {
    int const kinds =
        kind_of_bead.empty() ? 0 : *std::max_element(kind_of_bead.begin(), kind_of_bead.end()) + 1;
    if (kinds <= BeadPieces::few_kinds) return single_beads(kind_of_bead);
    BeadPieces pieces{std::vector<std::uint8_t>(kind_of_bead.size(), 1), kind_of_bead};
    std::map<std::vector<int>, int> kind_of_piece;
    std::size_t count = 0;
    std::vector<char> const together = are_together(beads);
    for (std::size_t c = 0; c < together.size(); ++c) {
        auto const begin = beads.chain_offset[c], end = beads.chain_offset[c + 1];
        if (!together[c] ||
            std::find(joined.begin() + begin, joined.begin() + end, 1) != joined.begin() + end)
            continue;
        for (std::int64_t first = begin; first < end; first += BeadPieces::longest, ++count) {
            auto const length = std::min<std::int64_t>(BeadPieces::longest, end - first);
            std::fill_n(pieces.length.begin() + first, length, std::uint8_t{0});
            pieces.length[static_cast<std::size_t>(first)] = static_cast<std::uint8_t>(length);
            std::vector<int> const of_beads(kind_of_bead.begin() + first,
                                            kind_of_bead.begin() + first + length);
            int const next = kinds + static_cast<int>(kind_of_piece.size());
            pieces.kind[static_cast<std::size_t>(first)] =
                kind_of_piece.try_emplace(of_beads, next).first->second;
        }
    }
    return count < BeadPieces::least_alike * kind_of_piece.size() || count == 0
               ? single_beads(kind_of_bead)
               : pieces;
}

}  // namespace catena
