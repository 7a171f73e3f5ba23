// Construction of chain groups from a scene.
#include "chain/chain_group.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

#include "chain/chain_order.hpp"
#include "joints/joint_models.hpp"
#include "scene/branch_limits.hpp"
#include "scene/branches.hpp"
#include "scene/freedom.hpp"

namespace catena {
namespace {

Eigen::Vector3d as_eigen(Vec3 const& v) { return {v[0], v[1], v[2]}; }
Vec3 from_eigen(Eigen::Vector3d const& v) { return {{v[0], v[1], v[2]}}; }
Mat3 columns(Eigen::Vector3d const& p, Eigen::Vector3d const& q, Vec3 const& axis) {
    Mat3 m;
    m.set_column(0, from_eigen(p));
    m.set_column(1, from_eigen(q));
    m.set_column(2, axis);
    return m;
}

/// Returns the axes (p, q, axis), right-handed, of a joint with one axis.
Mat3 axes_about(Vec3 const& axis) {
    Eigen::Vector3d const z = as_eigen(axis), p = z.unitOrthogonal();
    return columns(p, z.cross(p).normalized(), axis);
}
/// Returns the axes (p, q, axis) of a joint, right-handed; the identity if the joint has no axis.
/// For a joint with two axes, p is normal to both, or the first one if the joint glides.
Mat3 joint_axes(JointType type, Vec3 const& axis, Vec3 const& first_axis) {
    if (has_one_axis(type)) return axes_about(axis);
    if (!has_two_axes(type)) return Mat3::identity();
    Eigen::Vector3d const z = as_eigen(axis), across = as_eigen(first_axis).cross(z).normalized();
    Eigen::Vector3d const p = glides(type) ? z.cross(across).normalized() : across;
    return columns(p, z.cross(p).normalized(), axis);
}

/// Returns {c, s, rate, order}, see LocalJoints::screw.
Vector<double, 4> screw_of(JointType type, double pitch) {
    Vec3 const s = with_joint(type, [&](auto model) { return decltype(model)::screw(pitch); });
    return {{s[0], s[1], s[2], static_cast<double>(order_of(type))}};
}

/// Inverse of a rotational inertia, as a lower triangle.
Vector<double, 6> inverse(Sym3 const& inertia) {
    Eigen::Matrix3d j;
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) j(a, b) = inertia(a, b);
    Eigen::Matrix3d const i = j.llt().solve(Eigen::Matrix3d::Identity());
    return {{i(0, 0), 0.5 * (i(1, 0) + i(0, 1)), i(1, 1), 0.5 * (i(2, 0) + i(0, 2)),
             0.5 * (i(2, 1) + i(1, 2)), i(2, 2)}};
}

/// Type of joint `body` (counted from 0); the number of bodies denotes the tip joint.
JointType joint_type(ChainSpec const& spec, std::int64_t body) {
    if (body == static_cast<std::int64_t>(spec.size()))
        return spec.tip == Tip::jointed ? spec.tip_joint.type : FreeJoint::type;
    if (spec.bodies.size() > 0) return spec.bodies.joint[body];
    return body == 0 && spec.base == Base::free ? FreeJoint::type : LinkJoint::type;
}
/// True if the joint has prescribed motion.
bool is_driven_joint(ChainSpec const& spec, std::int64_t body) {
    auto const& driven = spec.bodies.driven;
    auto const found =
        std::lower_bound(driven.begin(), driven.end(), body,
                         [](DrivenJoint const& d, std::int64_t k) { return d.body < k; });
    return found != driven.end() && found->body == body;
}
/// True if a joint in joint coordinates has springs or dampers and no prescribed motion.
bool has_implicit_joint(ChainSpec const& spec, std::int64_t body) {
    return body < static_cast<std::int64_t>(spec.bodies.size()) &&
           scene::resists(spec.bodies, static_cast<std::size_t>(body)) &&
           !is_driven_joint(spec, body);
}
/// Number of constrained directions of a joint. In a ring, the first body's joint is the closing
/// joint.
int restricted_at(ChainSpec const& spec, std::int64_t body, bool implicit) {
    if (body == 0 && spec.is_ring()) return restricted_by(spec.tip_joint.type);
    if (implicit && has_implicit_joint(spec, body)) return 6;
    return is_driven_joint(spec, body) ? 6 : restricted_by(joint_type(spec, body));
}

/// Smallest number of handle directions that covers every joint of the chain.
int smallest_directions(ChainSpec const& spec) {
    return scene::directions_of(scene::handle_kind(spec));
}

/// Sets the arrays of bead k.
void fill_bead(ChainGroup& group, ChainSpec const& spec, std::int64_t body, std::int64_t k) {
    group.bodies.mass.set(k, {{spec.beads.mass[body]}});
    group.bodies.inverse_mass.set(k, {{1.0 / spec.beads.mass[body]}});
    group.joints.length.set(k, {{spec.beads.length[body]}});
}

void fill_inertia(ChainGroup& group, Sym3 const& inertia, std::int64_t k) {
    Vector<double, 6> v;
    for (int i = 0; i < 6; ++i) v[i] = inertia.data[i];
    group.bodies.inertia.set(k, v);
    group.bodies.inverse_inertia.set(k, inverse(inertia));
}

/// Replaces the inverse inertia by a a^T / (a . J a): bodies of planar chains rotate about the axis
/// alone.
void keep_axis_alone(ChainGroup& group, Sym3 const& inertia, Vec3 const& axis, std::int64_t k) {
    double const about = dot(axis, inertia * axis);
    Vector<double, 6> v;
    for (int i = 0, at = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j) v[at++] = axis[i] * axis[j] / about;
    group.bodies.inverse_inertia.set(k, v);
}

/// Sets the arrays of rigid body k.
void fill_body(ChainGroup& group, ChainSpec const& spec, std::int64_t body, std::int64_t k) {
    BodyArrays const& b = spec.bodies;
    group.bodies.mass.set(k, {{b.mass[body]}});
    group.bodies.inverse_mass.set(k, {{1.0 / b.mass[body]}});
    fill_inertia(group, b.inertia[body], k);
    if (group.planar) keep_axis_alone(group, b.inertia[body], b.axis[body], k);
    auto const axes = [&](std::int64_t joint) {
        bool const two = has_two_axes(b.joint[joint]);
        return joint_axes(b.joint[joint], b.axis[joint], two ? b.first_axis[joint] : Vec3::zero());
    };
    group.bodies.r1.set(k, -b.com[body]);
    group.bodies.axes1.set(k, kept_axes(axes(body)));
    Quat const rotation = to_quaternion(b.rotation[body]);
    group.joints.rotation.set(k, {{rotation.w, rotation.x, rotation.y, rotation.z}});
    group.joints.translation.set(k, b.translation[body]);
    // The last body with a free tip is treated as the one before, so that alike bodies have alike
    // entries. In branched chains the entries of a body are those of the inboard body at its joint.
    std::int64_t const outboard =
        spec.is_branched() || body + 1 == static_cast<std::int64_t>(b.size()) ? body : body + 1;
    std::int64_t const inboard =
        spec.is_branched() ? spec.parent[static_cast<std::size_t>(body)] : outboard - 1;
    group.bodies.r2.set(k, inboard < 0 ? Vec3::zero() : b.translation[outboard] - b.com[inboard]);
    // The axes are computed as in JointsView::meeting(), so that axes that do not move have the
    // same bits there.
    auto const meeting = [&](std::int64_t joint) {
        return to_matrix(to_quaternion(b.rotation[joint])) * axes_of(kept_axes(axes(joint)));
    };
    group.bodies.axes2.set(k, kept_axes(inboard < 0 ? Mat3::identity() : meeting(outboard)));
    if (group.joints.has_universal && turns_twice(b.joint[body]))
        group.joints.first_axis.set(k, b.first_axis[body]);
    if (!group.joints.has_screws) return;
    bool const closing =
        body == 0 && spec.is_ring();  // a ring's first body has no other inboard joint
    if (closing)
        group.joints.screw.set(k, screw_of(spec.tip_joint.type, spec.tip_joint.pitch));
    else
        group.joints.screw.set(
            k, screw_of(b.joint[body], has_pitch(b.joint[body]) ? b.pitch[body] : 0));
}

/// Sets the arrays of body k of a linked chain.
void fill_linked(ChainGroup& group, ChainSpec const& spec, std::int64_t body, std::int64_t k) {
    LinkedArrays const& b = spec.linked;
    group.bodies.mass.set(k, {{b.mass[body]}});
    group.bodies.inverse_mass.set(k, {{1.0 / b.mass[body]}});
    if (!b.is_bead(static_cast<std::size_t>(body)))
        fill_inertia(group, b.inertia[body], k);  // a bead's inertia stays zero
    group.bodies.r1.set(k, b.inboard[body]);
    group.bodies.r2.set(k, b.outboard[body]);
    group.joints.length.set(k, {{b.length[body]}});
}

/// Sets the beads that bodies carry, if any chain of the group carries some.
void fill_carried(ChainGroup& group, Scene const& scene) {
    auto const carried_of = [&](int chain) -> CarriedBeads const& {
        return scene.chains[group.chains[chain].in_scene].carried();
    };
    bool any = false;
    for (std::size_t chain = 0; chain < group.chains.size(); ++chain)
        any = any || carried_of(static_cast<int>(chain)).size() > 0;
    if (!any) return;
    group.carried.in_scene = true;
    group.carried.offset.push_back(0);
    for (dca::Piece const& piece : group.pieces) {
        CarriedBeads const& carried = carried_of(piece.chain);
        for (std::int64_t body = piece.body; body < piece.body + piece.count; ++body) {
            for (std::int64_t i = carried.size() > 0 ? carried.offset[body] : 0;
                 carried.size() > 0 && i < carried.offset[body + 1]; ++i) {
                Vec3 const place = carried.position[static_cast<std::size_t>(i)];
                // Joint chains give the position from the body's origin, the inboard joint.
                group.carried.place.push_back(
                    group.linked ? place
                                 : place + group.bodies.r1[piece.local + body - piece.body]);
            }
            group.carried.offset.push_back(static_cast<std::int64_t>(group.carried.place.size()));
        }
    }
}

/// Appends the jointed tip of last body k.
void add_tip(ChainGroup& group, ChainSpec const& spec, std::int64_t k) {
    TipJoint const& tip = spec.tip_joint;
    LocalTip const local = local_tip(group, spec, k);
    group.ends.jointed_tip[k] = static_cast<std::int32_t>(group.ends.tips.size());
    if (!group.beads && !group.linked) {
        group.bodies.r2.set(k, tip.translation - spec.bodies.com.back());
        group.bodies.axes2.set(k, kept_axes(tip.rotation * local.axes));
    }
    group.ends.tips.push_back(local);
    group.ends.tip_screw.push_back(local.screw);
}

/// Number of directions of the group's handles.
int directions_of(ChainGroup const& group) {
    if (carries_all(group.handles)) return group.beads || group.linked ? 3 : 6;
    return group.smallest_directions;
}

/// Allocates the arrays that the group's kind needs.
void allocate(ChainGroup& group) {
    std::int64_t const n = group.size;
    group.ends.is_first.assign(n, 0);
    group.ends.is_last.assign(n, 0);
    group.joints.type.assign(n, FreeJoint::type);
    group.bodies.mass = Field<1>(n);
    group.bodies.inverse_mass = Field<1>(n);
    if (group.beads || group.linked) group.joints.length = Field<1>(group.link_entries());
    if (group.beads) return;
    group.bodies.inertia = Field<6>(n);
    group.bodies.inverse_inertia = Field<6>(n);
    group.bodies.r1 = Field<3>(n);
    group.bodies.r2 = Field<3>(n);
    if (group.linked) return;
    group.bodies.axes1 = Field<6>(n);
    group.bodies.axes2 = Field<6>(n);
    group.joints.rotation = Field<4>(n);
    group.joints.translation = Field<3>(n);
    if (group.joints.has_universal) group.joints.first_axis = Field<3>(n);
    if (group.joints.has_screws) group.joints.screw = Field<4>(n);
}

/// Sets all arrays from the scene.
void fill(ChainGroup& group, Scene const& scene, Executor const& executor) {
    each_local_body(group, executor, [&](dca::Piece const& piece, std::int64_t i) {
        ChainSpec const& spec = scene.chains[group.chains[piece.chain].in_scene];
        std::int64_t const k = piece.local + i, body = piece.body + i;
        group.joints.type[k] = joint_type(spec, body);
        group.ends.is_first[k] = body == 0;
        group.ends.is_last[k] = body + 1 == static_cast<std::int64_t>(spec.size());
        group.beads    ? fill_bead(group, spec, body, k)
        : group.linked ? fill_linked(group, spec, body, k)
                       : fill_body(group, spec, body, k);
    });
    for (dca::Piece const& piece : group.pieces) {
        ChainSpec const& spec = scene.chains[group.chains[piece.chain].in_scene];
        for (DrivenJoint const& driven : spec.bodies.driven)
            if (driven.body >= piece.body && driven.body < piece.body + piece.count)
                group.joints.drives.push_back(
                    {piece.local + driven.body - piece.body, driven.course[0], driven.course[1]});
        if (piece.ends && spec.tip == Tip::jointed)
            add_tip(group, spec, piece.local + piece.count - 1);
    }
}

/// Sets LocalJoints::restricted. This includes the joints at the boundaries of shared units, which
/// the top eliminates, and the halo's joint among them.
void fill_restricted(ChainGroup& group, Scene const& scene, bool implicit) {
    dca::Schedule const& s = group.schedule;
    auto const restricted = [&](int chain, std::int64_t body) {
        return static_cast<std::uint8_t>(
            std::min(group.directions,
                     restricted_at(scene.chains[group.chains[chain].in_scene], body, implicit)));
    };
    group.joints.restricted.assign(static_cast<std::size_t>(s.joints), 0);
    if (implicit) group.joints.implicit.assign(static_cast<std::size_t>(group.size), 0);
    for (dca::Piece const& piece : group.pieces)
        for (std::int64_t i = 0; i < piece.count; ++i) {
            group.joints.restricted[piece.local + i] = restricted(piece.chain, piece.body + i);
            if (implicit)
                group.joints.implicit[piece.local + i] = has_implicit_joint(
                    scene.chains[group.chains[piece.chain].in_scene], piece.body + i);
        }
    if (!group.pieces.empty() && !group.pieces.back().ends) {
        dca::Piece const& last = group.pieces.back();
        group.joints.restricted[s.halo] = restricted(last.chain, last.body + last.count);
    }
    for (std::size_t i = 0; i < s.tip_chain.size(); ++i)
        group.joints.restricted[s.first_tip() + static_cast<std::int64_t>(i)] =
            restricted(s.tip_chain[i], group.partition.trees[s.tip_chain[i]].bodies);
    for (std::size_t i = 0; i < s.top_chain_of_joint.size(); ++i)
        group.joints.restricted[s.first_top_joint() + static_cast<std::int64_t>(i)] =
            restricted(s.top_chain_of_joint[i], s.top_body_of_joint[i]);
}

/// Sets the cross-links of whole chains.
void fill_crosslinks(ChainGroup& group, Scene const& scene) {
    for (std::size_t p = 0; p < group.pieces.size(); ++p) {
        dca::Piece const& piece = group.pieces[p];
        for (CrossLink const& link : scene.chains[group.chains[piece.chain].in_scene].crosslinks)
            group.branching.crosslinks.push_back({piece.local + link.inboard,
                                                  piece.local + link.outboard,
                                                  static_cast<std::int64_t>(p)});
    }
}

/// Sets the lengths of cross-links.
void fill_crosslink_lengths(ChainGroup& group, Scene const& scene) {
    std::int64_t k = group.first_crosslink();
    for (dca::Piece const& piece : group.pieces)
        for (CrossLink const& link : scene.chains[group.chains[piece.chain].in_scene].crosslinks)
            group.joints.length.set(k++, {{link.length}});
}

/// Sets the loops of whole chains.
void fill_loops(ChainGroup& group, Scene const& scene) {
    for (std::size_t p = 0; p < group.pieces.size(); ++p) {
        dca::Piece const& piece = group.pieces[p];
        auto const local = [&](std::int64_t body) {
            return body == LoopClosure::ground ? body : piece.local + body;
        };
        for (LoopClosure const& loop : scene.chains[group.chains[piece.chain].in_scene].loops) {
            TipJoint const& j = loop.joint;
            group.loops.own.push_back(
                {local(loop.inboard), local(loop.outboard), static_cast<std::int64_t>(p), j,
                 joint_axes(j.type, j.axis, j.first_axis), screw_of(j.type, j.pitch),
                 restricted_by(j.type), loop.end_rotation, loop.end_translation});
        }
    }
}

/// Sets the counts of the paths on all ranks. Collective.
void count_branches(ChainGroup& group, Communicator const& communicator) {
    dca::BranchCounts const own = group.branching.paths.counts();
    auto const largest = [&](std::int64_t value) {
        return static_cast<std::int64_t>(communicator.max(static_cast<double>(value)));
    };
    group.branching.paths.of_all_ranks = {communicator.sum(own.paths), communicator.sum(own.runs),
                                          largest(own.phases), largest(own.levels),
                                          largest(own.depth)};
}

/// Sets the inboard bodies of branched or cross-linked chains and cuts the chains into paths.
/// Collective.
void fill_branches(ChainGroup& group, Scene const& scene, bool pairwise,
                   Communicator const& communicator) {
    group.branching.inboard.assign(static_cast<std::size_t>(group.size), -1);
    for (dca::Piece const& piece : group.pieces) {
        std::vector<std::int64_t> const& parent =
            scene.chains[group.chains[piece.chain].in_scene].parent;
        for (std::int64_t i = 1; i < piece.count; ++i)
            group.branching.inboard[piece.local + i] =
                piece.local +
                static_cast<std::int64_t>(scene::inboard_of(parent, static_cast<std::size_t>(i)));
    }
    group.branching.paths = dca::Branches(group.branching.inboard, pairwise);
    count_branches(group, communicator);
    group.schedule.runs.clear();
    group.schedule.levels.clear();
    group.schedule.roots.clear();
    group.schedule.slots = 0;
}

/// Sets the neighbouring ranks.
void find_neighbours(ChainGroup& group, int rank) {
    dca::Partition const& p = group.partition;
    std::int64_t const begin = p.first_of_rank[rank], end = p.first_of_rank[rank + 1];
    if (begin == end) return;
    if (!group.pieces.front().starts) group.neighbours.inboard = p.owner(begin - 1);
    if (!group.pieces.back().ends) group.neighbours.outboard = p.owner(end);
}

/// Finds the rings with an end on this rank.
void find_rings(ChainGroup& group, int rank) {
    dca::Partition const& p = group.partition;
    for (int chain = 0; chain < p.chains(); ++chain) {
        if (p.tip[chain] != dca::TipTo::first_body) continue;
        std::int64_t const first = p.first_of_chain[chain], last = p.first_of_chain[chain + 1] - 1,
                           begin = p.first_of_rank[rank];
        int const owner = p.owner(first), other = p.owner(last);
        if (rank != owner && rank != other) continue;
        group.ends.rings.push_back({chain, rank == owner ? first - begin : -1,
                                    rank == other ? last - begin : -1,
                                    owner == other  ? -1
                                    : rank == owner ? other
                                                    : owner});
    }
}

dca::TipTo tip_of(ChainSpec const& spec) {
    if (spec.tip == Tip::free) return dca::TipTo::nothing;
    return spec.is_ring() ? dca::TipTo::first_body : dca::TipTo::ground;
}

/// Records which kinds of joints a chain has.
void look_at_joints(ChainGroup& group, ChainSpec const& spec) {
    auto const look = [&](JointType type) {
        group.joints.has_universal = group.joints.has_universal || turns_twice(type);
        group.joints.has_screws = group.joints.has_screws || slides(type);
    };
    for (JointType const type : spec.bodies.joint) look(type);
    if (spec.bodies.size() > 0 && spec.tip == Tip::jointed) look(spec.tip_joint.type);
    group.smallest_directions = std::max(group.smallest_directions, smallest_directions(spec));
}

/// True if all joints of the chain except its first are revolute, and its tip is free.
bool is_revolute(ChainSpec const& spec) {
    std::vector<JointType> const& joint = spec.bodies.joint;
    return spec.tip == Tip::free &&
           std::all_of(joint.begin() + (joint.empty() ? 0 : 1), joint.end(), pivots);
}

/// Builds the group of the given chains. Collective.
ChainGroup make_group(Scene const& scene, std::vector<int> const& chains, Axes axes,
                      Handles handles, bool pairwise, Communicator const& communicator,
                      GroupOptions const& options) {
    ChainGroup group;
    ChainSpec const& any = scene.chains[chains.front()];
    group.beads = any.is_beads();
    group.linked = any.is_linked();
    group.axes = group.beads || group.linked ? Axes::world : axes;
    group.handles = handles;
    group.smallest_directions = 1;
    std::vector<std::int64_t> lengths;
    std::vector<dca::TipTo> tips;
    std::vector<std::int64_t> first_in_scene{0};
    for (ChainSpec const& spec : scene.chains)
        first_in_scene.push_back(first_in_scene.back() + static_cast<std::int64_t>(spec.size()));
    for (int const chain : chains) {
        ChainSpec const& spec = scene.chains[chain];
        lengths.push_back(static_cast<std::int64_t>(spec.size()));
        group.chains.push_back({chain, spec.name, first_in_scene[chain]});
        tips.push_back(tip_of(spec));
        look_at_joints(group, spec);
    }
    group.directions = directions_of(group);
    group.planar = group.directions == 2;
    bool const by_paths = scene::goes_by_paths(any);
    group.loops.in_scene = any.has_loops();
    group.partition = dca::Partition(lengths, pairwise, communicator.size(), tips);
    group.partition.whole_chains = by_paths || group.loops.in_scene;
    if (group.partition.whole_chains || !options.shares.empty())
        dca::cut_by_shares(group.partition, communicator.size(), options.shares);
    group.pieces = dca::pieces_of(group.partition, communicator.rank());
    group.schedule = dca::make_schedule(group.partition, communicator.rank());
    group.size = group.schedule.bodies;
    group.revolute = !group.beads && !group.linked && group.directions == 5 &&
                     !group.joints.has_screws && !group.loops.in_scene &&
                     std::all_of(chains.begin(), chains.end(),
                                 [&](int chain) { return is_revolute(scene.chains[chain]); });
    group.ends.tips_in_scene = std::any_of(tips.begin(), tips.end(),
                                           [](dca::TipTo t) { return t != dca::TipTo::nothing; });
    if (group.ends.tips_in_scene)
        group.ends.jointed_tip.assign(static_cast<std::size_t>(group.size), -1);
    if (by_paths) fill_crosslinks(group, scene);
    allocate(group);
    fill(group, scene, options.executor);
    if (by_paths) fill_crosslink_lengths(group, scene);
    if (by_paths) fill_branches(group, scene, pairwise, communicator);
    if (!group.beads) fill_carried(group, scene);
    fill_loops(group, scene);
    fill_restricted(group, scene, options.implicit);
    find_neighbours(group, communicator.rank());
    find_rings(group, communicator.rank());
    if (group.joints.has_screws)
        exchange_from_outboard(communicator, group, group.joints.screw.view());
    return group;
}

/// Returns a number below 10 that is equal for chains of one group, apart from their loops.
int group_of_bodies(ChainSpec const& spec, Axes axes, Handles handles, bool implicit) {
    if (spec.is_cross_linked()) return 8;
    if (scene::branches(spec)) return spec.is_beads() ? 7 : 9;
    if (spec.is_beads()) return 0;
    if (spec.is_linked()) return 1;
    if (carries_all(handles) || (implicit && scene::resists(spec))) return 6;
    return axes == Axes::world ? 3 : smallest_directions(spec);
}
/// Returns a number that is equal for chains of one group.
int group_of(ChainSpec const& spec, Axes axes, Handles handles, bool implicit) {
    return group_of_bodies(spec, axes, handles, implicit) + (spec.has_loops() ? 10 : 0);
}

}  // namespace

int ChainGroup::restricted(std::int64_t k) const {
    return std::min(directions,
                    joints.is_implicit(k) || (!joints.drives.empty() && joints.is_driven(k))
                        ? 6
                        : restricted_by(joints.type[static_cast<std::size_t>(k)]));
}

LocalTip local_tip(ChainGroup const& group, ChainSpec const& spec, std::int64_t last) {
    TipJoint const& tip = spec.tip_joint;
    LocalTip local{last, tip, joint_axes(tip.type, tip.axis, tip.first_axis),
                   screw_of(tip.type, tip.pitch),
                   std::min(group.directions, restricted_by(tip.type))};
    if (group.planar)
        local.axes = axes_about(transposed_times(tip.rotation, spec.bodies.axis.back()));
    return local;
}

std::vector<std::unique_ptr<ChainGroup>> make_groups(Scene const& scene, Axes axes, Handles handles,
                                                     bool pairwise,
                                                     Communicator const& communicator,
                                                     GroupOptions const& options) {
    std::map<int, std::vector<int>> chains;
    for (std::size_t i = 0; i < scene.chains.size(); ++i)
        chains[group_of(scene.chains[i], axes, handles, options.implicit)].push_back(
            static_cast<int>(i));
    // Chains of one rank should lie close together, so that ranks have few ghosts of each other.
    // Results do not depend on the order.
    // Replicas are dealt out in their order.
    bool const together = scene.forces.openmm && communicator.size() > 1 && scene.replicas == 1;
    std::vector<std::unique_ptr<ChainGroup>> groups;
    for (auto& [kind, members] : chains) {
        ChainSpec const& any = scene.chains[members.front()];
        if (together && (any.is_beads() || any.is_linked()))
            members =
                compact_order(placed_chains(scene, members), communicator.size(), options.shares);
        bool const of_tree = scene::is_body_tree(any);
        bool const of_resisting =
            options.implicit && std::any_of(members.begin(), members.end(),
                                            [&](int c) { return scene::resists(scene.chains[c]); });
        groups.push_back(std::make_unique<ChainGroup>(
            make_group(scene, members, axes,
                       of_tree        ? Handles::articulated
                       : of_resisting ? Handles::full
                                      : handles,
                       pairwise, communicator, {of_resisting, options.shares, options.executor})));
    }
    return groups;
}

}  // namespace catena
