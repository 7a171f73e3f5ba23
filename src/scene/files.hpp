// Files that a scene names, and tables of positions.
#pragma once

#include <string>
#include <vector>

#include "math/linear.hpp"
#include "scene/node.hpp"

namespace catena::scene {

/// Throws InputError for a file that is missing, a folder or unreadable; `at` names the key that
/// asked for it.
std::string read_text_file(std::string const& path, Node const& at);

/// `path` as the scene means it: relative to the folder of `scene_file`.
std::string resolved(std::string const& path, std::string const& scene_file);

/// Lines "x,y,z"; blank lines, lines from `#` on and one line of column names are passed over.
std::vector<Vec3> read_position_table(std::string const& path, Node const& at);

}  // namespace catena::scene
