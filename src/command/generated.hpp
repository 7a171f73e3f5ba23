// Scenes of one random chain, for commands that need none from the user.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace catena::command {

/// `joint`: link (free base) | spherical | revolute (fixed base, gravity). The same chain for the same arguments everywhere.
Scene random_scene(std::string const& joint, std::int64_t bodies, std::vector<std::string> const& overrides);

}  // namespace catena::command
