// Chains of rigid bodies and point beads joined by links.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "reader/chain_request.hpp"

namespace catena::scene {

struct ExplicitLinked {
    LinkedArrays linked;
    bool velocities = false;     // some body says its velocity or omega
    std::int64_t cut_links = 0;  // by the sides of the box: their bodies were moved by whole edges
    std::int64_t first_cut = 0;  // body, from 1
    std::int64_t doubtful = 0;   // the first body, from 1, whose link may be cut or not; 0: none
    double doubtful_length = 0;  // of that link as it stands
};
/// Bodies {mass, inertia, com, position, quaternion, velocity, omega, beads, joint: {type: link,
/// length, translation}} and, where there is no `inertia`, beads. Every length is given or the
/// distance at the start. In a periodic box bodies are moved by whole edges to where their link's
/// nearest image is, which fits a given length better, else is half as long, or shorter and not
/// much longer than the links before. Throws InputError.
ExplicitLinked read_linked(Node const& bodies, Base base, Vec3 const& anchor,
                           std::optional<Vec3> const& box);

}  // namespace catena::scene
