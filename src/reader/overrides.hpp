// --set key.path=value: a scene key changed from the command line.
#pragma once

#include <string>

#include "scene/node.hpp"

namespace catena::scene {

/// Applies "key.path=value" to the tree: list indices as in "chains[0].count=10", missing map keys
/// are made, the value is YAML, `null` removes the key. Throws InputError for a malformed path or
/// value, an index beyond its list, and a path that leads through a plain value.
void apply_override(Node& root, std::string const& override_text);

}  // namespace catena::scene
