// Motion and loads of a group's bodies in joint coordinates in any Space.
#pragma once

#include "dynamics/joint/joint_bodies.hpp"

namespace catena::joint_coordinates {

/// True if ranks may call follow_revolutes(), that is, if no load depends on positions. All ranks
/// agree, although some of them may not do so.
template <class Space>
bool may_follow_revolutes(JointBodies<Space> const& bodies) {
    return bodies.loads.leaves_loads() && !bodies.motion.needs_positions();
}
/// True if this rank leaves the motion within runs to the solver. If the solver has runs side by
/// side, this needs lanes with the same runs.
template <class Space>
bool follows_revolutes(JointBodies<Space> const& bodies) {
    if constexpr (JointBodies<Space>::has_lanes)
        if (bodies.space.simd() != SimdLevel::off && !rounds_as_vectors()) return false;
    return bodies.loads.eliminated && bodies.group.joints.drives.empty() &&
           !bodies.loads.implicit && (bodies.lanes || !bodies.solver.has_runs_side_by_side());
}

/// Sets the ends of tips and loops, and their velocity terms.
template <class Space>
void set_closures(JointBodies<Space>& bodies) {
    MotionView const motion = bodies.motion.view();
    Vec3 const& gravity = bodies.loads.given.gravity;
    if (bodies.group.ends.has_tips()) {
        bodies.tips.set_ends(motion);
        bodies.tips.set_acceleration_bias(motion, gravity);
    }
    if (bodies.closed_loops.any()) {
        bodies.closed_loops.set_ends(motion);
        bodies.closed_loops.set_acceleration_bias(gravity);
    }
}
/// Computes motion and loads of all bodies. `again`: keeps the forces on carried beads.
template <bool positions, class Space>
void update_all(JointBodies<Space>& bodies, bool again) {
    ChainGroup const& group = bodies.group;
    JointChains c = bodies.chains();
    c.moved.scan.motion.orients_first_alone = !bodies.motion.needs_orientations();
    if (!bodies.motion.begin_scan())
        bodies.template each_body<positions>(
            [&c](JointLoops const& loops, auto... lanes) { loops.set_relative(c, lanes...); },
            [c] CATENA_LAMBDA(std::int64_t k) { c.template set_relative<positions>(k); });
    BodyExchange<4> const shown = bodies.loads.shown(group);
    auto const set_motion = [c, again] CATENA_LAMBDA(std::int64_t k) {
        c.template set_motion<positions>(k, again);
    };
    JointKinematics<Space>& kinematics = bodies.motion.kinematics();
    if constexpr (JointBodies<Space>::has_lanes) {
        if (kinematics.goes_by_levels())
            return kinematics.template sweep<positions>(c.moved.scan, shown, set_motion);
        if (bodies.lanes) {
            bodies.lanes->follow(bodies.space, positions, c.moved.scan);
            kinematics.template sweep<positions>(c.moved.scan, bodies.lanes->tree(), shown);
        } else {
            kinematics.template sweep<positions>(c.moved.scan, shown);
        }
        bodies.template each_body<positions>(
            [&c](JointLoops const& loops, auto... lanes) { loops.set_motion(c, lanes...); },
            set_motion);
    } else {
        kinematics.template sweep<positions>(c.moved.scan, shown, set_motion);
    }
}
template <class Space>
void update_all(JointBodies<Space>& bodies, bool again) {
    bodies.loads.found_motions();
    bodies.with_positions(
        [&](auto positions) { update_all<decltype(positions)::value>(bodies, again); });
    if (bodies.group.has_closures()) set_closures(bodies);
}

/// Scan with one item per run. `relative`: the relative motions are already known.
template <class Space>
void follow_by_runs(JointBodies<Space>& bodies, JointChains const& c, bool relative) {
    RevoluteScan const scan{c, bodies.joint_by_joint(), bodies.solution.refinement.has_value()};
    if (scan.joint_by_joint && !relative) bodies.set_relative();
    bodies.motion.kinematics().sweep_runs(
        scan, bodies.loads.shown(bodies.group),
        [scan] CATENA_LAMBDA(dca::Run const& run) { scan.begin(run); });
}
/// Scan with runs side by side in vector lanes.
template <class Space>
void follow_by_lanes(JointBodies<Space>& bodies, JointChains const& c) {
    Space const& space = bodies.space;
    JointLanes const& lanes = *bodies.lanes;
    RevoluteScan const scan{c, false, bodies.solution.refinement.has_value()};
    // First bodies of chains may have any joint. Their handles stay as set at the start, because no
    // meeting frame moves here.
    space.over(lanes.chains_begin(), [c](std::int64_t k) { c.template set_relative<false>(k); });
    lanes.follow_revolutes(space, c);
    bodies.motion.kinematics().sweep_with(scan, lanes.tree(), bodies.loads.shown(bodies.group));
    lanes.begin_runs(space, c.moved.scan);
    space.over(lanes.chains_begin(),
               [c](std::int64_t k) { c.template set_motion<false>(k, false); });
    space.over(lanes.other_runs(), [scan](dca::Run const& run) { scan.begin(run); });
}
/// Variant of update_all() that leaves the motion within runs to the solver.
template <class Space>
void follow_revolutes(JointBodies<Space>& bodies) {
    bodies.loads.left = LoadsLeft::motions;
    bool const relative = bodies.motion.begin_scan_of_runs();
    JointChains c = bodies.chains();
    c.moved.scan.motion.orients_first_alone = !bodies.motion.needs_orientations();
    if constexpr (JointBodies<Space>::has_lanes)
        if (bodies.solver.has_runs_side_by_side()) return follow_by_lanes(bodies, c);
    follow_by_runs(bodies, c, relative);
}
/// Computes the rotations of revolute joints for the solver, if another scan has overwritten them.
template <class Space>
void find_rotations(JointBodies<Space>& bodies) {
    if (!bodies.loads.leaves_motions() || bodies.motion.has_rotations_of_joints()) return;
    bodies.set_relative();
    bodies.motion.found_rotations();
}
/// Computes the motion alone, positions included.
template <class Space>
void move(JointBodies<Space>& bodies) {
    bodies.motion.move(bodies.state.now.view());
    if (bodies.group.ends.has_tips()) bodies.tips.set_ends(bodies.motion.view());
    if (bodies.closed_loops.any()) bodies.closed_loops.set_ends(bodies.motion.view());
}

}  // namespace catena::joint_coordinates
