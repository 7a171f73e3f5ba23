// Generated scenes of random chains, for commands that need no scene of the user.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace catena::command {

/// Returns a scene of one random chain. `joint` is link (free base), spherical or revolute (fixed
/// base), or another name of --joints; gravity acts. `loads` adds none, torques of joints, or
/// wrenches on every body in ground axes in addition to the torques. Equal arguments give equal
/// chains everywhere.
Scene random_scene(std::string const& joint, std::int64_t bodies,
                   std::vector<std::string> const& overrides,
                   std::string const& loads = "wrenches");

/// Gives all bodies of a random chain the mass, inertia and joints of the second body, if there is
/// one. The chain's base, coordinates and velocities stay. Precondition: the joints are not mixed.
void make_alike(Scene& scene);

/// Returns eight bodies that swing under gravity from a given start without losing energy. `joint`:
/// revolute | spherical | mixed | link.
Scene swinging_scene(std::string const& joint, std::vector<std::string> const& overrides);

/// Returns eight rods on spherical joints with stiff springs: clamped, straight, and about to bend
/// in their slowest mode.
Scene elastic_scene(std::vector<std::string> const& overrides);

/// Returns rods that are wound into a helix and hang at rest.
Scene coil_scene(std::int64_t bodies, std::vector<std::string> const& overrides);

/// Returns copies of alpha-synuclein (140 beads) at 330 mg/ml: the number of chains that hold about
/// this many beads. A single chain has room around it. Dynamics: g-BAOAB at 10 fs with OpenMM's
/// forces.
Scene condensate_scene(std::int64_t beads, std::vector<std::string> const& overrides);
/// Returns one such chain without a box.
Scene single_chain_scene(std::vector<std::string> const& overrides);
/// Returns the number of beads of that scene.
std::int64_t beads_of_condensate(std::int64_t beads);

}  // namespace catena::command
