// Chains written body by body: `bodies: [...]`.
#pragma once

#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// Whether the list describes point beads on links (its joints are of type link). InputError for an empty list and for a mixture with other
/// joints.
bool describes_beads(Node const& bodies);

/// Rigid bodies on free, spherical and revolute joints; every number checked. InputError names the body.
BodyArrays read_bodies(Node const& bodies, Base base);

struct ExplicitBeads {
    BeadArrays beads;         // `length`: NaN where none is given
    bool velocities = false;  // some bead says its velocity
};
/// Beads {mass, position, velocity, residue, joint: {type: link, length}}.
ExplicitBeads read_beads(Node const& bodies, Base base);

}  // namespace catena::scene
