// Reading of the files that a scene names, and of tables of positions.
#pragma once

#include <string>
#include <vector>

#include "math/linear.hpp"
#include "scene/node.hpp"

namespace catena::scene {

/// Throws InputError for a file that is missing, unreadable or a folder. `at` names the requesting
/// key in the message.
std::string read_text_file(std::string const& path, Node const& at);

/// True for well-formed YAML that is empty, a list or a single value.
bool holds_no_keys(std::string const& text);

/// Returns the ending of a file's name in lower case, with its dot; with `packed` that before
/// ".gz".
std::string ending_of(std::string const& path, bool packed = false);

/// Returns `path` relative to the folder of `scene_file`.
std::string resolved(std::string const& path, std::string const& scene_file);

/// Reads lines "x,y,z". Skips blank lines, text from `#` on, and one line of column names at the
/// top.
std::vector<Vec3> read_position_table(std::string const& path, Node const& at);

}  // namespace catena::scene
