// Scenes of one random chain, for commands that need none from the user.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace catena::command {

/// `joint`: link (free base) | spherical | revolute (fixed base, gravity). `loads`, beside gravity:
/// none | torques of joints | wrenches, on every body and in ground axes, beside these. The same
/// chain for the same arguments everywhere.
Scene random_scene(std::string const& joint, std::int64_t bodies,
                   std::vector<std::string> const& overrides,
                   std::string const& loads = "wrenches");

/// Gives all bodies of a random chain the second one's mass, inertia and joints, where there is
/// one; how the chain stands on the ground, its coordinates and velocities stay. Precondition: not
/// of mixed joints.
void make_alike(Scene& scene);

/// Eight bodies that swing under gravity from a given start without losing energy. `joint`:
/// revolute | spherical | mixed | link.
Scene swinging_scene(std::string const& joint, std::vector<std::string> const& overrides);

/// Eight rods on spherical joints with stiff springs, clamped, straight and about to bend in their
/// slowest mode.
Scene elastic_scene(std::vector<std::string> const& overrides);

/// Rods wound up into a helix, hanging at rest.
Scene coil_scene(std::int64_t bodies, std::vector<std::string> const& overrides);

/// Copies of alpha-synuclein (140 beads) at 330 mg/ml, g-BAOAB at 10 fs with OpenMM's forces: the
/// chains that hold about so many beads; one has room around it.
Scene condensate_scene(std::int64_t beads, std::vector<std::string> const& overrides);
/// One such chain without a box.
Scene single_chain_scene(std::vector<std::string> const& overrides);
/// How many beads that scene has.
std::int64_t beads_of_condensate(std::int64_t beads);

}  // namespace catena::command
