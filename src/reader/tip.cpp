// Implements the tips of chains and the closure of their joints at the start. A link of a chain of
// beads is closed by a least change of positions. Other joints are left to the run's constraint
// projection if they are nearly closed.
#include "reader/tip.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "bodies/joint_entry.hpp"
#include "bodies/ring.hpp"
#include "generate/cells.hpp"
#include "generate/start_fit.hpp"
#include "joints/joint_models.hpp"
#include "keys/maps.hpp"
#include "scene/freedom.hpp"
#include "scene/pose.hpp"

namespace catena::scene {

namespace {

/// Checks that the tip's joint to the ground is closed at its anchor, if one is given.
void close_joint(ChainSpec const& chain, Node const& node, Scene& scene) {
    TipJoint const& tip = chain.tip_joint;
    if (!tip.anchor) return;
    Reach const reach = reach_of(chain.bodies);
    Pose const frame{to_quaternion(tip.rotation), tip.translation};
    Pose const end =
        reach.end * frame * joint_motion(tip.type, tip.axis, tip.first_axis, tip.pitch, tip.q);
    double const error = norm(end.origin - *tip.anchor),
                 along = reach.length + norm(end.origin - reach.end.origin);
    // A chain of zero reach is measured in absolute lengths.
    double const length = along > 0 ? along : 1;
    if (error <= closure_tolerance * length) return;
    std::string const what = fmt::format(
        "the tip's joint is open at the start: its origin is at [{:.9g}, {:.9g}, {:.9g}], {:.3g} "
        "from the "
        "anchor",
        end.origin[0], end.origin[1], end.origin[2], error);
    if (error <= closable * length)
        return scene.note(what + ": the smallest change of the joints closes it");
    fail(node, what,
         fmt::format("move the chain or the anchor to within {:.3g}, or leave `anchor` out",
                     closable * length));
}

/// Position in W of the point `r` given from the centre of mass of body k, in its axes.
Vec3 point_of(LinkedArrays const& linked, std::size_t k, Vec3 const& r) {
    auto const& q = linked.orientation[k];
    return linked.position[k] + to_matrix(Quat{q[0], q[1], q[2], q[3]}) * r;
}

/// Start of the tip's link, W. `given` is true if the scene gives that point in the last body.
Vec3 start_of_link(ChainSpec& chain, bool given) {
    if (chain.is_beads()) return chain.beads.position.back();
    LinkedArrays& linked = chain.linked;
    std::size_t const last = linked.size() - 1;
    if (given) linked.outboard[last] = chain.tip_joint.translation + linked.inboard[last];
    return point_of(linked, last, linked.outboard[last]);
}
/// End of the tip's link, W: the anchor or the first body of a ring.
Vec3 end_of_link(ChainSpec const& chain) {
    if (!chain.tip_joint.ring) return *chain.tip_joint.anchor;
    return chain.is_beads() ? chain.beads.position.front()
                            : point_of(chain.linked, 0, chain.linked.inboard.front());
}

/// Length of the longest link of the chain.
double longest_link(ChainSpec const& chain) {
    std::vector<double> const& lengths =
        chain.is_beads() ? chain.beads.length : chain.linked.length;
    return lengths.empty() ? 0 : *std::max_element(lengths.begin(), lengths.end());
}

/// Returns the whole edges of the periodic box by which `link` is cut, or zero. A link is cut if
/// its nearest image fits `length` better. Without a length (0) that image must be shorter and not
/// longer than 1.5 times the chain's longest link.
Vec3 cut_by(Vec3 const& link, double length, double longest, std::optional<Vec3> const& box) {
    if (!box) return Vec3::zero();
    Images const images(*box);
    Vec3 const image = images.shortest(link);
    bool const nearer =
        std::abs(norm(image) - length) < (1 - closure_tolerance) * std::abs(norm(link) - length);
    if (!nearer || (length == 0 && norm(image) > most_usual * longest)) return Vec3::zero();
    return images.whole_edges(link);
}

/// Moves the tip's anchor to the image at which its link is not cut. Throws InputError for a ring
/// that ends at an image of its first body, because no first body exists there.
void make_tip_whole(ChainSpec& chain, Vec3 const& start, Node const& node,
                    ChainRequest const& request) {
    TipJoint& tip = chain.tip_joint;
    Vec3 const link = end_of_link(chain) - start;
    Vec3 const by = cut_by(link, tip.length, longest_link(chain), request.scene.box);
    if (dot(by, by) == 0) return;
    if (tip.ring)
        fail(node,
             fmt::format("the ring winds through the periodic box: its last body is {:.4g} from "
                         "the first and {:.4g} from an image of it",
                         norm(link), norm(link - by)),
             "give positions of a ring that closes on itself, or the closing link's `length`, or "
             "leave `ring` out");
    *tip.anchor = *tip.anchor - by;
    request.scene.note(fmt::format(
        "the link to the anchor at the tip of chain `{}` is cut by the sides of the periodic box: "
        "the nearest image of the anchor is used, [{:.6g}, {:.6g}, {:.6g}]",
        shown(request.name()), (*tip.anchor)[0], (*tip.anchor)[1], (*tip.anchor)[2]));
}

/// Sets the length of the tip's link and closes it, see join_tip().
void close_link(ChainSpec& chain, Node const& node, ChainRequest const& request) {
    TipJoint& tip = chain.tip_joint;
    Vec3 const start = start_of_link(chain, node.find("translation"));
    make_tip_whole(chain, start, node, request);
    Vec3 const end = end_of_link(chain);
    double const distance = norm(end - start);
    char const* const target = tip.ring ? "first body" : "anchor";
    // Positions are rounded to half a unit in their last place.
    if (!(distance > 16 * std::numeric_limits<double>::epsilon() * (norm(start) + norm(end))))
        fail(node,
             fmt::format("the tip's {} coincides with the last body: their link has no direction",
                         target),
             "move one of them");
    if (tip.length == 0) tip.length = distance;
    if (std::abs(tip.length - distance) <= closure_tolerance * tip.length) return;
    if (chain.is_beads() && std::abs(tip.length - distance) <= largest_link_change * tip.length) {
        StartFit fit(request.scene, node, "leave `length` out, or give other positions");
        fit.close({request.name(), chain.beads, chain.base, {}, &tip}, distance);
        return fit.note();
    }
    bool const far = distance > tip.length;
    fail(node,
         fmt::format(
             "the tip's link of length {:.12g} {} its {}: they are {:.12g} apart at the start",
             tip.length, far ? "cannot reach" : "is longer than from the last body to", target,
             distance),
         fmt::format("leave `length` out, or move {}the chain", tip.ring ? "" : "the anchor or "));
}

/// Ends of the links, or origins of the joints, from ground to ground, W.
std::vector<Vec3> points_of_bridge(ChainSpec const& chain) {
    std::vector<Vec3> points;
    if (chain.is_beads()) {
        points.push_back(chain.beads.anchor);
        points.insert(points.end(), chain.beads.position.begin(), chain.beads.position.end());
        points.push_back(*chain.tip_joint.anchor);
        return points;
    }
    Pose pose;
    for (std::size_t k = 0; k < chain.bodies.size(); ++k) {
        pose = next_pose(chain.bodies, k, pose);
        points.push_back(pose.origin);
    }
    points.push_back((pose * Pose{Quat::identity(), chain.tip_joint.translation}).origin);
    return points;
}

/// Throws InputError for a straight bridge. If all handle vectors of links or spherical joints are
/// parallel, its matrix is singular.
void refuse_straight_bridge(ChainSpec const& chain, Node const& node) {
    auto const& joints = chain.bodies.joint;
    bool const spherical = is_ball(chain.tip_joint.type) && !joints.empty() &&
                           std::all_of(joints.begin(), joints.end(), is_ball);
    if (chain.base != Base::fixed || !(chain.is_beads() || spherical)) return;
    std::vector<Vec3> const points = points_of_bridge(chain);
    // The test needs two handle vectors.
    if (points.size() < 3) return;  // one rod between two spherical joints still rotates
    Vec3 const first = points[1] - points[0];
    for (std::size_t k = 1; k + 1 < points.size(); ++k) {
        Vec3 const next = points[k + 1] - points[k];
        if (norm(cross(first, next)) > 1e-7 * norm(first) * norm(next)) return;
    }
    fail(node,
         "the bridge from ground to ground is straight: the forces in its joints are indeterminate",
         "start from a bent chain");
}

/// Name of the kind of chain for messages.
char const* kind_of(ChainSpec const& chain) {
    return chain.is_beads() ? "a chain of beads" : "a chain of links";
}

/// Throws InputError if the tip restricts more directions than the chain has degrees of freedom.
/// The tip's forces would be undetermined.
void refuse_too_many(ChainSpec const& chain, Node const& node) {
    std::int64_t const with = degrees_of_freedom(chain);
    if (with >= 0) return;
    // A copy of the chain with a free tip gives its own degrees of freedom.
    ChainSpec open;
    open.base = chain.base, open.bodies.joint = chain.bodies.joint,
    open.bodies.driven = chain.bodies.driven;
    std::int64_t const free = degrees_of_freedom(open), restricted = free - with;
    fail(node,
         fmt::format("the tip's joint restricts {} directions, the chain has {} degrees of freedom",
                     restricted, free),
         "give the tip a joint that restricts less, or the chain more joints");
}

/// True if a joint without a prescribed motion has a rate at the start.
bool has_given_rates(ChainSpec const& chain) {
    std::vector<bool> driven(chain.bodies.qd.size());
    for (DrivenJoint const& joint : chain.bodies.driven)
        driven[static_cast<std::size_t>(joint.body)] = true;
    for (std::size_t k = 0; k < driven.size(); ++k)
        if (Vec3 const& rate = chain.bodies.qd[k]; !driven[k] && dot(rate, rate) > 0) return true;
    return false;
}

}  // namespace

void note_lost_rates(ChainSpec const& chain, ChainRequest const& request) {
    if (chain.is_beads() || chain.is_linked() || !chain.is_closed()) return;
    if (degrees_of_freedom(chain) > 0 || !has_given_rates(chain)) return;
    request.scene.note(
        fmt::format("the loop{} of chain `{}` ha{} no degrees of freedom by the count of {} "
                    "joints: given rates "
                    "(`qd`) that it cannot follow vanish at the start",
                    chain.loops.size() > 1 ? "s" : "", shown(request.name()),
                    chain.loops.size() > 1 ? "ve" : "s", chain.loops.size() > 1 ? "their" : "its"));
}

ReadTip read_tip(Fields const& chain) {
    ReadTip read;
    Node const* const tip = chain.find("tip");
    if (!tip) return read;
    if (tip->kind == Node::Kind::map) {
        Fields const fields(*tip, keys::tip);
        Node const* const ring = fields.find("ring");
        if (ring && fields.find("joint"))
            fail(*ring, "both `ring` and `joint`", "keep one of them");
        Node const& joint = ring ? *ring : fields.need("joint", "joint: {type: spherical}");
        TipEntry const entry = read_tip_joint(joint, ring);
        read.kind = Tip::jointed;
        read.joint = entry.joint;
        if (entry.planar) read.planar = &joint;
        return read;
    }
    enum class Word { free, fixed, ring };
    auto const word =
        choice<Word>(*tip, {{"free", Word::free}, {"fixed", Word::fixed}, {"ring", Word::ring}});
    if (word == Word::free) return read;
    read.kind = Tip::jointed;
    read.bare = true;
    read.joint.ring = word == Word::ring;
    read.joint.type = read.joint.ring ? LinkJoint::type : WeldJoint::type;
    return read;
}

void join_tip(ChainSpec& chain, ReadTip const& tip, ChainRequest const& request) {
    chain.tip = tip.kind;
    chain.tip_joint = tip.joint;
    if (tip.kind == Tip::free) return;
    Node const& written = *request.node.find("tip");
    bool const ring = tip.joint.ring;
    Node const& node = tip.bare ? written : *written.find(ring ? "ring" : "joint");
    if (chain.is_branched())
        fail(node, "a tip that is not free on a branched chain",
             "leave `tip` out: branched chains have neither rings nor links to the ground but at "
             "bead 1");
    bool const links = chain.is_beads() || chain.is_linked(), link = is_rod(tip.joint.type);
    if (links && tip.bare && !ring)
        fail(node, fmt::format("a fixed tip of {}", kind_of(chain)),
             "write `tip: {joint: {type: link, anchor: [x, y, z]}}`");
    if (links && !link)
        fail(node,
             fmt::format("a {} joint at the tip of {}", name_of(tip.joint.type), kind_of(chain)),
             ring ? "write `tip: ring`" : "write `joint: {type: link, anchor: [x, y, z]}`");
    if (!links && link && ring && tip.bare)
        fail(node, "`tip: ring` does not define the joint between the last body and the first",
             "write `tip: {ring: {type: spherical, translation: [x, y, z]}}`");
    if (!links && link)
        fail(node, "a link at the tip of a chain of other joints",
             "use another type, such as spherical");
    if (chain.is_beads())
        if (Node const* const translation = node.find("translation"))
            fail(*translation, "key `translation` does not apply to a point bead", "leave it out");
    if (ring) check_ring(chain, node);
    if (link) {
        close_link(chain, node, request);
    } else if (ring) {
        close_ring(chain, node, request.scene);
    } else {
        refuse_too_many(chain, node);
        close_joint(chain, node, request.scene);
    }
    if (!ring) refuse_straight_bridge(chain, node);
}

}  // namespace catena::scene
