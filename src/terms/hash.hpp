// A fingerprint of all that decides the motion.
#pragma once

#include <span>
#include <string>

#include "scene/scene.hpp"

namespace catena::scene {

/// Returns 32 hexadecimal digits that are identical on every machine. Input: units, chains (names
/// included), box, forces and dynamics except `steps`. System and topology files enter by content;
/// how and where forces are computed does not enter. The hash has two 64-bit lanes of
/// multiply-and-rotate over the values' bits. It tells scenes apart but does not protect against
/// forgery. Throws InputError if a file named by the scene can no longer be read.
std::string fingerprint(Scene const& scene);

/// Fingerprints of the make-up of chains and of their start, 16 hexadecimal digits each.
struct ChainPrints {
    std::string kind;  // name, ends, bodies, links and joints
    std::string loads, positions, velocities;
};
ChainPrints prints_of(std::span<ChainSpec const> chains);

}  // namespace catena::scene
