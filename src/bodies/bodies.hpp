// Readers of chains written body by body: `bodies: [...]`.
#pragma once

#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// Content of the list. beads: point beads on links. linked: rigid bodies and beads on links.
/// bodies: rigid bodies on any other joints.
enum class BodyList { bodies, beads, linked };

/// Determines the content of the list. Throws InputError for an empty list, for a mixture of links
/// with other joints, and for a `parent` among rigid bodies on links.
BodyList kind_of_list(Node const& bodies);

/// Rigid bodies read from a list.
struct ExplicitBodies {
    /// Arrays of the chain; optional arrays that no body needs are empty.
    BodyArrays bodies;
    /// Bodies on which the bodies hang, as ChainSpec::parent.
    std::vector<std::int64_t> parent = {};
    /// First joint that is written `planar`, or nullptr. The caller checks that all axes of such a
    /// chain are parallel.
    Node const* planar = nullptr;
};
/// Reads rigid bodies on any joints but links and checks every number. Loads of bodies are read
/// afterwards (terms::read_bodies()). Throws InputError that names the body, also for a `parent`
/// that is not an earlier body.
ExplicitBodies read_bodies(Node const& bodies, Base base);

/// Point beads read from a list.
struct ExplicitBeads {
    /// The beads; `length` is NaN where none is given.
    BeadArrays beads;
    /// Beads on which the beads hang, as ChainSpec::parent.
    std::vector<std::int64_t> parent;
    /// True if at least one bead has a velocity.
    bool velocities = false;
};
/// Reads beads {mass, position, velocity, residue, parent, joint: {type: link, length}}. Throws
/// InputError for keys of rigid bodies, and for a `parent` that is not an earlier bead.
ExplicitBeads read_beads(Node const& bodies, Base base);

}  // namespace catena::scene
