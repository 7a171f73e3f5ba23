#include "scene/bodies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "scene/fields.hpp"
#include "scene/physics.hpp"

namespace catena::scene {

namespace {

using Four = std::array<double, 4>;

JointType type_of(Node const& joint) {
    Node const* const type = joint.find("type");
    if (!type) fail(joint, "key `type` is missing", "add `type: revolute`");
    return choice<JointType>(
        *type,
        {{"free", JointType::free}, {"link", JointType::link}, {"revolute", JointType::revolute}, {"spherical", JointType::spherical}},
        {"planar", "universal", "weld", "prismatic", "helical"});
}

/// What one joint says, with the defaults of what it does not say.
struct JointEntry {
    JointType type = JointType::free;
    Vec3 axis = Vec3::zero(), translation = Vec3::zero(), qd = Vec3::zero(), velocity = Vec3::zero(), position = Vec3::zero();
    Vec3 torque = Vec3::zero(), stiffness = Vec3::zero(), damping = Vec3::zero();
    Mat3 rotation = Mat3::identity();
    Four q{0, 0, 0, 0}, rest{0, 0, 0, 0};
    bool driven = false, sprung = false, damped = false;
};

/// Refuses the keys that mean nothing for this type of joint.
void check_keys(Node const& joint, JointType type, Names allowed) {
    for (Node const& item : joint.items)
        if (std::find(allowed.begin(), allowed.end(), item.key) == allowed.end())
            fail(item, fmt::format("key `{}` means nothing for a {} joint", item.key, name_of(type)), "leave it out or correct `type`");
}

Vec3 in_first(double value) { return {{value, 0, 0}}; }

/// Stiffness or damping: a number or, for spherical joints, three.
Vec3 resistance(Node const& node, JointType type) {
    if (type == JointType::revolute) return in_first(non_negative(node));
    if (node.kind != Node::Kind::list) {
        double const all = non_negative(node);
        return {{all, all, all}};
    }
    Vec3 const v = vector3(node);
    for (double const x : v.data)
        if (!(x >= 0)) fail(node, fmt::format("{} {} is negative", node.key, x), "give 0 or numbers above it");
    return v;
}

void read_free(Fields const& joint, JointEntry& entry) {
    check_keys(joint.node(), JointType::free, {"type", "q", "qd"});
    entry.q = entry.rest = {1, 0, 0, 0};
    if (Node const* const q = joint.find("q")) {
        Fields const pose(*q, {"position", "quaternion"});
        if (Node const* const position = pose.find("position")) entry.position = vector3(*position);
        if (Node const* const quaternion = pose.find("quaternion")) entry.q = unit_quaternion(*quaternion);
    }
    if (Node const* const qd = joint.find("qd")) {
        Fields const rates(*qd, {"omega", "velocity"});
        if (Node const* const omega = rates.find("omega")) entry.qd = vector3(*omega);
        if (Node const* const velocity = rates.find("velocity")) entry.velocity = vector3(*velocity);
    }
}

void read_revolute(Fields const& joint, JointEntry& entry) {
    check_keys(joint.node(), JointType::revolute,
               {"type", "axis", "rotation", "translation", "q", "qd", "torque", "stiffness", "damping", "rest"});
    entry.axis = direction(joint.need("axis", "axis: [0, 0, 1]"));
    if (Node const* const q = joint.find("q")) entry.q = {number(*q), 0, 0, 0};
    if (Node const* const qd = joint.find("qd")) entry.qd = in_first(number(*qd));
    if (Node const* const torque = joint.find("torque")) entry.torque = in_first(number(*torque));
    if (Node const* const rest = joint.find("rest")) entry.rest = {number(*rest), 0, 0, 0};
}

void read_spherical(Fields const& joint, JointEntry& entry) {
    check_keys(joint.node(), JointType::spherical,
               {"type", "rotation", "translation", "q", "qd", "torque", "stiffness", "damping", "rest"});
    entry.q = entry.rest = {1, 0, 0, 0};
    if (Node const* const q = joint.find("q")) entry.q = unit_quaternion(*q);
    if (Node const* const qd = joint.find("qd")) entry.qd = vector3(*qd);
    if (Node const* const torque = joint.find("torque")) entry.torque = vector3(*torque);
    if (Node const* const rest = joint.find("rest")) entry.rest = unit_quaternion(*rest);
}

JointEntry read_joint(Node const& node) {
    Fields const joint(node, {"type", "axis", "rotation", "translation", "q", "qd", "torque", "stiffness", "damping", "rest", "length"},
                       {"axes", "pitch", "motion"});
    JointEntry entry;
    entry.type = type_of(node);
    if (entry.type == JointType::free) return read_free(joint, entry), entry;
    entry.type == JointType::revolute ? read_revolute(joint, entry) : read_spherical(joint, entry);
    if (Node const* const rotation_node = joint.find("rotation")) entry.rotation = rotation(*rotation_node);
    if (Node const* const translation = joint.find("translation")) entry.translation = vector3(*translation);
    if (Node const* const stiffness = joint.find("stiffness")) entry.stiffness = resistance(*stiffness, entry.type);
    if (Node const* const damping = joint.find("damping")) entry.damping = resistance(*damping, entry.type);
    entry.driven = joint.find("torque");
    entry.sprung = joint.find("stiffness") || joint.find("rest");
    entry.damped = joint.find("damping");
    return entry;
}

JointEntry joint_of(Fields const& body, std::size_t k, Base base) {
    bool const first = k == 0;
    if (first && base == Base::free && !body.find("joint")) {
        JointEntry entry;
        entry.q = entry.rest = {1, 0, 0, 0};
        return entry;
    }
    Node const& node = body.need("joint", "joint: {type: revolute, axis: [0, 0, 1]}");
    JointEntry entry = read_joint(node);
    if (entry.type == JointType::free && !first)
        fail(node, "a free joint inside a chain", "use it for body 1 of a chain with `base: free`");
    if (entry.type == JointType::free && base == Base::fixed)
        fail(node, "a free joint on a fixed base", "write `base: free`, or give joint 1 another type");
    if (entry.type != JointType::free && first && base == Base::free)
        fail(node, fmt::format("a {} joint 1 on a free base, which has no joint 1", name_of(entry.type)),
             "write `base: fixed`, or `joint: {type: free}` for body 1");
    return entry;
}

void append(BodyArrays& bodies, JointEntry const& entry) {
    bodies.joint.push_back(entry.type);
    bodies.axis.push_back(entry.axis);
    bodies.rotation.push_back(entry.rotation);
    bodies.translation.push_back(entry.translation);
    bodies.q.push_back(entry.q);
    bodies.qd.push_back(entry.qd);
    bodies.torque.push_back(entry.torque);
    bodies.stiffness.push_back(entry.stiffness);
    bodies.damping.push_back(entry.damping);
    bodies.rest.push_back(entry.rest);
    if (entry.type == JointType::free) {
        bodies.free_position = entry.position;
        bodies.free_velocity = entry.velocity;
    }
}

/// Which of the arrays that may stay empty are needed.
struct Needed {
    bool torque = false, spring = false, damping = false, wrench = false;
    void drop_rest(BodyArrays& bodies) const {
        if (!torque) bodies.torque = {};
        if (!spring) bodies.stiffness = {}, bodies.rest = {};
        if (!damping) bodies.damping = {};
        if (!wrench) bodies.wrench = {};
    }
};

bool is_link(Node const& body) {
    Node const* const joint = body.find("joint");
    Node const* const type = joint ? joint->find("type") : nullptr;
    return type && type->text == "link";
}

}  // namespace

bool describes_beads(Node const& bodies) {
    if (list(bodies).items.empty()) fail(bodies, "the list of bodies is empty", "give at least one body");
    bool links = false, others = false;
    for (Node const& body : bodies.items) {
        bool const link = is_link(body);
        links = links || link;
        others = others || (!link && body.find("joint"));
    }
    if (links && others) fail_later(bodies, "links and other joints in one chain");
    return links;
}

BodyArrays read_bodies(Node const& node, Base base) {
    BodyArrays bodies;
    Needed needed;
    for (std::size_t k = 0; k < node.items.size(); ++k) {
        Fields const body(node.items[k], {"mass", "com", "inertia", "joint", "wrench"}, {"beads", "drag"});
        bodies.mass.push_back(positive(body.need("mass", "mass: 1.0")));
        Node const* const com = body.find("com");
        bodies.com.push_back(com ? vector3(*com) : Vec3::zero());
        bodies.inertia.push_back(inertia(body.need("inertia", "inertia: [[1, 0, 0], [0, 1, 0], [0, 0, 1]]")));
        JointEntry const entry = joint_of(body, k, base);
        append(bodies, entry);
        std::pair<Vec3, Vec3> load{Vec3::zero(), Vec3::zero()};
        if (Node const* const wrench = body.find("wrench")) {
            Fields const parts(*wrench, {"torque", "force"});
            if (Node const* const torque = parts.find("torque")) load.first = vector3(*torque);
            if (Node const* const force = parts.find("force")) load.second = vector3(*force);
            needed.wrench = true;
        }
        bodies.wrench.push_back(load);
        needed.torque = needed.torque || entry.driven;
        needed.spring = needed.spring || entry.sprung;
        needed.damping = needed.damping || entry.damped;
    }
    needed.drop_rest(bodies);
    return bodies;
}

ExplicitBeads read_beads(Node const& node, Base base) {
    ExplicitBeads made;
    for (std::size_t k = 0; k < node.items.size(); ++k) {
        Node const& item = node.items[k];
        for (char const* const key : {"com", "inertia", "wrench"})
            if (Node const* const extra = item.find(key))
                fail(*extra, fmt::format("key `{}` means nothing for a point bead on a link", key), "leave it out or change `joint`");
        Fields const body(item, {"mass", "position", "velocity", "residue", "joint"});
        made.beads.mass.push_back(positive(body.need("mass", "mass: 1.0")));
        made.beads.position.push_back(vector3(body.need("position", "position: [0, 0, 0]")));
        Node const* const velocity = body.find("velocity");
        made.velocities = made.velocities || velocity;
        made.beads.velocity.push_back(velocity ? vector3(*velocity) : Vec3::zero());
        Node const* const residue = body.find("residue");
        made.beads.residue.push_back(residue ? text(*residue) : "UNK");
        double length = std::numeric_limits<double>::quiet_NaN();
        Node const* const joint_node = k == 0 ? body.find("joint") : &body.need("joint", "joint: {type: link}");
        if (joint_node) {
            Fields const joint(*joint_node, {"type", "length"}, {"motion"});
            Node const* const given = joint.find("length");
            if (given && k == 0 && base == Base::free)
                fail(*given, "a link length for bead 1 of a free base, which has no link", "leave it out or write `base: fixed`");
            if (given) length = positive(*given);
        }
        made.beads.length.push_back(length);
    }
    return made;
}

}  // namespace catena::scene
