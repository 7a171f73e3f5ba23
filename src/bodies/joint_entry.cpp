// Implements the readers of joints of bodies and tips.
#include "bodies/joint_entry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "bodies/physics.hpp"
#include "joints/joint_models.hpp"
#include "keys/maps.hpp"
#include "scene/freedom.hpp"
#include "scene/pose.hpp"

namespace catena::scene {

namespace {

using Four = std::array<double, 4>;

/// Joint type with its spelling.
struct TypeName {
    JointType type;
    bool planar = false;
};

/// Reads the type. `planar` is a revolute joint with a promise, see JointEntry.
TypeName type_of(Node const& joint) {
    Node const* const type = joint.find("type");
    if (!type) fail(joint, "key `type` is missing", "add `type: revolute`");
    std::optional<TypeName> found;
    std::vector<std::string_view> names;
    auto const offer = [&](std::string_view name, TypeName const& meant) {
        if (type->kind == Node::Kind::scalar && type->text == name) found = meant;
        names.push_back(name);
    };
    for_each_joint([&](auto model) {
        using Model = decltype(model);
        offer(Model::name, {Model::type});
        if constexpr (Model::name_in_plane) offer(Model::name_in_plane, {Model::type, true});
    });
    if (!found) refuse_choice(*type, names, {});
    return *found;
}

/// Refuses the keys without meaning for this type of joint.
void check_keys(Node const& joint, JointType type, std::vector<std::string_view> const& allowed) {
    for (Node const& item : joint.items)
        if (std::find(allowed.begin(), allowed.end(), item.key) == allowed.end())
            fail(item,
                 fmt::format("key `{}` does not apply to a {} joint", item.key, name_of(type)),
                 item.key == "axes" && type == JointType::revolute
                     ? "leave it out, or write `type: planar3` for two translations and a rotation"
                     : "leave it out or correct `type`");
}

/// Refuses a `length`, which only links have.
void refuse_length(Node const& joint) {
    if (Node const* const length = joint.find("length"))
        fail(*length,
             fmt::format("key `length` does not apply to a {} joint", name_of(type_of(joint).type)),
             "leave it out or correct `type`");
}

/// Keys of the joint's axes and frame.
std::vector<std::string_view> geometry_keys(JointType type) {
    std::vector<std::string_view> keys{"type", "rotation", "translation"};
    if (has_two_axes(type)) keys.emplace_back("axes");
    if (has_one_axis(type)) keys.emplace_back("axis");
    if (has_pitch(type)) keys.emplace_back("pitch");
    return keys;
}

/// All keys of a joint of a body.
std::vector<std::string_view> joint_keys(JointType type) {
    if (floats(type)) return {"type", "q", "qd"};
    std::vector<std::string_view> keys = geometry_keys(type);
    if (is_rigid(type)) return keys;
    for (char const* const key : {"q", "qd", "torque", "stiffness", "damping", "rest"})
        keys.emplace_back(key);
    if (numbers_of(type) <= 2) keys.emplace_back("motion");
    return keys;
}

/// Reads a list of `count` numbers; the other components are zero.
Vec3 several(Node const& node, int count) {
    std::vector<double> const values = numbers(node, static_cast<std::size_t>(count));
    Vec3 v = Vec3::zero();
    for (int i = 0; i < count; ++i) v[i] = values[static_cast<std::size_t>(i)];
    return v;
}

/// Reads the joint's numbers. For several coordinates with `alike` set, one number applies to all,
/// unless they have different units.
Vec3 components(Node const& node, JointType type, bool alike) {
    int const count = numbers_of(type);
    Vec3 v = Vec3::zero();
    bool const one = alike && !mixes_units(type) && node.kind != Node::Kind::list;
    if (count > 1 && !one) return several(node, count);
    double const value = number(node);
    for (int i = 0; i < count; ++i) v[i] = value;
    return v;
}

/// Reads a stiffness or damping and refuses negative numbers.
Vec3 resistance(Node const& node, JointType type) {
    Vec3 const v = components(node, type, true);
    for (double const x : v.data)
        if (!(x >= 0))
            fail(node, fmt::format("{} {} is negative", node.key, x),
                 node.kind == Node::Kind::list ? "give 0 or positive numbers"
                                               : "give 0 or a positive number");
    return v;
}

/// Reads q or rest in the format of BodyArrays::q.
Four position(Node const& node, JointType type, bool alike) {
    if (has_quaternion(type)) return unit_quaternion(node);
    Vec3 const v = components(node, type, alike);
    Four const q{v[0], v[1], v[2], 0};
    if (auto const fault = check_range(q)) fail(node, fault->what, fault->remedy);
    return q;
}

/// Reads pose and rates of a free joint: position and velocity in W, omega in B.
void read_free(Fields const& joint, JointEntry& entry) {
    entry.q = entry.rest = {1, 0, 0, 0};
    if (Node const* const q = joint.find("q")) {
        Fields const pose(*q, keys::free_pose);
        if (Node const* const position = pose.find("position")) entry.position = vector3(*position);
        if (Node const* const quaternion = pose.find("quaternion"))
            entry.q = unit_quaternion(*quaternion);
    }
    if (Node const* const qd = joint.find("qd")) {
        Fields const rates(*qd, keys::free_rates);
        if (Node const* const omega = rates.find("omega")) entry.qd = vector3(*omega);
        if (Node const* const velocity = rates.find("velocity"))
            entry.velocity = vector3(*velocity);
    }
}

/// Reads axes, pitch and joint frame into a JointEntry or a TipJoint.
template <class Entry>
void read_geometry(Fields const& joint, Entry& entry) {
    if (has_two_axes(entry.type)) {
        Node const& axes = joint.need("axes", "axes: [[1, 0, 0], [0, 1, 0]]");
        if (axes.kind != Node::Kind::list || axes.items.size() != 2)
            fail(axes, describe(axes) + " is not two axes",
                 glides(entry.type)
                     ? "give a direction in the plane, then its normal"
                     : "give the first in the joint frame, the second in the body's frame");
        entry.first_axis = direction(axes.items[0]);
        entry.axis = direction(axes.items[1]);
        if (auto const fault = check_axes(entry.type, entry.first_axis, entry.axis))
            fail(axes, fault->what, fault->remedy);
    }
    if (has_one_axis(entry.type)) entry.axis = direction(joint.need("axis", "axis: [0, 0, 1]"));
    if (has_pitch(entry.type)) {
        Node const& pitch = joint.need("pitch", "pitch: 0.1");
        entry.pitch = number(pitch);
        if (entry.pitch == 0)
            fail(pitch, "a helical joint without pitch",
                 "give its shift per radian, or use a revolute joint");
    }
    if (Node const* const rotation_node = joint.find("rotation"))
        entry.rotation = rotation(*rotation_node);
    if (Node const* const translation = joint.find("translation"))
        entry.translation = vector3(*translation);
}

/// Reads one prescribed coordinate.
PrescribedMotion read_course(Node const& node) {
    Fields const fields(node, keys::motion);
    if (node.items.empty())
        fail(node, "the motion has no parameters",
             "add one of `offset`, `rate`, `amplitude`, `frequency`, `phase`, or use a weld");
    PrescribedMotion course;
    auto const take = [&](char const* key, double& value) {
        if (Node const* const given = fields.find(key)) value = number(*given);
    };
    take("offset", course.offset), take("rate", course.rate), take("amplitude", course.amplitude);
    take("frequency", course.frequency), take("phase", course.phase);
    return course;
}

/// Reads prescribed motions, one per coordinate, and sets q and qd to their values at time 0.
void read_motion(Fields const& joint, Node const& motion, JointEntry& entry) {
    for (char const* const key : {"q", "qd", "torque", "stiffness", "damping", "rest"})
        if (Node const* const other = joint.find(key))
            fail(*other, fmt::format("key `{}` of a joint whose `motion` is prescribed", key),
                 "keep one of them");
    if (numbers_of(entry.type) == 2) {
        if (motion.kind != Node::Kind::list || motion.items.size() != 2)
            fail(motion, describe(motion) + " is not two motions",
                 "give a list of two maps, one per axis");
        for (Node const& item : motion.items) entry.motion.push_back(read_course(item));
    } else {
        entry.motion.push_back(read_course(motion));
    }
    // The motion decides position and rate, also those of the start.
    for (std::size_t i = 0; i < entry.motion.size(); ++i) {
        entry.q[i] = value_at(entry.motion[i], 0);
        entry.qd[static_cast<int>(i)] = rate_at(entry.motion[i], 0);
    }
    if (auto const fault = check_range(entry.q)) fail(motion, fault->what, fault->remedy);
}

/// Reads position, rates, torque, spring and damper.
void read_state(Fields const& joint, JointEntry& entry) {
    JointType const type = entry.type;
    entry.q = entry.rest = rest_position(type);
    if (Node const* const q = joint.find("q")) entry.q = position(*q, type, false);
    if (Node const* const rest = joint.find("rest")) entry.rest = position(*rest, type, true);
    if (Node const* const qd = joint.find("qd")) entry.qd = components(*qd, type, false);
    if (Node const* const torque = joint.find("torque"))
        entry.torque = components(*torque, type, turns_twice(type));
    Node const* const stiffness = joint.find("stiffness");
    if (stiffness != nullptr) entry.stiffness = resistance(*stiffness, type);
    if (Node const* const rest = joint.find("rest"); rest != nullptr && stiffness == nullptr)
        fail(*rest, "`rest` of a joint without `stiffness`, which has no spring",
             "give the spring's `stiffness`, or leave `rest` out");
    if (Node const* const damping = joint.find("damping"))
        entry.damping = resistance(*damping, type);
    entry.loaded = joint.find("torque");
    entry.sprung = stiffness != nullptr;
    entry.damped = joint.find("damping");
}

}  // namespace

int numbers_of(JointType type) { return numbers_of_joint(type); }

std::optional<Fault> check_range(std::array<double, 4> const& q) {
    for (double const x : q)
        if (std::abs(x) > farthest_coordinate)
            return Fault{fmt::format("a joint's position of {:.6g} is beyond the range of "
                                     "coordinates",
                                     x),
                         fmt::format("correct it: the largest is {:g}", farthest_coordinate)};
    return std::nullopt;
}

std::optional<Fault> check_axes(JointType type, Vec3& first, Vec3 const& axis) {
    return glides(type) ? check_plane(first, axis) : check_two_axes(first, axis);
}

// The joint's type decides which keys have a meaning.
JointEntry read_joint(Node const& node) {
    refuse_length(node);
    Fields const joint(node, keys::joint);
    JointEntry entry;
    auto const [type, planar] = type_of(node);
    entry.type = type;
    entry.planar = planar;
    check_keys(node, type, joint_keys(type));
    if (floats(type)) return read_free(joint, entry), entry;
    read_geometry(joint, entry);
    if (Node const* const motion = joint.find("motion"))
        read_motion(joint, *motion, entry);
    else
        read_state(joint, entry);
    return entry;
}

TipJoint read_loop_joint(Node const& node) {
    Fields const joint(node, keys::loop_joint);
    TipJoint entry;
    auto const [type, planar] = type_of(node);
    Node const& written = *node.find("type");
    if (planar) fail(written, "a planar joint in `loops`", "write `type: revolute`");
    if (floats(type)) fail(written, "a free joint closes no loop", "leave this loop out");
    if (is_rod(type))
        fail(written, "a link closes no loop of rigid bodies",
             "use another type, such as spherical, on a body for the rod");
    entry.type = type;
    std::vector<std::string_view> keys = geometry_keys(type);
    if (!is_rigid(type)) keys.emplace_back("q");
    check_keys(node, type, keys);
    read_geometry(joint, entry);
    entry.q = rest_position(type);
    if (Node const* const q = joint.find("q")) entry.q = position(*q, type, false);
    return entry;
}

// Links and joints with axes have different keys; both may have an anchor unless they close a ring.
TipEntry read_tip_joint(Node const& node, bool ring) {
    for (char const* const key : {"anchor", "q"})
        if (Node const* const given = ring ? node.find(key) : nullptr)
            fail(*given,
                 fmt::format("key `{}` does not apply to the joint that closes a ring", key),
                 "leave it out: the bodies define it");
    Fields const joint(node, ring ? keys::tip_ring : keys::tip_joint);
    TipEntry entry;
    auto const [type, planar] = type_of(node);
    entry.joint.ring = ring;
    entry.joint.type = type;
    entry.planar = planar;
    if (floats(type))
        fail(*node.find("type"), "a free joint at the tip restricts nothing", "write `tip: free`");
    std::vector<std::string_view> keys =
        is_rod(type) ? std::vector<std::string_view>{"type", "length", "translation"}
                     : geometry_keys(type);
    keys.emplace_back("anchor");
    if (!is_rod(type) && !is_rigid(type)) keys.emplace_back("q");
    check_keys(node, type, keys);
    if (is_rod(type)) {
        if (!ring) entry.joint.anchor = vector3(joint.need("anchor", "anchor: [0, 0, 1]"));
        if (Node const* const length = joint.find("length")) entry.joint.length = positive(*length);
        if (Node const* const translation = joint.find("translation"))
            entry.joint.translation = vector3(*translation);
        return entry;
    }
    if (ring)
        joint.need("translation",
                   "translation: [1, 0, 0], where the first body's origin is in the last body");
    read_geometry(joint, entry.joint);
    entry.joint.q = rest_position(type);
    if (ring) return entry;
    if (Node const* const q = joint.find("q")) entry.joint.q = position(*q, type, false);
    if (Node const* const anchor = joint.find("anchor")) entry.joint.anchor = vector3(*anchor);
    return entry;
}

}  // namespace catena::scene
