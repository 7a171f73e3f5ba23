// Command-line option --set key.path=value, which changes a key of the scene.
#pragma once

#include <string>

#include "scene/node.hpp"

namespace catena::scene {

/// Applies "key.path=value" to the tree. List indices are as in "chains[0].count=10"; missing map
/// keys are added. The value is YAML; `null` removes the key. Throws InputError for a malformed
/// path or value, an index beyond its list, and a path through a scalar.
void apply_override(Node& root, std::string const& override_text);

}  // namespace catena::scene
