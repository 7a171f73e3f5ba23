// Entry point of the reader: reads a scene file.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace catena {

/// Reads and validates a scene file. `overrides` holds "key.path=value" with list indices as in
/// "chains[0].count=10". Throws InputError with one line that names file, key, body index and
/// remedy.
Scene load_scene(std::string const& file, std::vector<std::string> const& overrides = {});

/// Reads a scene from text like load_scene(). `name` is the file name in messages; its folder
/// resolves relative paths.
Scene parse_scene(std::string const& text, std::string const& name,
                  std::vector<std::string> const& overrides = {});

}  // namespace catena
