// A fingerprint of what decides the motion.
#pragma once

#include <span>
#include <string>

#include "scene/scene.hpp"

namespace catena::scene {

/// 32 hexadecimal digits, the same on every machine: of units, chains (names included), box, forces
/// (the content of system and topology files, not how and where they are computed) and dynamics but
/// `steps`. Two 64-bit lanes of multiply-and-rotate over the values' bits: tells scenes apart, no
/// protection against forgery. Throws InputError when a file that the scene names cannot be read
/// any more.
std::string fingerprint(Scene const& scene);

/// Fingerprints of what chains are and of how they start, 16 hexadecimal digits each.
struct ChainPrints {
    std::string kind;  // name, ends, bodies, links and joints
    std::string loads, positions, velocities;
};
ChainPrints prints_of(std::span<ChainSpec const> chains);
/// Of a file's content. Throws as fingerprint().
std::string content_print(std::string const& path);
std::string text_print(std::string const& text);

}  // namespace catena::scene
