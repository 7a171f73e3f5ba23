// Construction of the levels of branched chains.
#include "tree/levels.hpp"

#include <algorithm>

namespace catena::dca {
namespace {

std::size_t at(std::int64_t k) { return static_cast<std::size_t>(k); }

/// Sorts the numbers 0, 1, ... by their keys: `first` gets the first entry of each key and the end,
/// the result the numbers. Negative keys are left out.
std::vector<std::int64_t> sorted_by(std::span<std::int64_t const> keys, std::int64_t count,
                                    std::vector<std::int64_t>& first) {
    first.assign(at(count) + 1, 0);
    for (std::int64_t const key : keys)
        if (key >= 0) ++first[at(key) + 1];
    for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
    std::vector<std::int64_t> next = first, sorted(at(first.back()));
    for (std::int64_t k = 0; k < std::ssize(keys); ++k)
        if (keys[at(k)] >= 0) sorted[at(next[at(keys[at(k)])]++)] = k;
    return sorted;
}

}  // namespace

Levels::Levels(std::span<std::int64_t const> inboard) {
    if (inboard.empty()) return;
    std::vector<std::int64_t> level;
    for (std::int64_t const before : inboard)
        level.push_back(before < 0 ? 0 : level[at(before)] + 1);
    body = sorted_by(level, *std::max_element(level.begin(), level.end()) + 1, first_of_level);
    child = sorted_by(inboard, std::ssize(inboard), first_child);
}

std::int64_t Levels::depth() const {
    std::int64_t depth = 0;
    for (std::int64_t level = 0; level < levels(); ++level) {
        std::size_t most = 0;
        for (std::int64_t i = first_of_level[at(level)]; i < first_of_level[at(level + 1)]; ++i)
            most = std::max(most, children(body[at(i)]).size());
        depth += 1 + static_cast<std::int64_t>(most);
    }
    return depth;
}

}  // namespace catena::dca
