// Generators of chains from a few numbers. All cost O(n) and depend on their arguments alone; body
// k does not depend on n.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "generate/distribution.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// Joint types of random chains. planar: revolute joints with parallel axes. mixed: each joint has
/// a random type other than link.
enum class RandomJoint : std::uint8_t {
    link,
    planar,
    revolute,
    universal,
    spherical,
    weld,
    prismatic,
    helical,
    cylindrical,
    planar3,
    mixed
};

/// Parameters of a random chain.
struct RandomChain {
    std::int64_t bodies = 0;
    RandomJoint joint = RandomJoint::revolute;
    Base base = Base::fixed;
    std::uint64_t seed = 0;
    Distribution mass{Distribution::Kind::log_uniform, {0.5, 2}};
    Distribution length{Distribution::Kind::uniform,
                        {0.5, 1.5}};  // distance between joints; length of links
    Distribution inertia{Distribution::Kind::uniform,
                         /// Second moments of the mass along the principal axes, per mass.
                         {0.05, 0.15}};
    /// Ground point of the first link for a fixed base.
    Vec3 anchor = Vec3::zero();
    /// Fraction of rigid bodies among the beads of a chain of links.
    double rigid = 0;
};

/// Random rigid bodies of about unit size, mass and speed. Inertias are m R diag(s2+s3, s3+s1,
/// s1+s2) R^T with R uniform, so that the triangle inequality holds with a margin. Centres of mass
/// lie in [-0.5, 0.5]^3. Joint frames lie at `length` in a uniform direction and are uniformly
/// rotated. Angles and orientations are uniform, displacements in [-0.5, 0.5], rates and joint
/// torques in [-1, 1]. Every fourth body (at random) carries a wrench with components in [-1, 1].
/// Axes are uniform; those of a universal joint are at least 30 degrees apart. planar: revolute
/// joints whose axes are all parallel. Pitches are in [0.05, 0.3] of either sign. mixed: each joint
/// is one of the six types from revolute to helical at random. A free base has a random pose and
/// velocity.
BodyArrays random_bodies(RandomChain const& chain);

/// Random beads on links in uniform directions. Velocities satisfy the links: each link rotates
/// with components of its angular velocity in [-1, 1]. Bead 1 of a free base has velocity
/// components in [-1, 1].
BeadArrays random_beads(RandomChain const& chain);

/// Chain like random_beads() with rigid bodies in place of a fraction `rigid` of the beads.
/// Inertias are those of random_bodies(). Ends of links lie at 0.25 to 0.75 from the centre of mass
/// in uniform directions. Orientations are uniform, components of angular velocities in [-1, 1].
/// Beads carry themselves.
LinkedArrays random_linked(RandomChain const& chain);

/// Sizes of equal or random rods.
struct Rods {
    std::int64_t bodies = 0;
    Distribution mass{1.0}, length{1.0};
    /// Radius of the rods; 0.05 of the length if not given.
    std::optional<Distribution> radius;
    std::uint64_t seed = 0;
    /// True if chains with different seeds differ.
    bool is_random() const {
        return !mass.is_fixed() || !length.is_fixed() || (radius && !radius->is_fixed());
    }
};

/// The chapter's test case (Fig. 2.4): equal uniform rods, all along +x, at rest. Joints are
/// revolute about +z, joint 1 at the ground's origin. Each rod is a solid cylinder: inertia m r^2 /
/// 2 along, m (3 r^2 + l^2) / 12 across.
BodyArrays pendulum(Rods const& rods);

/// Standard hard shapes after Featherstone's ("An empirical study of the joint space inertia
/// matrix", 2004; "A divide-and-conquer articulated-body algorithm, part 2", 1999), with condition
/// numbers up to O(n^4). They are serial chains of rods like pendulum(), on revolute joints, at
/// rest, with all joints at the angle `turn`. These definitions hold if they differ from the
/// published ones in detail. coil: joint axes are perpendicular to the rods. Each axis is rotated
/// by `twist` about its rod relative to the preceding axis. The chain forms a helix, so that
/// distant bodies come close to each other. dill: a self-similar chain. Rod k (from 1) has
/// `ratio`^v times the given length and radius and ratio^(3 v) times the given mass. The exponent v
/// is the number of times that 2 divides k. Every second rod has full size, every fourth the next
/// smaller size, and so on; axes alternate by a right angle. (Featherstone's dill is a tree with
/// such branches.)
struct Winding {
    double turn = 0.3, twist = 0.1, ratio = 0.5;
    Base base = Base::fixed;
};
/// Helix of rods, see Winding.
BodyArrays coil(Rods const& rods, Winding const& winding);
/// Self-similar chain of rods, see Winding.
BodyArrays dill(Rods const& rods, Winding const& winding);

/// Equal rods like pendulum() on spherical joints with springs. The springs are kt bend / length
/// across and kt twist / length along the rods. They make an elastic rod with these persistence
/// lengths if the rods are short. The chain is at rest; every joint is drawn from its equilibrium,
/// exp(-U / kt) over the rotations. The first rod lies along +x from the origin, free or welded to
/// the ground.
struct ElasticRod {
    std::int64_t bodies = 0;
    double mass = 1, length = 1, radius = 0.05, bend = 1, twist = 1, kt = 1;
    Base base = Base::free;
    std::uint64_t seed = 0;
};
BodyArrays elastic_rod(ElasticRod const& rod);

/// Regular polygon of equal rods like pendulum(), in the xy plane, with its first side along +x
/// from the origin. A fixed base has a joint at the origin. The polygon is left open for a tip to
/// close. It rotates with angular velocity `spin`, W, as a rigid body. The centre of rotation is
/// its own centre, or the first corner for a fixed base.
struct Polygon {
    std::int64_t sides = 0;
    JointType joint = JointType::spherical;  // spherical, or revolute about z
    double mass = 1, length = 1, radius = 0.05;
    Vec3 spin = Vec3::zero();
    Base base = Base::free;
};
BodyArrays polygon(Polygon const& shape);
/// Regular polygon of beads on links, at rest, with the first bead at the origin; free base.
BeadArrays polygon_of_beads(Polygon const& shape);

/// Parameters of a random walk of beads on links, at rest.
struct Walk {
    std::int64_t beads = 0;
    Distribution mass{1.0}, length{1.0};
    Base base = Base::free;
    Vec3 anchor = Vec3::zero();
    std::uint64_t seed = 0;
};

/// Beads of a walk without positions: masses and lengths of the links; entry 0 of a free base has
/// no link.
BeadArrays drawn_sizes(Walk const& walk);

/// Walk with independent uniform directions.
BeadArrays freely_jointed(Walk const& walk);

/// Discrete worm-like chain, drawn exactly. Angles between successive links have weight exp(kappa
/// cos theta) on the sphere, azimuths are uniform. kappa satisfies <cos theta> = exp(-l /
/// persistence), with l the mean length of the two links. The first direction is uniform.
BeadArrays worm_like(Walk const& walk, double persistence);

/// Solves coth(kappa) - 1 / kappa = exp(-ratio) for kappa; precondition: ratio > 0.
double bending_of(double ratio);

/// Beads of equal mass and link length at `points`, shifted so that the first point lies at
/// `anchor`. A fixed base has one more point at the front, the anchor. Residues are UNK.
BeadArrays beads_at(std::vector<Vec3> const& points, double length, double mass, Base base,
                    Vec3 const& anchor);

}  // namespace catena::scene
