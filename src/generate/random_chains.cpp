// Implements random chains: all joint types, physically possible bodies.
#include <cmath>

#include "generate/generators.hpp"
#include "joints/joint_models.hpp"

namespace catena::scene {

namespace {

std::array<double, 4> numbers_of(Quat const& q) { return {q.w, q.x, q.y, q.z}; }

/// Returns R diag(J) R^T with the rotation matrix R of `orientation`.
Sym3 rotated_inertia(Vec3 const& principal, Quat const& orientation) {
    Mat3 const r = to_matrix(orientation);
    Sym3 j;
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b <= a; ++b)
            j(a, b) = r(a, 0) * principal[0] * r(b, 0) + r(a, 1) * principal[1] * r(b, 1) +
                      r(a, 2) * principal[2] * r(b, 2);
    return j;
}

/// Draws an inertia that satisfies the triangle inequality: the principal moments are sums of
/// second moments.
Sym3 random_inertia(Draws& draws, RandomChain const& chain, double mass) {
    double const x = chain.inertia.draw(draws), y = chain.inertia.draw(draws),
                 z = chain.inertia.draw(draws);
    return rotated_inertia({{mass * (y + z), mass * (z + x), mass * (x + y)}}, draws.rotation());
}

/// Returns the types of `mixed` chains, in the order of the list of joint models.
std::vector<JointType> types_of_mixed() {
    std::vector<JointType> types;
    for_each_joint([&](auto model) {
        if (decltype(model)::mixed) types.push_back(decltype(model)::type);
    });
    return types;
}

/// Joint type of one body; draws a random number only for `mixed`.
JointType type_of(RandomJoint joint, Draws& draws) {
    static std::vector<JointType> const mixed = types_of_mixed();
    switch (joint) {
        case RandomJoint::planar:
        case RandomJoint::revolute:
            return RevoluteJoint::type;
        case RandomJoint::universal:
            return UniversalJoint::type;
        case RandomJoint::spherical:
            return SphericalJoint::type;
        case RandomJoint::weld:
            return WeldJoint::type;
        case RandomJoint::prismatic:
            return PrismaticJoint::type;
        case RandomJoint::helical:
            return HelicalJoint::type;
        case RandomJoint::cylindrical:
            return CylindricalJoint::type;
        case RandomJoint::planar3:
            return Planar3Joint::type;
        case RandomJoint::link:
            return LinkJoint::type;
        case RandomJoint::mixed:
            break;
    }
    auto const count = static_cast<int>(mixed.size());
    return mixed[static_cast<std::size_t>(static_cast<int>(count * draws.uniform()) % count)];
}

/// Draws `count` components in [-1, 1]; the others are zero.
Vec3 components(Draws& draws, int count) {
    Vec3 v = Vec3::zero();
    for (int i = 0; i < count; ++i) v[i] = draws.between(-1, 1);
    return v;
}

/// Draws axes, coordinates, rates and torques of the bodies.
class RandomJoints {
  public:
    RandomJoints(BodyArrays& bodies, RandomJoint kind) : bodies_(bodies), kind_(kind) {
        bool const mixed = kind == RandomJoint::mixed;
        axes_ = mixed || kind == RandomJoint::universal || kind == RandomJoint::planar3;
        pitches_ = mixed || kind == RandomJoint::helical;
    }

    void add(Draws& draws, JointType joint) {
        bodies_.joint.push_back(joint);
        Vec3 const axis = axis_of(draws, joint);
        bodies_.axis.push_back(axis);
        if (axes_)
            bodies_.first_axis.push_back(has_two_axes(joint) ? first_axis(draws, joint, axis)
                                                             : Vec3::zero());
        if (pitches_) bodies_.pitch.push_back(has_pitch(joint) ? pitch(draws) : 0);
        bodies_.q.push_back(position(draws, joint));
        bodies_.qd.push_back(components(draws, rates_of_joint(joint)));
        bodies_.torque.push_back(components(draws, numbers_of_joint(joint)));
    }

  private:
    Vec3 axis_of(Draws& draws, JointType joint) const {
        if (!has_one_axis(joint) && !has_two_axes(joint)) return Vec3::zero();
        return kind_ == RandomJoint::planar ? Vec3{{0, 0, 1}} : draws.on_sphere();
    }
    /// Draws a first axis at least 30 degrees from `axis`.
    static Vec3 across(Draws& draws, Vec3 const& axis) {
        Vec3 first = draws.on_sphere();
        while (norm(cross(first, axis)) < 0.5) first = draws.on_sphere();
        return first;
    }
    /// Draws the first axis of a joint with two.
    static Vec3 first_axis(Draws& draws, JointType joint, Vec3 const& axis) {
        Vec3 const first = across(draws, axis);
        if (!glides(joint)) return first;
        Vec3 const level = cross(axis, first);
        return (1 / norm(level)) * level;
    }
    static double pitch(Draws& draws) {
        double const size = draws.between(0.05, 0.3);
        return draws.uniform() < 0.5 ? size : -size;
    }
    static std::array<double, 4> position(Draws& draws, JointType joint) {
        return with_joint(joint, [&](auto model) { return model.random_position(draws); });
    }

    BodyArrays& bodies_;
    RandomJoint kind_;
    bool axes_ = false, pitches_ = false;
};

/// Draws the joint frame, or position and velocity of a free body.
void random_frame(BodyArrays& bodies, Draws& draws, JointType joint, RandomChain const& chain) {
    if (floats(joint)) {
        bodies.free_base.position = draws.in_cube(1);
        bodies.free_base.velocity = draws.in_cube(1);
        bodies.rotation.push_back(Mat3::identity());
        bodies.translation.push_back(Vec3::zero());
        return;
    }
    double const distance = chain.length.draw(draws);
    bodies.translation.push_back(distance * draws.on_sphere());
    bool const first = bodies.rotation.empty();
    bodies.rotation.push_back(
        chain.joint == RandomJoint::planar && !first
            ? to_matrix(from_axis_angle(Vec3{{0, 0, 1}}, draws.between(-Draws::pi, Draws::pi)))
            : to_matrix(draws.rotation()));
}

template <class... Array>
void reserve(std::int64_t n, Array&... arrays) {
    (arrays.reserve(static_cast<std::size_t>(n)), ...);
}

/// Outboard point of the last body of a growing chain of links, and its velocity.
struct LinkEnd {
    Vec3 position, velocity;
    /// Advances along a random link with a random angular velocity and returns its length. Without
    /// a link only the velocity is drawn and 0 returned.
    double step(Draws& draws, RandomChain const& chain, bool linked) {
        double const length = chain.length.draw(draws);
        Vec3 const along = length * draws.on_sphere(), turning = draws.in_cube(1);
        if (!linked) return velocity = turning, 0;
        position = position + along;
        velocity = velocity + cross(turning, along);
        return length;
    }
};

/// Makes body k of `linked` rigid with its inboard end at `end`, then moves `end` to its outboard
/// end.
void add_rigid(LinkedArrays& linked, Draws& draws, RandomChain const& chain, LinkEnd& end) {
    linked.inertia.push_back(random_inertia(draws, chain, linked.mass.back()));
    Quat const orientation = draws.rotation();
    Mat3 const r = to_matrix(orientation);
    Vec3 const omega = draws.in_cube(1);
    double const before = draws.between(0.25, 0.75), after = draws.between(0.25, 0.75);
    Vec3 const inboard = before * draws.on_sphere(), outboard = after * draws.on_sphere();
    end.position = end.position - r * inboard;
    end.velocity = end.velocity - r * cross(omega, inboard);
    linked.position.push_back(end.position);
    linked.velocity.push_back(end.velocity);
    linked.orientation.push_back(numbers_of(orientation));
    linked.omega.push_back(omega);
    linked.inboard.push_back(inboard);
    linked.outboard.push_back(outboard);
    end.position = end.position + r * outboard;
    end.velocity = end.velocity + r * cross(omega, outboard);
}

/// Adds a point bead at `end`.
void add_bead(LinkedArrays& linked, LinkEnd const& end) {
    linked.inertia.push_back(Sym3::zero());
    linked.position.push_back(end.position);
    linked.velocity.push_back(end.velocity);
    linked.orientation.push_back({1, 0, 0, 0});
    for (auto* const zero : {&linked.omega, &linked.inboard, &linked.outboard})
        zero->push_back(Vec3::zero());
    linked.carried.position.push_back(Vec3::zero());
    linked.carried.mass.push_back(linked.mass.back());
    linked.carried.residue.emplace_back("UNK");
}

}  // namespace

BodyArrays random_bodies(RandomChain const& chain) {
    BodyArrays bodies;
    reserve(chain.bodies, bodies.mass, bodies.com, bodies.inertia, bodies.joint, bodies.axis,
            bodies.rotation, bodies.translation, bodies.q, bodies.qd, bodies.torque, bodies.wrench);
    RandomJoints joints(bodies, chain.joint);
    for (std::int64_t k = 0; k < chain.bodies; ++k) {
        Draws draws(chain.seed, k);
        bodies.mass.push_back(chain.mass.draw(draws));
        bodies.com.push_back(draws.in_cube(0.5));
        bodies.inertia.push_back(random_inertia(draws, chain, bodies.mass.back()));
        bool const floating = k == 0 && chain.base == Base::free;
        JointType const type = floating ? FreeJoint::type : type_of(chain.joint, draws);
        random_frame(bodies, draws, type, chain);
        joints.add(draws, type);
        bool const loaded = draws.uniform() < 0.25;
        Vec3 const torque = loaded ? draws.in_cube(1) : Vec3::zero();
        bodies.wrench.emplace_back(torque, loaded ? draws.in_cube(1) : Vec3::zero());
    }
    return bodies;
}

BeadArrays random_beads(RandomChain const& chain) {
    BeadArrays beads;
    reserve(chain.bodies, beads.mass, beads.position, beads.velocity, beads.length);
    beads.residue.assign(static_cast<std::size_t>(chain.bodies), "UNK");
    beads.anchor = chain.anchor;
    LinkEnd end{chain.anchor, Vec3::zero()};
    for (std::int64_t k = 0; k < chain.bodies; ++k) {
        Draws draws(chain.seed, k);
        beads.mass.push_back(chain.mass.draw(draws));
        beads.length.push_back(end.step(draws, chain, k > 0 || chain.base == Base::fixed));
        beads.position.push_back(end.position);
        beads.velocity.push_back(end.velocity);
    }
    return beads;
}

LinkedArrays random_linked(RandomChain const& chain) {
    LinkedArrays linked;
    reserve(chain.bodies, linked.mass, linked.inertia, linked.position, linked.velocity,
            linked.orientation, linked.omega, linked.inboard, linked.outboard, linked.length,
            linked.carried.offset);
    linked.anchor = chain.anchor;
    linked.carried.offset.push_back(0);
    LinkEnd end{chain.anchor, Vec3::zero()};
    for (std::int64_t k = 0; k < chain.bodies; ++k) {
        Draws draws(chain.seed, k);
        linked.mass.push_back(chain.mass.draw(draws));
        linked.length.push_back(end.step(draws, chain, k > 0 || chain.base == Base::fixed));
        draws.uniform() < chain.rigid ? add_rigid(linked, draws, chain, end)
                                      : add_bead(linked, end);
        linked.carried.offset.push_back(static_cast<std::int64_t>(linked.carried.size()));
    }
    if (linked.carried.size() == 0) linked.carried = {};
    return linked;
}

}  // namespace catena::scene
