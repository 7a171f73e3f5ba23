// Branched chains: which body each body hangs on.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.hpp"

namespace catena::scene {

/// Inboard bodies as in ChainSpec::parent; empty for an unbranched chain.
using Parents = std::span<std::int64_t const>;

/// Returns the body on which body k hangs, both counted from 0. Precondition: k > 0.
inline std::size_t inboard_of(Parents parents, std::size_t k) {
    return parents.empty() ? k - 1 : static_cast<std::size_t>(parents[k]);
}

/// Returns the inboard bodies in the form of ChainSpec::parent: empty if each body hangs on the one
/// before it.
std::vector<std::int64_t> as_parents(std::vector<std::int64_t> inboard);

/// Returns the beads that cross-links join, counted from 0 within the chain.
std::vector<std::array<std::int64_t, 2>> ends_of_crosslinks(ChainSpec const& chain);

/// Returns the longest way, in links, from the first body to another one; 0 for a single body.
std::int64_t height_of(ChainSpec const& chain);
/// Returns the number of bodies on which no other body hangs.
std::int64_t ends_of(ChainSpec const& chain);

}  // namespace catena::scene
