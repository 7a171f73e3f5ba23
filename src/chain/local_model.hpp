// Parts of the model of a chain group on one rank: ends of chains, joints, bodies, branches and
// carried beads. ChainGroup has the frames and the halo.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "math/field.hpp"
#include "scene/scene.hpp"
#include "tree/branches.hpp"

namespace catena {

/// A chain of a group, as the scene has it.
struct GroupChain {
    int in_scene = 0;  // index of the chain in the scene
    std::string name;
    /// Scene-wide index of the chain's first body (bodies counted over all chains of the scene).
    std::int64_t first_body = 0;
};

/// Joint from a chain's last body to the ground or to its first body, on the rank that owns the
/// last body.
struct LocalTip {
    std::int64_t body = 0;  // local index of the chain's last body
    TipJoint joint;
    Mat3 axes;                // axes in M, see LocalBodies::axes1
    Vector<double, 4> screw;  // see LocalJoints::screw
    /// Number of constrained directions.
    int restricted = 0;
};

/// Ring: a chain closed on itself, of which this rank owns at least one end.
struct LocalRing {
    int chain = 0;  // index in the group
    /// Local indices of the chain's first and last body; -1 if another rank owns it.
    std::int64_t first = -1, last = -1;
    /// Rank that owns the other end; -1: this rank owns both.
    int neighbour = -1;
    /// True if this rank owns both ends.
    bool is_whole() const { return neighbour < 0; }
};

/// Ends of the chains of a group.
struct LocalEnds {
    /// 1 for the local bodies that are first and last bodies of chains.
    std::vector<std::uint8_t> is_first, is_last;
    /// True if some chain of the group has a jointed tip, on any rank.
    bool tips_in_scene = false;
    /// Index in `tips` of the jointed tip of each last body, else -1; empty if no chain has one.
    std::vector<std::int32_t> jointed_tip;
    /// Jointed tips, ascending.
    std::vector<LocalTip> tips;
    /// Screws of `tips`, as LocalJoints::screw.
    std::vector<Vector<double, 4>> tip_screw;
    /// Rings with an end on this rank.
    std::vector<LocalRing> rings;

    /// True if some chain of the group has a jointed tip, on any rank.
    bool has_tips() const { return tips_in_scene; }
    /// True if local body k is the last body of a chain with a jointed tip.
    bool has_jointed_tip(std::int64_t k) const {
        return !jointed_tip.empty() && jointed_tip[static_cast<std::size_t>(k)] >= 0;
    }
    /// Index in `tips` of body k's tip. Precondition: has_jointed_tip(k).
    std::size_t tip_index(std::int64_t k) const {
        return static_cast<std::size_t>(jointed_tip[static_cast<std::size_t>(k)]);
    }
    LocalTip const& tip_of(std::int64_t k) const { return tips[tip_index(k)]; }
};

/// Joint of this rank with prescribed motion.
struct LocalDrive {
    std::int64_t body = 0;           // local index of the joint's outboard body
    PrescribedMotion first, second;  // motion of each coordinate; `second` if there are two
};

/// Inboard joints of the local bodies. Groups without rigid bodies have no frames, groups without
/// links no lengths.
struct LocalJoints {
    /// Type of each joint.
    std::vector<JointType> type;
    /// True if some joint is universal, or some joint translates.
    bool has_universal = false, has_screws = false;
    /// Number of constrained directions of joint k in storage numbering. Entries include the halo,
    /// tips and the tops of shared chains (schedule.joints entries; `none`: 0).
    std::vector<std::uint8_t> restricted;
    /// 1 for each local body whose inboard joint's springs and dampers are implicit: they enter the
    /// matrices. Empty if none is.
    std::vector<std::uint8_t> implicit;
    /// Joints with prescribed motion, ascending.
    std::vector<LocalDrive> drives;
    /// Length of the inboard link, nm; [ChainGroup::link_entries()].
    Field<1> length;
    /// Quaternion of the joint's frame J in the inboard body's axes (first body: W).
    Field<4> rotation;
    /// Origin of J relative to the inboard body's origin, in that body's axes (first body: W), nm.
    Field<3> translation;
    /// First axis of a universal joint, J; empty if no joint is universal.
    Field<3> first_axis;
    /// {c, s, rate, order}. A joint with a screw rotates by c rate q about its axis and slides by s
    /// rate q along it. `order` is JointDefaults::order. Empty if no joint translates.
    Field<4> screw;

    /// True if handle 2 of a body depends on the state of the joint there.
    bool moving_meeting() const { return has_universal || has_screws; }
    /// True if the inboard joint of local body k has prescribed motion.
    bool is_driven(std::int64_t k) const;
    /// True if the springs and dampers of body k's inboard joint enter the matrices.
    bool is_implicit(std::int64_t k) const {
        return !implicit.empty() && implicit[static_cast<std::size_t>(k)] != 0;
    }
};

/// Masses and handles of the local bodies. Point beads have masses only.
struct LocalBodies {
    /// Mass, amu, and its inverse.
    Field<1> mass, inverse_mass;
    /// Inertia about the centre of mass and its inverse, B (lower triangle: xx yx yy zx zy zz), amu
    /// nm^2. Planar groups: the inverse about the axis.
    Field<6> inertia, inverse_inertia;
    /// Inboard and outboard joint relative to the centre of mass, B, nm. A sliding outboard joint
    /// is at q = 0. If the tip of a last body is free, its r2 and axes2 are set as for the body
    /// before.
    Field<3> r1, r2;
    /// Axes of the inboard joint in M (kept_axes()). The same components taken in B are axes that
    /// rotate with the joint.
    Field<6> axes1;
    /// Axes of the outboard joint in B (universal: at q = 0).
    Field<6> axes2;
};

/// Rigid link between two beads of one chain, beside the links to their inboard beads.
struct LocalCrossLink {
    /// Local indices of the beads.
    std::int64_t inboard = 0, outboard = 0;
    /// Index of the chain's piece in ChainGroup::pieces.
    std::int64_t piece = 0;
};

/// Properties that branched and cross-linked chains alone have. A rank owns all bodies of such
/// a chain, or none.
struct Branching {
    /// Inboard body of each local body, -1 for first bodies; empty unless the chains are branched
    /// or cross-linked.
    std::vector<std::int64_t> inboard;
    /// Paths of the chains, which replace the runs, merges and roots of ChainGroup::schedule.
    dca::Branches paths;
    /// Cross-links, chain by chain. Arrays over links hold that of `crosslinks[c]` at
    /// ChainGroup::first_crosslink() + c.
    std::vector<LocalCrossLink> crosslinks;
};

/// Joint that closes a loop of rigid bodies. A rank owns all bodies of a chain with loops, or none.
struct LocalLoop {
    /// Local indices of the bodies; LoopClosure::ground for the ground.
    std::int64_t inboard = LoopClosure::ground, outboard = LoopClosure::ground;
    /// Index of the chain's piece in ChainGroup::pieces.
    std::int64_t piece = 0;
    /// Joint as the scene has it, with its frame J in the inboard body.
    TipJoint joint;
    /// Axes of the joint in J, and its screw; see LocalBodies::axes1 and LocalJoints::screw.
    Mat3 axes;
    Vector<double, 4> screw;
    /// Number of constrained directions.
    int restricted = 0;
    /// Orientation and origin of G in the outboard body.
    Mat3 end_rotation;
    Vec3 end_translation;
};

/// Loops of a group's chains.
struct LocalLoops {
    /// True if the chains of the group have loops, on any rank.
    bool in_scene = false;
    /// Loops of this rank's chains, chain by chain.
    std::vector<LocalLoop> own;
};

/// Beads that the rigid bodies of a group carry.
struct LocalBeads {
    /// True if some body of the group carries beads, on any rank.
    bool in_scene = false;
    /// Offset of the beads that body k carries; [size + 1]. Empty if no body carries beads.
    std::vector<std::int64_t> offset;
    /// Position of each bead relative to the centre of mass, B, nm.
    std::vector<Vec3> place;

    /// Number of beads that the local bodies carry.
    std::int64_t count() const { return offset.empty() ? 0 : offset.back(); }
};

/// Ranks that own the bodies before the first and after the last local body, if a chain continues
/// there; else -1.
struct NeighbourRanks {
    int inboard = -1, outboard = -1;
};

}  // namespace catena
