// Implements the generators of rods, polygons and beads at given points.
#include "generate/generators.hpp"

#include <cmath>

#include "generate/conformation.hpp"
#include "generate/random.hpp"
#include "joints/joint_models.hpp"
#include "math/philox.hpp"

namespace catena::scene {

namespace {

/// Chain of n bodies on revolute joints at rest, with zero masses.
BodyArrays revolute_chain(std::size_t n) {
    BodyArrays bodies;
    bodies.mass.assign(n, 0);
    bodies.com.assign(n, Vec3::zero());
    bodies.inertia.assign(n, Sym3::zero());
    bodies.joint.assign(n, RevoluteJoint::type);
    bodies.axis.assign(n, {{0, 0, 1}});
    bodies.rotation.assign(n, Mat3::identity());
    bodies.translation.assign(n, Vec3::zero());
    bodies.q.assign(n, {0, 0, 0, 0});
    bodies.qd.assign(n, Vec3::zero());
    return bodies;
}

/// Makes body k a solid cylinder along +x with its origin at one end. The next body's joint frame
/// is placed at the other end.
void set_rod(BodyArrays& bodies, std::size_t k, double mass, double length, double radius) {
    double const along = mass * radius * radius / 2,
                 across = mass * (3 * radius * radius + length * length) / 12;
    bodies.mass[k] = mass;
    bodies.com[k] = {{0.5 * length, 0, 0}};
    bodies.inertia[k] = Sym3{{along, 0, across, 0, 0, across}};
    if (k + 1 < bodies.size()) bodies.translation[k + 1] = {{length, 0, 0}};
}

/// Draws the sizes of rod k; `scale` multiplies its length and radius.
void draw_rod(BodyArrays& bodies, Rods const& rods, std::size_t k, double scale) {
    auto const body = static_cast<std::int64_t>(k);
    double const mass = draw_size(rods.mass, rods.seed, body, SizeStream::mass);
    double const length = draw_size(rods.length, rods.seed, body, SizeStream::length);
    double const radius =
        rods.radius ? draw_size(*rods.radius, rods.seed, body, SizeStream::radius) : 0.05 * length;
    set_rod(bodies, k, scale * scale * scale * mass, scale * length, scale * radius);
}

/// Rotation by `angle` about x.
Mat3 about_x(double angle) {
    double const c = std::cos(angle), s = std::sin(angle);
    return {{1, 0, 0, 0, c, -s, 0, s, c}};
}

/// Sets every joint to the angle `turn`, its axis rotated by `twist` about the rod before it.
void wind(BodyArrays& bodies, Winding const& winding, double twist) {
    Mat3 const turned = about_x(twist);
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        bodies.q[k] = {winding.turn, 0, 0, 0};
        if (k > 0) bodies.rotation[k] = turned;
    }
    if (winding.base == Base::fixed) return;
    bodies.joint[0] = FreeJoint::type;
    bodies.axis[0] = Vec3::zero();
    bodies.q[0] = {1, 0, 0, 0};
}

/// Draws the rotation of a spherical joint from the equilibrium of its springs. A rotation vector
/// is drawn from the normal density of the springs. It is accepted with the weight of the rotation
/// group: (sin(a / 2) / (a / 2))^2.
Quat elastic_turn(ElasticRod const& rod, Vec3 const& stiffness, std::int64_t k) {
    for (std::uint64_t attempt = 0;; ++attempt) {
        Vec3 turn =
            normal3(rod.seed, attempt, static_cast<std::uint64_t>(k), NoiseStage::conformation);
        for (int i = 0; i < 3; ++i) turn[i] *= std::sqrt(rod.kt / stiffness[i]);
        double const half = 0.5 * norm(turn), weight = half > 0 ? std::sin(half) / half : 1;
        if (2 * half < Draws::pi && Draws(rod.seed, k, attempt).uniform() < weight * weight)
            return from_rotation_vector(turn);
    }
}

}  // namespace

BodyArrays pendulum(Rods const& rods) {
    BodyArrays bodies = revolute_chain(static_cast<std::size_t>(rods.bodies));
    for (std::size_t k = 0; k < bodies.size(); ++k) draw_rod(bodies, rods, k, 1);
    return bodies;
}

BodyArrays coil(Rods const& rods, Winding const& winding) {
    BodyArrays bodies = pendulum(rods);
    wind(bodies, winding, winding.twist);
    return bodies;
}

BodyArrays dill(Rods const& rods, Winding const& winding) {
    BodyArrays bodies = revolute_chain(static_cast<std::size_t>(rods.bodies));
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        double scale = 1;
        for (std::size_t number = k + 1; number % 2 == 0; number /= 2) scale *= winding.ratio;
        draw_rod(bodies, rods, k, scale);
    }
    wind(bodies, winding, Draws::pi / 2);
    return bodies;
}

BodyArrays elastic_rod(ElasticRod const& rod) {
    BodyArrays bodies = revolute_chain(static_cast<std::size_t>(rod.bodies));
    Vec3 const stiffness{{rod.kt * rod.twist / rod.length, rod.kt * rod.bend / rod.length,
                          rod.kt * rod.bend / rod.length}};
    bodies.axis.assign(bodies.size(), Vec3::zero());
    bodies.stiffness.assign(bodies.size(), stiffness);
    bodies.rest.assign(bodies.size(), {1, 0, 0, 0});
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        set_rod(bodies, k, rod.mass, rod.length, rod.radius);
        bodies.joint[k] = SphericalJoint::type;
        if (k == 0) continue;
        Quat const turn = elastic_turn(rod, stiffness, static_cast<std::int64_t>(k));
        bodies.q[k] = {turn.w, turn.x, turn.y, turn.z};
    }
    bool const free = rod.base == Base::free;
    bodies.joint[0] = free ? FreeJoint::type : WeldJoint::type;
    bodies.q[0] = {free ? 1.0 : 0.0, 0, 0, 0};
    bodies.stiffness[0] = Vec3::zero();
    return bodies;
}

BodyArrays polygon(Polygon const& shape) {
    BodyArrays bodies = revolute_chain(static_cast<std::size_t>(shape.sides));
    double const turn = 2 * Draws::pi / static_cast<double>(shape.sides), half = turn / 2;
    bool const balls = is_ball(shape.joint);
    std::array<double, 4> const at_rest =
        balls ? std::array<double, 4>{1, 0, 0, 0} : std::array<double, 4>{0, 0, 0, 0};
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        set_rod(bodies, k, shape.mass, shape.length, shape.radius);
        bodies.joint[k] = shape.joint;
        if (balls) bodies.axis[k] = Vec3::zero();
        bodies.q[k] = k == 0  ? at_rest
                      : balls ? std::array<double, 4>{std::cos(half), 0, 0, std::sin(half)}
                              : std::array<double, 4>{turn, 0, 0, 0};
    }
    bodies.qd[0] = balls || shape.base == Base::free ? shape.spin : Vec3{{shape.spin[2], 0, 0}};
    if (shape.base == Base::fixed) return bodies;
    Vec3 const to_centre{{shape.length / 2, shape.length / (2 * std::tan(half)), 0}};
    bodies.joint[0] = FreeJoint::type;
    bodies.axis[0] = Vec3::zero();
    bodies.q[0] = {1, 0, 0, 0};
    bodies.free_base.velocity = cross(to_centre, shape.spin);
    return bodies;
}

BeadArrays polygon_of_beads(Polygon const& shape) {
    double const turn = 2 * Draws::pi / static_cast<double>(shape.sides),
                 radius = shape.length / (2 * std::sin(turn / 2));
    std::vector<Vec3> corners;
    for (std::int64_t k = 0; k < shape.sides; ++k) {
        double const angle = turn * static_cast<double>(k);
        corners.push_back({{radius * std::cos(angle), radius * std::sin(angle), 0}});
    }
    return beads_at(corners, shape.length, shape.mass, Base::free, Vec3::zero());
}

BeadArrays beads_at(std::vector<Vec3> const& points, double length, double mass, Base base,
                    Vec3 const& anchor) {
    std::size_t const skipped = base == Base::fixed ? 1 : 0, n = points.size() - skipped;
    BeadArrays beads;
    beads.mass.assign(n, mass);
    beads.velocity.assign(n, Vec3::zero());
    beads.length.assign(n, length);
    if (base == Base::free) beads.length[0] = 0;
    beads.residue.assign(n, "UNK");
    beads.anchor = anchor;
    beads.position.reserve(n);
    for (std::size_t k = 0; k < n; ++k)
        beads.position.push_back(anchor + (points[k + skipped] - points[0]));
    return beads;
}

}  // namespace catena::scene
