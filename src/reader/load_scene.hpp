// Reads a scene file: the entrance of the reader.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace catena {

/// Reads and validates a scene file. `overrides`: "key.path=value" with list indices as in
/// "chains[0].count=10". Throws InputError with one line that names file, key, body index and
/// remedy.
Scene load_scene(std::string const& file, std::vector<std::string> const& overrides = {});

/// As load_scene, from text; `name` stands for the file in messages and its folder resolves
/// relative paths.
Scene parse_scene(std::string const& text, std::string const& name,
                  std::vector<std::string> const& overrides = {});

}  // namespace catena
