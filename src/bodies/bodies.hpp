// Chains written body by body: `bodies: [...]`.
#pragma once

#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// What the list describes. beads: points on links. linked: links between rigid bodies and beads.
/// bodies: any other joints.
enum class BodyList { bodies, beads, linked };

/// InputError for an empty list and for a mixture of links with other joints.
BodyList kind_of_list(Node const& bodies);

struct ExplicitBodies {
    BodyArrays bodies;
    Node const* planar = nullptr;  // the first joint that is written `planar`
};
/// Rigid bodies on any joints but links; every number checked. `scene_drag`: {linear, angular} of
/// bodies that have none of their own. InputError names the body.
ExplicitBodies read_bodies(Node const& bodies, Base base, std::array<double, 2> const& scene_drag);

struct ExplicitBeads {
    BeadArrays beads;         // `length`: NaN where none is given
    bool velocities = false;  // some bead says its velocity
};
/// Beads {mass, position, velocity, residue, joint: {type: link, length}}.
ExplicitBeads read_beads(Node const& bodies, Base base);

/// `drag: {linear, angular}`.
std::array<double, 2> read_drag(Node const& drag);

}  // namespace catena::scene
