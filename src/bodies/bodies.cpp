// Implements the YAML readers of rigid bodies and point beads.
#include "bodies/bodies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "bodies/carried_beads.hpp"
#include "bodies/joint_entry.hpp"
#include "bodies/physics.hpp"
#include "joints/joint_models.hpp"
#include "keys/maps.hpp"
#include "scene/branches.hpp"
#include "scene/fields.hpp"
#include "terms/force_terms.hpp"

namespace catena::scene {

namespace {

/// Reads the joint of body k (from 0). Body 1 of a free base needs no joint and gets a free one.
/// Throws InputError for a free joint in any other place.
JointEntry joint_of(Fields const& body, std::size_t k, Base base) {
    bool const first = k == 0;
    if (first && base == Base::free && !body.find("joint")) {
        JointEntry entry;
        entry.q = entry.rest = {1, 0, 0, 0};
        return entry;
    }
    Node const& node = body.need("joint", "joint: {type: revolute, axis: [0, 0, 1]}");
    JointEntry entry = read_joint(node);
    if (floats(entry.type) && !first)
        fail(node, "a free joint inside a chain", "use it for body 1 of a chain with `base: free`");
    if (floats(entry.type) && base == Base::fixed)
        fail(node, "a free joint on a fixed base",
             "write `base: free`, or give joint 1 another type");
    if (!floats(entry.type) && first && base == Base::free)
        fail(node,
             fmt::format("a {} joint 1 on a free base, which has no joint 1", name_of(entry.type)),
             "write `base: fixed`, or `joint: {type: free}` for body 1");
    return entry;
}

/// Appends the joint to the arrays; all optional arrays are filled and reduced later by Needed.
void append(BodyArrays& bodies, JointEntry const& entry) {
    bodies.joint.push_back(entry.type);
    bodies.axis.push_back(entry.axis);
    bodies.first_axis.push_back(entry.first_axis);
    bodies.pitch.push_back(entry.pitch);
    bodies.rotation.push_back(entry.rotation);
    bodies.translation.push_back(entry.translation);
    bodies.q.push_back(entry.q);
    bodies.qd.push_back(entry.qd);
    bodies.torque.push_back(entry.torque);
    bodies.stiffness.push_back(entry.stiffness);
    bodies.damping.push_back(entry.damping);
    bodies.rest.push_back(entry.rest);
    if (floats(entry.type)) {
        bodies.free_base.position = entry.position;
        bodies.free_base.velocity = entry.velocity;
    }
    if (entry.motion.empty()) return;
    DrivenJoint driven;
    driven.body = static_cast<std::int64_t>(bodies.joint.size()) - 1;
    std::copy(entry.motion.begin(), entry.motion.end(), driven.course.begin());
    bodies.driven.push_back(driven);
}

/// Records which of the optional arrays are needed, and empties the others.
struct Needed {
    bool torque = false, spring = false, damping = false, first_axis = false, pitch = false;

    /// Marks the arrays that this joint needs.
    void take(JointEntry const& joint) {
        torque = torque || joint.loaded;
        spring = spring || joint.sprung;
        damping = damping || joint.damped;
        first_axis = first_axis || has_two_axes(joint.type);
        pitch = pitch || has_pitch(joint.type);
    }
    /// Clears all arrays that no body needs; an empty array means zero.
    void drop_rest(BodyArrays& bodies) const {
        if (!torque) bodies.torque = {};
        if (!spring) bodies.stiffness = {}, bodies.rest = {};
        if (!damping) bodies.damping = {};
        if (!first_axis) bodies.first_axis = {};
        if (!pitch) bodies.pitch = {};
    }
};

/// Throws InputError for rigid bodies on links that have the key `parent`.
void refuse_parents(Node const& bodies) {
    for (Node const& body : bodies.items)
        if (Node const* const parent = body.find("parent"))
            fail(*parent, "a branched chain that has rigid bodies on links",
                 "leave `parent` out, make it of point beads on links, or give every joint another "
                 "type");
}

/// Words for the members of a chain in messages.
struct Words {
    char const *one, *several;
};
constexpr Words of_beads{"bead", "beads"}, of_bodies{"body", "bodies"};

/// Reads the number of the member on which member k (from 0) of `count` hangs, of any sign and
/// size.
std::int64_t read_number(Node const& node, std::int64_t k, std::int64_t count, Words const& are) {
    double value = 0;
    if (node.kind == Node::Kind::scalar && !node.quoted &&
        parse_number(node.text, value) == NumberFault::none && value > 0x1p53)
        fail(node, fmt::format("{0} {1} hangs on {0} {2} of {3}", are.one, k + 1, node.text, count),
             fmt::format("count the {} of this chain from 1", are.several));
    return whole(node, std::numeric_limits<std::int64_t>::min());
}

/// Throws InputError unless `parent` is the number of a member before member k (from 0) of `count`.
void check_parent(Node const& node, std::int64_t parent, std::int64_t k, std::int64_t count,
                  Words const& are) {
    std::string const hangs = fmt::format("{} {} hangs on ", are.one, k + 1),
                      earlier = fmt::format("the number of an earlier {}", are.one);
    if (k > 0 && parent == 0)
        fail(node, fmt::format("{}none, as {} 1 does: two trees", hangs, are.one),
             fmt::format("give it {}, or write a chain of its own", earlier));
    if (parent < 0)
        fail(node, fmt::format("{}{} {}", hangs, are.one, parent),
             k == 1 ? "give 1" : fmt::format("give {}, 1 to {}", earlier, k));
    if (parent == k + 1)
        fail(node, fmt::format("{} {} hangs on itself", are.one, parent),
             fmt::format("give it {}", earlier));
    if (parent > count)
        fail(node, fmt::format("{}{} {} of {}", hangs, are.one, parent, count),
             fmt::format("count the {} of this chain from 1", are.several));
    if (parent > k)
        fail(node, fmt::format("{}{} {}, which follows it", hangs, are.one, parent),
             fmt::format("list each {} after the one it hangs on", are.one));
}

/// Reads the member on which member k (from 0) of `count` hangs; -1 for the first one.
std::int64_t read_parent(Fields const& member, std::int64_t k, std::int64_t count,
                         Words const& are) {
    Node const* const node = member.find("parent");
    if (!node) return k - 1;
    std::int64_t const parent = read_number(*node, k, count, are);
    if (k == 0 && parent != 0)
        fail(
            *node,
            fmt::format("{0} 1 hangs on {0} {1}, but the first {0} hangs on none", are.one, parent),
            fmt::format("leave `parent` out here, and begin the list with the {} that hangs on "
                        "none",
                        are.one));
    check_parent(*node, parent, k, count, are);
    return parent - 1;
}

/// Returns the node of the joint's type, or nullptr.
Node const* type_node_of(Node const& body) {
    Node const* const joint = body.find("joint");
    return joint ? joint->find("type") : nullptr;
}

}  // namespace

BodyList kind_of_list(Node const& bodies) {
    if (list(bodies).items.empty())
        fail(bodies, "the list of bodies is empty", "give at least one body");
    Node const* other = nullptr;
    bool links = false, rigid = false;
    for (Node const& body : bodies.items) {
        Node const* const type = type_node_of(body);
        bool const link = type && type->text == "link";
        links = links || link;
        rigid = rigid || body.find("inertia");
        if (!link && !other) other = body.find("joint");
    }
    // A chain is stored in absolute coordinates (links) or in joint coordinates (all other joints).
    if (links && other) {
        Node const* const type = other->find("type");
        fail(*other,
             fmt::format("a joint {}in a chain of links",
                         type ? fmt::format("of type `{}` ", shown(type->text)) : ""),
             "make it a link, or give every joint another type");
    }
    Node const& first = bodies.items[0];
    // A single point without links, such as an ion, is a chain of one bead.
    bool const lone_bead =
        bodies.items.size() == 1 && !rigid && !first.find("joint") && first.find("position");
    if (rigid && links) refuse_parents(bodies);
    if (!links) return lone_bead ? BodyList::beads : BodyList::bodies;
    return rigid ? BodyList::linked : BodyList::beads;
}

// The arrays have one entry per body at first, also those that are usually empty.
ExplicitBodies read_bodies(Node const& node, Base base) {
    ExplicitBodies made;
    BodyArrays& bodies = made.bodies;
    Needed needed;
    CarriedList carried;
    std::vector<std::int64_t> inboard;
    for (std::size_t k = 0; k < node.items.size(); ++k) {
        Fields const body(node.items[k], keys::body);
        inboard.push_back(read_parent(body, static_cast<std::int64_t>(k),
                                      static_cast<std::int64_t>(node.items.size()), of_bodies));
        bodies.mass.push_back(positive(body.need("mass", "mass: 1.0")));
        Node const* const com = body.find("com");
        bodies.com.push_back(com ? vector3(*com) : Vec3::zero());
        bodies.inertia.push_back(
            inertia(body.need("inertia", "inertia: [[1, 0, 0], [0, 1, 0], [0, 0, 1]]")));
        JointEntry const entry = joint_of(body, k, base);
        append(bodies, entry);
        if (entry.planar && !made.planar) made.planar = body.find("joint");
        needed.take(entry);
        carried.add(body.find("beads"));
    }
    needed.drop_rest(bodies);
    bodies.carried = carried.take();
    made.parent = as_parents(std::move(inboard));
    return made;
}

ExplicitBeads read_beads(Node const& node, Base base) {
    ExplicitBeads made;
    std::vector<std::int64_t> inboard;
    for (std::size_t k = 0; k < node.items.size(); ++k) {
        Node const& item = node.items[k];
        for (char const* const key : terms::keys_beside({"com", "inertia"}, {"beads"}))
            if (Node const* const extra = item.find(key))
                fail(*extra, fmt::format("key `{}` does not apply to a point bead on a link", key),
                     "leave it out or change `joint`");
        Fields const body(item, keys::bead);
        inboard.push_back(read_parent(body, static_cast<std::int64_t>(k),
                                      static_cast<std::int64_t>(node.items.size()), of_beads));
        made.beads.mass.push_back(positive(body.need("mass", "mass: 1.0")));
        made.beads.position.push_back(vector3(body.need("position", "position: [0, 0, 0]")));
        Node const* const velocity = body.find("velocity");
        made.velocities = made.velocities || velocity;
        made.beads.velocity.push_back(velocity ? vector3(*velocity) : Vec3::zero());
        Node const* const residue = body.find("residue");
        made.beads.residue.push_back(residue ? text(*residue) : "UNK");
        double length = std::numeric_limits<double>::quiet_NaN();
        Node const* const joint_node =
            k == 0 ? body.find("joint") : &body.need("joint", "joint: {type: link}");
        // Bead 1 of a free base has no link and thus no length.
        if (joint_node) {
            Fields const joint(*joint_node, keys::bead_link);
            Node const* const given = joint.find("length");
            if (given && k == 0 && base == Base::free)
                fail(*given, "a link length for bead 1 of a free base, which has no link",
                     "leave it out or write `base: fixed`");
            if (given) length = positive(*given);
        }
        made.beads.length.push_back(length);
    }
    made.parent = as_parents(std::move(inboard));
    return made;
}

}  // namespace catena::scene
