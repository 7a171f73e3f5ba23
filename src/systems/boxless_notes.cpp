// Implements notes on bonded forces that ignore the box. Needs no OpenMM.
#include <fmt/format.h>

#include <algorithm>

#include "systems/import.hpp"

namespace catena {

std::vector<std::string> notes_on_boxless(std::vector<BoxlessForce> const& forces,
                                          std::vector<std::int64_t> const& first) {
    auto const chain_of = [&](std::int64_t particle) {
        return std::upper_bound(first.begin(), first.end(), particle) - first.begin();
    };
    std::vector<std::string> notes;
    for (auto const& [name, spans] : forces)
        if (std::any_of(spans.begin(), spans.end(), [&](auto const& span) {
                return chain_of(span.first) != chain_of(span.second);
            }))
            notes.push_back(
                fmt::format("The System's {} joins chains and does not use the box: it acts on "
                            "coordinates as they are, not on nearest images.",
                            name));
    return notes;
}

}  // namespace catena
