// Branched chains: what they are, and what Catena cannot do with them yet.
#pragma once

#include <string>

#include "scene/scene.hpp"

namespace catena::scene {

/// True if some body of the chain hangs on another body than the one before it.
bool branches(ChainSpec const&);
/// True if some chain of the scene branches.
bool has_branches(Scene const&);
/// Throws InputError if a chain branches and has a kind of body or tip, or the scene has handles,
/// that branched chains do not support.
void refuse_unsupported_branches(Scene const&);

}  // namespace catena::scene
