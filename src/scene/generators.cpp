#include "scene/generators.hpp"

#include <cmath>

#include "scene/conformation.hpp"
#include "scene/random.hpp"

namespace catena::scene {

namespace {

double random_mass(Draws& draws) { return std::exp2(draws.between(-1, 1)); }

/// R diag(J) R^T
Sym3 rotated_inertia(Vec3 const& principal, Quat const& orientation) {
    Mat3 const r = to_matrix(orientation);
    Sym3 j;
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b <= a; ++b)
            j(a, b) = r(a, 0) * principal[0] * r(b, 0) + r(a, 1) * principal[1] * r(b, 1) + r(a, 2) * principal[2] * r(b, 2);
    return j;
}

Sym3 random_inertia(Draws& draws, double mass) {
    double const x = draws.between(0.05, 0.15), y = draws.between(0.05, 0.15), z = draws.between(0.05, 0.15);
    return rotated_inertia({{mass * (y + z), mass * (z + x), mass * (x + y)}}, draws.rotation());
}

std::array<double, 4> numbers_of(Quat const& q) { return {q.w, q.x, q.y, q.z}; }

void random_state(BodyArrays& bodies, Draws& draws, JointType joint) {
    bool const revolute = joint == JointType::revolute;
    bodies.joint.push_back(joint);
    bodies.axis.push_back(revolute ? draws.on_sphere() : Vec3::zero());
    bodies.q.push_back(revolute ? std::array<double, 4>{draws.between(-Draws::pi, Draws::pi), 0, 0, 0} : numbers_of(draws.rotation()));
    bodies.qd.push_back(revolute ? Vec3{{draws.between(-1, 1), 0, 0}} : draws.in_cube(1));
    bool const driven = joint != JointType::free;
    bodies.torque.push_back(!driven ? Vec3::zero() : revolute ? Vec3{{draws.between(-1, 1), 0, 0}} : draws.in_cube(1));
}

void random_frame(BodyArrays& bodies, Draws& draws, JointType joint) {
    if (joint == JointType::free) {
        bodies.free_position = draws.in_cube(1);
        bodies.free_velocity = draws.in_cube(1);
        bodies.rotation.push_back(Mat3::identity());
        bodies.translation.push_back(Vec3::zero());
        return;
    }
    double const distance = draws.between(0.5, 1.5);
    bodies.translation.push_back(distance * draws.on_sphere());
    bodies.rotation.push_back(to_matrix(draws.rotation()));
}

template <class Array>
void reserve(Array& array, std::int64_t n) {
    array.reserve(static_cast<std::size_t>(n));
}

void reserve_all(BodyArrays& bodies, std::int64_t n) {
    reserve(bodies.mass, n), reserve(bodies.com, n), reserve(bodies.inertia, n), reserve(bodies.joint, n), reserve(bodies.axis, n);
    reserve(bodies.rotation, n), reserve(bodies.translation, n), reserve(bodies.q, n), reserve(bodies.qd, n);
}

}  // namespace

BodyArrays random_bodies(std::int64_t n, JointType joint, Base base, std::uint64_t seed) {
    BodyArrays bodies;
    reserve_all(bodies, n);
    reserve(bodies.torque, n), reserve(bodies.wrench, n);
    for (std::int64_t k = 0; k < n; ++k) {
        Draws draws(seed, k);
        JointType const type = k == 0 && base == Base::free ? JointType::free : joint;
        bodies.mass.push_back(random_mass(draws));
        bodies.com.push_back(draws.in_cube(0.5));
        bodies.inertia.push_back(random_inertia(draws, bodies.mass.back()));
        random_frame(bodies, draws, type);
        random_state(bodies, draws, type);
        bool const loaded = draws.uniform() < 0.25;
        Vec3 const torque = loaded ? draws.in_cube(1) : Vec3::zero();
        bodies.wrench.emplace_back(torque, loaded ? draws.in_cube(1) : Vec3::zero());
    }
    return bodies;
}

BeadArrays random_beads(std::int64_t n, Base base, Vec3 const& anchor, std::uint64_t seed) {
    BeadArrays beads;
    reserve(beads.mass, n), reserve(beads.position, n), reserve(beads.velocity, n), reserve(beads.length, n);
    beads.residue.assign(static_cast<std::size_t>(n), "UNK");
    beads.anchor = anchor;
    Vec3 position = anchor, velocity = Vec3::zero();
    for (std::int64_t k = 0; k < n; ++k) {
        Draws draws(seed, k);
        beads.mass.push_back(random_mass(draws));
        double const length = draws.between(0.5, 1.5);
        Vec3 const along = length * draws.on_sphere(), turning = draws.in_cube(1);
        if (k > 0 || base == Base::fixed) {
            position = position + along;
            velocity = velocity + cross(turning, along);
        } else {
            velocity = turning;
        }
        beads.length.push_back(k > 0 || base == Base::fixed ? length : 0);
        beads.position.push_back(position);
        beads.velocity.push_back(velocity);
    }
    return beads;
}

BodyArrays pendulum(std::int64_t links, double mass, double length, double radius) {
    auto const n = static_cast<std::size_t>(links);
    double const along = mass * radius * radius / 2, across = mass * (3 * radius * radius + length * length) / 12;
    BodyArrays bodies;
    bodies.mass.assign(n, mass);
    bodies.com.assign(n, {{0.5 * length, 0, 0}});
    bodies.inertia.assign(n, Sym3{{along, 0, across, 0, 0, across}});
    bodies.joint.assign(n, JointType::revolute);
    bodies.axis.assign(n, {{0, 0, 1}});
    bodies.rotation.assign(n, Mat3::identity());
    bodies.translation.assign(n, {{length, 0, 0}});
    bodies.translation[0] = Vec3::zero();
    bodies.q.assign(n, {0, 0, 0, 0});
    bodies.qd.assign(n, Vec3::zero());
    return bodies;
}

BeadArrays beads_at(std::vector<Vec3> const& points, double length, double mass, Base base, Vec3 const& anchor) {
    std::size_t const skipped = base == Base::fixed ? 1 : 0, n = points.size() - skipped;
    BeadArrays beads;
    beads.mass.assign(n, mass);
    beads.velocity.assign(n, Vec3::zero());
    beads.length.assign(n, length);
    if (base == Base::free) beads.length[0] = 0;
    beads.residue.assign(n, "UNK");
    beads.anchor = anchor;
    beads.position.reserve(n);
    for (std::size_t k = 0; k < n; ++k) beads.position.push_back(anchor + (points[k + skipped] - points[0]));
    return beads;
}

BeadArrays freely_jointed(std::int64_t beads, double length, double mass, Base base, Vec3 const& anchor, std::uint64_t seed) {
    return beads_at(random_walk(base == Base::fixed ? beads + 1 : beads, length, seed), length, mass, base, anchor);
}

}  // namespace catena::scene
