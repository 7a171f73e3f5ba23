// Reader of chains of rigid bodies and point beads joined by links.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "reader/chain_request.hpp"

namespace catena::scene {

/// Linked bodies as read, with the changes made.
struct ExplicitLinked {
    /// The chain, whole across the sides of the box.
    LinkedArrays linked;
    /// True if at least one body has a velocity or omega.
    bool velocities = false;
    /// Number of links cut by the sides of the box; their bodies were moved by whole edges.
    std::int64_t cut_links = 0;
    std::int64_t first_cut = 0;  // body, from 1
    /// First body (from 1) whose link may or may not be cut; 0 if there is none.
    std::int64_t doubtful = 0;
    /// Length of that link as written.
    double doubtful_length = 0;
};
/// Reads bodies {mass, inertia, com, position, quaternion, velocity, omega, beads, joint: {type:
/// link, length, translation}}. A body without `inertia` is a bead. Lengths are given, or the
/// distances at the start. In a periodic box a body is moved by whole edges if its link is cut: to
/// the link's nearest image. A link counts as cut if that image fits a given length better. Without
/// a length it counts as cut if the image is half as long. It also counts if the image is shorter
/// and not much longer than the preceding links. Throws InputError.
ExplicitLinked read_linked(Node const& bodies, Base base, Vec3 const& anchor,
                           std::optional<Vec3> const& box);

}  // namespace catena::scene
