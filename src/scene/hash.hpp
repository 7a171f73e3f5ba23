// A fingerprint of what decides the motion.
#pragma once

#include <string>

#include "scene/scene.hpp"

namespace catena::scene {

/// 32 hexadecimal digits, the same on every machine: of units, chains (names included), box, forces (the content of system and topology
/// files, not how and where they are computed) and dynamics but `steps`. Two 64-bit lanes of multiply-and-rotate over the values' bits:
/// tells scenes apart, no protection against forgery. Throws InputError when a file that the scene names cannot be read any more.
std::string fingerprint(Scene const& scene);

}  // namespace catena::scene
