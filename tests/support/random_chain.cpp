#include "tests/support/random_chain.hpp"

#include <cmath>

#include "joints/joint_models.hpp"
#include "oracle/oracle.hpp"
#include "scene/loops.hpp"
#include "scene/pose.hpp"

namespace catena::test {
namespace {

// Of the standard library, not those under test: the last bits of a chain's axes are part of its
// seed.
Quat about_axis(Vec3 const& axis, double angle) {
    double const s = std::sin(0.5 * angle);
    return {std::cos(0.5 * angle), s * axis[0], s * axis[1], s * axis[2]};
}
Quat about_vector(Vec3 const& v) {
    double const angle = norm(v), s = angle > 1e-8 ? std::sin(0.5 * angle) / angle : 0.5;
    return {std::cos(0.5 * angle), s * v[0], s * v[1], s * v[2]};
}

double random_mass(Random& random) { return std::pow(10.0, random.uniform(-0.5, 0.5)); }

/// From random second moments of mass about random principal axes: positive definite, triangle
/// inequality kept.
Sym3 random_inertia(Random& random, double mass) {
    double const a = mass * std::pow(random.uniform(0.03, 0.3), 2),
                 b = mass * std::pow(random.uniform(0.03, 0.3), 2),
                 c = mass * std::pow(random.uniform(0.03, 0.3), 2);
    Mat3 const r = to_matrix(random.orientation());
    double const principal[] = {b + c, a + c, a + b};
    Sym3 inertia = Sym3::zero();
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j)
            for (int p = 0; p < 3; ++p) inertia(i, j) += r(i, p) * principal[p] * r(j, p);
    return inertia;
}

std::array<double, 4> as_array(Quat const& q) { return {q.w, q.x, q.y, q.z}; }

JointType one_of(Random& random, std::vector<JointType> const& types) {
    return types[static_cast<std::size_t>(random.uniform() * static_cast<double>(types.size()))];
}

JointType random_joint(Random& random, RandomChainOptions const& options, std::size_t k) {
    using enum JointType;
    if (k == 0 && options.base == Base::free) return free;
    switch (options.joints) {
        case RandomJoints::mixed:
            return random.chance(0.5) ? revolute : spherical;
        case RandomJoints::spherical:
            return spherical;
        case RandomJoints::universal:
            return universal;
        case RandomJoints::prismatic:
            return prismatic;
        case RandomJoints::helical:
            return helical;
        case RandomJoints::weld:
            return random.chance(0.5)
                       ? weld
                       : one_of(random, {revolute, spherical, universal, prismatic, helical});
        case RandomJoints::any:
            return one_of(random, {revolute, spherical, universal, weld, prismatic, helical});
        case RandomJoints::cylindrical:
            return cylindrical;
        case RandomJoints::planar3:
            return planar3;
        case RandomJoints::all:
            return one_of(random, {revolute, spherical, universal, weld, prismatic, helical,
                                   cylindrical, planar3});
        default:
            return revolute;
    }
}

/// Coordinates of a joint; of a free one those of its rotation.
int coordinates(JointType type) {
    if (type == JointType::spherical || type == JointType::free || type == JointType::planar3)
        return 3;
    if (type == JointType::universal || type == JointType::cylindrical) return 2;
    return type == JointType::weld ? 0 : 1;
}
/// Three numbers of which a joint takes as many as it has coordinates.
Vec3 of_joint(JointType type, Vec3 v) {
    for (int i = coordinates(type); i < 3; ++i) v[i] = 0;
    return v;
}
/// Coordinates in [-size, size), shifts in a fifth of that.
std::array<double, 4> random_coordinates(Random& random, JointType type, double size,
                                         Quat const& rotation) {
    if (type == JointType::spherical || type == JointType::free) return as_array(rotation);
    std::array<double, 4> q{0, 0, 0, 0};
    for (int i = 0; i < coordinates(type); ++i)
        q[static_cast<std::size_t>(i)] =
            random.uniform(-size, size) * (is_length(type, i) ? 0.2 : 1);
    return q;
}
/// At least some 25 degrees off `axis`.
Vec3 direction_off(Random& random, Vec3 const& axis) {
    Vec3 v = random.direction();
    while (norm(cross(v, axis)) < 0.4) v = random.direction();
    return v;
}

/// First axis of a joint with two; of planar3 perpendicular to `axis`.
Vec3 first_axis(Random& random, JointType type, Vec3 const& axis) {
    Vec3 const off = direction_off(random, axis);
    if (type != JointType::planar3) return off;
    Vec3 const level = cross(axis, off);
    return (1 / norm(level)) * level;
}

Vec3 const planar_axis{{0, 0, 1}};

void append_geometry(Random& random, RandomChainOptions const& options, JointType type,
                     BodyArrays& b) {
    bool const planar = options.joints == RandomJoints::planar,
               any_first = type == JointType::universal || type == JointType::planar3;
    b.joint.push_back(type);
    b.axis.push_back(planar ? planar_axis : random.direction());
    bool const level = planar && type == JointType::revolute;
    b.rotation.push_back(
        to_matrix(level ? about_axis(planar_axis, random.uniform(-3, 3)) : random.orientation()));
    b.translation.push_back(random.uniform(0.2, 0.6) * random.direction());
    if (any_first || !b.first_axis.empty()) {
        b.first_axis.resize(b.joint.size(), Vec3::zero());
        if (any_first) b.first_axis.back() = first_axis(random, type, b.axis.back());
    }
    if (type == JointType::helical || !b.pitch.empty()) {
        b.pitch.resize(b.joint.size(), 0);
        if (type == JointType::helical)
            b.pitch.back() = (random.chance(0.5) ? 1 : -1) * random.uniform(0.02, 0.2);
    }
}

void append_drive(Random& random, RandomChainOptions const& options, BodyArrays& b) {
    JointType const type = b.joint.back();
    bool const can = coordinates(type) == 1 || coordinates(type) == 2;
    if (options.driven == 0 || !can || !random.chance(options.driven)) return;
    DrivenJoint drive{static_cast<std::int64_t>(b.joint.size() - 1), {}};
    for (PrescribedMotion& c : drive.course)
        c = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0, 0.3),
             random.uniform(0, 1), random.uniform(-3, 3)};
    b.driven.push_back(drive);
}

void append_joint(Random& random, RandomChainOptions const& options, BodyArrays& b) {
    JointType const type = random_joint(random, options, b.joint.size());
    append_geometry(random, options, type, b);
    Quat const orientation = random.orientation();
    b.q.push_back(random_coordinates(random, type, 3, orientation));
    Vec3 const rate = of_joint(type, random.vector(2));
    b.qd.push_back(options.moving ? rate : Vec3::zero());
    bool const free = type == JointType::free;
    if (options.loaded) b.torque.push_back(free ? Vec3::zero() : of_joint(type, random.vector(1)));
    append_drive(random, options, b);
    if (!options.springs) return;
    Vec3 const positive{{random.uniform(0, 5), random.uniform(0, 5), random.uniform(0, 5)}};
    b.stiffness.push_back(free ? Vec3::zero() : of_joint(type, positive));
    b.damping.push_back(free ? Vec3::zero() : of_joint(type, 0.1 * positive));
    Quat const rest = normalized(orientation * about_vector(random.vector(1)));
    b.rest.push_back(random_coordinates(random, type, 1, rest));
}

/// A tip joint of the options' type in an arbitrary state; a planar chain's revolute tip keeps to
/// the plane.
TipJoint random_tip(Random& random, RandomChainOptions const& options) {
    TipJoint tip;
    tip.type = *options.tip;
    bool const level = options.joints == RandomJoints::planar && tip.type == JointType::revolute &&
                       options.base == Base::fixed;
    tip.axis = level ? planar_axis : random.direction();
    tip.first_axis = first_axis(random, tip.type, tip.axis);
    tip.pitch = random.uniform(0.02, 0.2);
    tip.rotation =
        to_matrix(level ? about_axis(planar_axis, random.uniform(-3, 3)) : random.orientation());
    tip.translation = random.uniform(0.2, 0.6) * random.direction();
    tip.q = random_coordinates(random, tip.type, 3, random.orientation());
    return tip;
}
/// A link of random length from `end` to the ground.
TipJoint random_tip_link(Random& random, Vec3 const& end) {
    TipJoint tip;
    tip.type = JointType::link;
    tip.anchor = end + random.uniform(0.2, 0.6) * random.direction();
    return tip;
}
/// Velocities are made to fit the tip.
void join_to_ground(ChainSpec& chain, TipJoint const& tip, double time = 0) {
    chain.tip = Tip::jointed;
    chain.tip_joint = tip;
    oracle::project_velocities(chain, time);
}
/// The last body's joint frame stands where the first body is, but for the tip's coordinates.
void join_to_first(ChainSpec& chain, TipJoint tip, double time) {
    oracle::Loads loads;
    loads.time = time;
    auto const at = oracle::kinematics<double>(chain, loads);
    scene::Pose const moved =
        scene::joint_motion(tip.type, tip.axis, tip.first_axis, tip.pitch, tip.q);
    Mat3 const to_last = transpose(at.orientation.back());
    tip.ring = true;
    tip.rotation = to_last * (at.orientation.front() * transpose(to_matrix(moved.orientation)));
    tip.translation =
        to_last * (at.origin.front() - at.origin.back()) - tip.rotation * moved.origin;
    join_to_ground(chain, tip, time);
}
/// Where a chain on links starts: at its random anchor if the base is fixed.
Vec3 random_start(Random& random, Base base, Vec3& anchor) {
    anchor = random.vector(1);
    return base == Base::fixed ? anchor : random.vector(1);
}
ChainSpec without_bodies(char const* name, Base base) {
    ChainSpec chain;
    chain.name = name;
    chain.base = base;
    return chain;
}

}  // namespace

double Random::uniform(double low, double high) {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15U);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return low + (high - low) * (static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53);
}
Vec3 Random::vector(double size) {
    Vec3 v;
    for (int i = 0; i < 3; ++i) v[i] = uniform(-size, size);
    return v;
}
Vec3 Random::direction() {
    Vec3 v = vector(1);
    while (norm(v) > 1 || norm(v) < 0.1) v = vector(1);
    return (1 / norm(v)) * v;
}
Quat Random::orientation() { return about_axis(direction(), uniform(-3, 3)); }

RandomChainOptions options_in_turn(std::uint64_t seed, std::size_t most) {
    RandomChainOptions options;
    options.bodies = 1 + seed * 7 % most;
    options.joints = static_cast<RandomJoints>(seed % 9);
    options.base = seed / 9 % 2 ? Base::free : Base::fixed;
    options.springs = seed / 18 % 2;
    options.drag = seed / 36 % 3 == 0;
    options.driven = seed / 72 % 4 == 3 ? 0.2 : 0;
    return options;
}

ChainSpec random_chain(std::uint64_t seed, RandomChainOptions const& options) {
    Random random(seed);
    ChainSpec chain = without_bodies("random", options.base);
    BodyArrays& b = chain.bodies;
    for (std::size_t k = 0; k < options.bodies; ++k) {
        b.mass.push_back(random_mass(random));
        b.com.push_back(random.uniform(0.02, 0.3) * random.direction());
        b.inertia.push_back(random_inertia(random, b.mass.back()));
        append_joint(random, options, b);
        if (options.loaded) {
            Vec3 const torque = random.vector(1), force = random.vector(5);
            b.wrench.push_back({torque, force});
        }
    }
    if (!b.first_axis.empty()) b.first_axis.resize(options.bodies, Vec3::zero());
    if (!b.pitch.empty()) b.pitch.resize(options.bodies, 0);
    if (options.base == Base::free) {
        b.free_base.position = random.vector(1);
        b.free_base.velocity = options.moving ? random.vector(1) : Vec3::zero();
    }
    for (std::size_t k = 0; k < options.bodies && options.drag; ++k)
        b.drag.push_back({random.uniform(0, 1), random.uniform(0, 0.1)});
    if (!options.tip || options.bodies == 0) return chain;
    TipJoint const tip = random_tip(random, options);
    options.ring ? join_to_first(chain, tip, options.time)
                 : join_to_ground(chain, tip, options.time);
    return chain;
}

void add_random_loops(ChainSpec& chain, std::uint64_t seed, std::size_t count, JointType type) {
    Random random(seed);
    std::vector<scene::Pose> const poses = scene::start_poses(chain);
    auto const body = [&] {  // from the ground on
        return static_cast<std::int64_t>(random.uniform() * static_cast<double>(chain.size() + 1)) -
               1;
    };
    while (chain.loops.size() < count) {
        LoopClosure loop;
        loop.inboard = body();
        loop.outboard = body();
        if (loop.inboard == loop.outboard) continue;
        loop.joint = random_tip(random, {.tip = type});
        scene::Pose const held = scene::held_frame(poses, loop),
                          end = scene::pose_at(poses, loop.outboard);
        loop.end_rotation = to_matrix(conjugate(end.orientation) * held.orientation);
        loop.end_translation =
            transposed_times(to_matrix(end.orientation), held.origin - end.origin);
        chain.loops.push_back(loop);
    }
    chain.redundant_directions = scene::redundant_directions(chain);
    oracle::project_velocities(chain);
}

ChainSpec random_bead_chain(std::uint64_t seed, std::size_t beads, Base base, Tip tip) {
    Random random(seed);
    ChainSpec chain = without_bodies("random beads", base);
    BeadArrays& b = chain.beads;
    Vec3 position = random_start(random, base, b.anchor);
    Vec3 velocity = base == Base::fixed ? Vec3::zero() : random.vector(1);
    for (std::size_t k = 0; k < beads; ++k) {
        b.mass.push_back(random_mass(random));
        b.length.push_back(random.uniform(0.2, 0.6));
        b.residue.push_back("UNK");
        Vec3 const along = b.length.back() * random.direction(), spin = random.vector(3);
        if (k > 0 || base == Base::fixed) {
            position = position + along;
            velocity = velocity + cross(spin, along);
        }
        b.position.push_back(position);
        b.velocity.push_back(velocity);
    }
    if (tip == Tip::jointed) join_to_ground(chain, random_tip_link(random, position));
    return chain;
}

ChainSpec random_linked_chain(std::uint64_t seed, std::size_t bodies, Base base, Tip tip) {
    Random random(seed);
    ChainSpec chain = without_bodies("random linked bodies", base);
    LinkedArrays& b = chain.linked;
    Vec3 end = random_start(random, base, b.anchor);
    for (std::size_t k = 0; k < bodies; ++k) {
        bool const bead = random.chance(0.5);
        Quat const orientation = bead ? Quat::identity() : random.orientation();
        Vec3 const zero = Vec3::zero(),
                   inboard = bead ? zero : random.uniform(0.1, 0.4) * random.direction(),
                   outboard = bead ? zero : random.uniform(0.1, 0.4) * random.direction();
        b.mass.push_back(random_mass(random));
        b.inertia.push_back(bead ? Sym3::zero() : random_inertia(random, b.mass.back()));
        b.orientation.push_back(as_array(orientation));
        b.inboard.push_back(inboard);
        b.outboard.push_back(outboard);
        b.length.push_back(random.uniform(0.2, 0.6));
        if (k > 0 || base == Base::fixed) end = end + b.length.back() * random.direction();
        b.position.push_back(end - to_matrix(orientation) * inboard);
        end = b.position.back() + to_matrix(orientation) * outboard;
        b.velocity.push_back(random.vector(1));
        b.omega.push_back(bead ? zero : random.vector(3));
    }
    if (tip == Tip::jointed)
        join_to_ground(chain, random_tip_link(random, end));
    else
        oracle::project_velocities(chain);
    return chain;
}

ChainSpec closed(ChainSpec chain) {
    auto const end = [&](std::size_t k, Vec3 const& r) {
        auto const& q = chain.linked.orientation[k];
        return chain.linked.position[k] + to_matrix(Quat{q[0], q[1], q[2], q[3]}) * r;
    };
    std::size_t const last = chain.size() - 1;
    TipJoint tip;
    tip.ring = true;
    tip.type = JointType::link;
    tip.length =
        chain.is_beads()
            ? norm(chain.beads.position[0] - chain.beads.position[last])
            : norm(end(0, chain.linked.inboard[0]) - end(last, chain.linked.outboard[last]));
    join_to_ground(chain, tip);
    return chain;
}

std::vector<std::pair<Vec3, Vec3>> random_wrenches(std::uint64_t seed, std::size_t bodies) {
    Random random(seed);
    std::vector<std::pair<Vec3, Vec3>> wrenches;
    for (std::size_t k = 0; k < bodies; ++k) {
        Vec3 const torque = random.vector(1), force = random.vector(5);
        wrenches.push_back({torque, force});
    }
    return wrenches;
}

std::vector<Vec3> random_forces(std::uint64_t seed, std::size_t beads) {
    Random random(seed);
    std::vector<Vec3> forces;
    for (std::size_t k = 0; k < beads; ++k) forces.push_back(random.vector(5));
    return forces;
}

}  // namespace catena::test
