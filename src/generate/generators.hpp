// Chains made from a few numbers. All are O(n), functions of their arguments alone, and body k does
// not depend on n.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "generate/distribution.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

enum class RandomJoint : std::uint8_t {
    link,
    planar,
    revolute,
    universal,
    spherical,
    weld,
    prismatic,
    helical,
    mixed
};

struct RandomChain {
    std::int64_t bodies = 0;
    RandomJoint joint = RandomJoint::revolute;
    Base base = Base::fixed;
    std::uint64_t seed = 0;
    Distribution mass{Distribution::Kind::log_uniform, {0.5, 2}};
    Distribution length{Distribution::Kind::uniform, {0.5, 1.5}};  // between joints; of links
    Distribution inertia{
        Distribution::Kind::uniform,
        {0.05, 0.15}};           // second moments of the mass along the principal axes, per mass
    Vec3 anchor = Vec3::zero();  // links on a fixed base
    double rigid = 0;            // links: the fraction of rigid bodies among beads
};

/// Random rigid bodies of about unit size, mass and speed. Inertias m R diag(s2+s3, s3+s1, s1+s2)
/// R^T with R uniform, so that the triangle inequality holds with room; centres of mass in [-0.5,
/// 0.5]^3; joint frames at `length` in a uniform direction, uniformly rotated; angles and
/// orientations uniform, shifts in [-0.5, 0.5]; rates and joint torques in [-1, 1]; every fourth
/// body (at random) carries a wrench with components in [-1, 1]. Axes are uniform; those of a
/// universal joint are 30 degrees or more apart; planar: revolute joints whose axes are all
/// parallel; pitches in [0.05, 0.3] of either sign; mixed: each joint one of the six at random. A
/// free base gets a random pose and velocity.
BodyArrays random_bodies(RandomChain const& chain);

/// Random beads on links in uniform directions; velocities satisfy the links: each link turns with
/// components of its angular velocity in
/// [-1, 1] (bead 1 of a free base moves at up to 1).
BeadArrays random_beads(RandomChain const& chain);

/// As random_beads, with rigid bodies in the place of a fraction `rigid` of the beads: inertias as
/// random_bodies', ends of links at 0.25 to 0.75 from the centre of mass in uniform directions,
/// orientations uniform, angular velocities in [-1, 1]. Beads carry themselves.
LinkedArrays random_linked(RandomChain const& chain);

/// Sizes of equal or random links.
struct Rods {
    std::int64_t bodies = 0;
    Distribution mass{1.0}, length{1.0};
    std::optional<Distribution> radius;  // not given: 0.05 of the length
    std::uint64_t seed = 0;
    bool is_random() const {
        return !mass.is_fixed() || !length.is_fixed() || (radius && !radius->is_fixed());
    }
};

/// The chapter's test case (Fig. 2.4): equal uniform rods, all along +x, at rest, joints revolute
/// about +z, joint 1 at the ground's origin. Each is a solid cylinder: inertia m r^2 / 2 along, m
/// (3 r^2 + l^2) / 12 across.
BodyArrays pendulum(Rods const& rods);

/// Standard hard shapes after Featherstone's ("An empirical study of the joint space inertia
/// matrix", 2004; "A divide-and-conquer articulated-body algorithm, part 2", 1999), whose condition
/// numbers grow up to O(n^4). These are serial chains of rods as pendulum's, on revolute joints, at
/// rest, all joints at the angle `turn`; where they differ from the published ones in detail, these
/// definitions hold. coil: joint axes stand across the rods, each turned by `twist` about its rod
/// against the one before, so that the chain winds up into a helix and far bodies come to lie near
/// each other. dill: self-similar: rod k (from 1) is `ratio`^v times as long and as thick as given,
/// its mass times ratio^(3 v), v the number of times that 2 divides k: every second rod is of full
/// size, every fourth the next smaller, and so on; axes alternate by a right angle. (Featherstone's
/// dill is a tree with such branches.)
struct Winding {
    double turn = 0.3, twist = 0.1, ratio = 0.5;
    Base base = Base::fixed;
};
BodyArrays coil(Rods const& rods, Winding const& winding);
BodyArrays dill(Rods const& rods, Winding const& winding);

/// Equal rods as pendulum's on spherical joints whose springs, kt bend / length across and kt twist
/// / length along the rods, make them an elastic rod with these persistence lengths where the rods
/// are short. At rest, every joint drawn from its equilibrium, exp(-U / kt) over the rotations. The
/// first rod lies along +x from the origin, free or welded to the ground.
struct ElasticRod {
    std::int64_t bodies = 0;
    double mass = 1, length = 1, radius = 0.05, bend = 1, twist = 1, kt = 1;
    Base base = Base::free;
    std::uint64_t seed = 0;
};
BodyArrays elastic_rod(ElasticRod const& rod);

/// A regular polygon of equal rods as pendulum's, in the plane of x and y with its first side along
/// +x from the origin (a fixed base: on a joint there), left open for a tip to close. It turns with
/// angular velocity `spin`, W, as if it were rigid: about its centre, or with a fixed base about
/// the first corner.
struct Polygon {
    std::int64_t sides = 0;
    JointType joint = JointType::spherical;  // or revolute, about z
    double mass = 1, length = 1, radius = 0.05;
    Vec3 spin = Vec3::zero();
    Base base = Base::free;
};
BodyArrays polygon(Polygon const& shape);
/// The same of beads on links, at rest, the first at the origin; free base.
BeadArrays polygon_of_beads(Polygon const& shape);

/// Beads on links, at rest.
struct Walk {
    std::int64_t beads = 0;
    Distribution mass{1.0}, length{1.0};
    Base base = Base::free;
    Vec3 anchor = Vec3::zero();
    std::uint64_t seed = 0;
};

/// Independent uniform directions.
BeadArrays freely_jointed(Walk const& walk);

/// The discrete worm-like chain, drawn exactly: angles between successive links with weight
/// exp(kappa cos theta) on the sphere, uniform azimuths, kappa such that <cos theta> = exp(-l /
/// persistence), l the mean length of the two links; the first direction is uniform.
BeadArrays worm_like(Walk const& walk, double persistence);

/// kappa with coth(kappa) - 1 / kappa = exp(-ratio), ratio > 0.
double bending_of(double ratio);

/// Beads of equal mass and link length at `points` (of a fixed base: one more point, the anchor,
/// first), which are moved so that the first lies at `anchor`. Residues are UNK.
BeadArrays beads_at(std::vector<Vec3> const& points, double length, double mass, Base base,
                    Vec3 const& anchor);

}  // namespace catena::scene
