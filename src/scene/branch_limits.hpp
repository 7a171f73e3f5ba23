// Branched and cross-linked chains: what they are, and what Catena cannot do with them yet.
#pragma once

#include <string>

#include "scene/scene.hpp"

namespace catena::scene {

/// True if some body of the chain hangs on another body than the one before it.
bool branches(ChainSpec const&);
/// True if the chain branches and consists of rigid bodies in joint coordinates.
bool is_body_tree(ChainSpec const&);
/// True if some chain of the scene branches.
bool has_branches(Scene const&);
/// True if the chain is solved path by path: it branches or has cross-links.
bool goes_by_paths(ChainSpec const&);
/// True if some chain of the scene is solved path by path.
bool has_paths(Scene const&);
/// Kind of the chain in messages: branched or cross-linked. Precondition:
/// goes_by_paths().
char const* kind_of_paths(ChainSpec const&);
/// Throws InputError if a chain is branched or cross-linked and has a kind of body or tip, or the
/// scene has handles, a backend or an integrator, that such chains do not support.
void refuse_unsupported_branches(Scene const&);

}  // namespace catena::scene
