// Chains made from a few numbers. All are O(n), functions of their arguments alone, and body k does not depend on n.
#pragma once

#include <cstdint>

#include "scene/scene.hpp"

namespace catena::scene {

/// Random rigid bodies of about unit size, mass and speed. Masses log-uniform in [0.5, 2]; inertias m R diag(s2+s3, s3+s1, s1+s2) R^T with
/// second moments s_i uniform in [0.05, 0.15] and R uniform, so that the triangle inequality holds with room; centres of mass in [-0.5,
/// 0.5]^3; joint frames at a distance in [0.5, 1.5] in a uniform direction, uniformly rotated; angles and orientations uniform; rates and
/// joint torques in [-1, 1]; every fourth body (at random) carries a wrench with components in [-1, 1]. `joint`: revolute or spherical; a
/// free base gets a random pose and velocity.
BodyArrays random_bodies(std::int64_t n, JointType joint, Base base, std::uint64_t seed);

/// Random beads on links: masses log-uniform in [0.5, 2], lengths in [0.5, 1.5], uniform directions; velocities satisfy the links: each
/// link turns with components of its angular velocity in [-1, 1] (bead 1 of a free base moves at up to 1).
BeadArrays random_beads(std::int64_t n, Base base, Vec3 const& anchor, std::uint64_t seed);

/// The chapter's test case (Fig. 2.4): equal uniform rods, all along +x, at rest, joints revolute about +z, joint 1 at the ground's origin.
/// Each is a solid cylinder: inertia m r^2 / 2 along, m (3 r^2 + l^2) / 12 across.
BodyArrays pendulum(std::int64_t links, double mass, double length, double radius);

/// Equal beads on equal links in independent uniform directions, at rest.
BeadArrays freely_jointed(std::int64_t beads, double length, double mass, Base base, Vec3 const& anchor, std::uint64_t seed);

/// Beads of equal mass and link length at `points` (of a fixed base: one more point, the anchor, first), which are moved so that the first
/// lies at `anchor`. Residues are UNK.
BeadArrays beads_at(std::vector<Vec3> const& points, double length, double mass, Base base, Vec3 const& anchor);

}  // namespace catena::scene
