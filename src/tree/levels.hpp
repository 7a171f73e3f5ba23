// Bodies of branched chains level by level. A level has the bodies that are equally many joints
// away from the first bodies of their chains. Bodies of one level do not depend on each other, so
// that sweeps may visit them in any order and on any thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace catena::dca {

/// Levels of branched chains, and the bodies that hang on each body.
struct Levels {
    Levels() = default;
    /// `inboard` is the inboard body of each body, -1 for the first bodies of chains; it is smaller
    /// than the body's own number.
    explicit Levels(std::span<std::int64_t const> inboard);

    /// Bodies of all levels, level after level; ascending in each.
    std::vector<std::int64_t> body;
    /// First entry of each level in `body`; [levels + 1].
    std::vector<std::int64_t> first_of_level{0};
    /// Bodies that hang on body k, ascending: entries first_child[k] to first_child[k + 1] - 1 of
    /// `child`. `first_child` has one entry more than there are bodies; it is empty without bodies.
    std::vector<std::int64_t> first_child, child;

    std::int64_t levels() const { return std::ssize(first_of_level) - 1; }
    /// Longest way of steps from a body to the first one of its chain: each level is an elimination
    /// and a sum over the bodies on one body.
    std::int64_t depth() const;
    /// Bodies that hang on body k.
    std::span<std::int64_t const> children(std::int64_t k) const {
        auto const at = static_cast<std::size_t>(k);
        return std::span(child).subspan(
            static_cast<std::size_t>(first_child[at]),
            static_cast<std::size_t>(first_child[at + 1] - first_child[at]));
    }
};

/// Bodies of a level from which on threads share a loop over it. Fewer are not worth a barrier.
inline constexpr std::int64_t level_worth_threads = 256;

}  // namespace catena::dca
