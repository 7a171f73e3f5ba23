// Evaluation of the accelerations of rigid bodies in absolute coordinates, in any Space.
#pragma once

#include "dynamics/rigid/rigid_bodies.hpp"
#include "dynamics/rigid/rigid_solution.hpp"

namespace catena::rigid_bodies {

/// Sets moments and velocity biases for an evaluation.
template <class Space>
void set_loads(RigidBodies<Space>& bodies) {
    RigidSteps const s = bodies.steps();
    bodies.space.for_each(bodies.group.size,
                          [s] CATENA_LAMBDA(std::int64_t k) { s.set_moment(k); });
    if (bodies.group.linked) bodies.show_ends();
    bodies.space.for_each(bodies.group.size,
                          [j = s.joints] CATENA_LAMBDA(std::int64_t k) { j.set_turnings(k); });
}
/// Loads of an evaluation.
template <class Space>
LoadsView loads(RigidBodies<Space>& bodies) {
    return {bodies.sweep.moment.view(), bodies.loads.force.view(), bodies.observed.omega.view(),
            bodies.sweep.bias.view(), of_tips(bodies.group, bodies.sweep.tip_bias)};
}
/// Loads for assemble_and_solve(): the solver adds the gyroscopic torque and the centripetal terms.
template <class Space>
LoadsView loads_at_once(RigidBodies<Space>& bodies) {
    LoadsView l = loads(bodies);
    if (bodies.group.linked) return l;
    l.torque = bodies.loads.torque.view();
    l.gyroscopic = true;
    l.bias = {};
    return l;
}
/// Output arrays of an evaluation.
template <class Space>
AccelerationsView found(RigidBodies<Space>& bodies) {
    RigidSweepIn<Space>& sweep = bodies.sweep;
    return {sweep.alpha.view(), sweep.acceleration.view(), sweep.joint_force.view(),
            of_tips(bodies.group, sweep.tip_force)};
}
/// Calls use() with the results of the last evaluation, copied to the host.
template <class Space, class Use>
auto with_solution(RigidBodies<Space> const& bodies, Use const& use) {
    Space const& space = bodies.space;
    RigidSweepIn<Space> const& sweep = bodies.sweep;
    auto const& orientation = space.read(bodies.state.orientation);
    auto const &omega = space.read(bodies.observed.omega), &force = space.read(bodies.loads.force),
               &torque = space.read(bodies.loads.torque), &moment = space.read(sweep.moment),
               &alpha = space.read(sweep.alpha), &acceleration = space.read(sweep.acceleration),
               &direction = space.read(bodies.handles.direction),
               &tip_direction = space.read(bodies.handles.tip_direction);
    auto const &bias = space.read(sweep.bias), &joint_force = space.read(sweep.joint_force),
               &tip_bias = space.read(sweep.tip_bias), &tip_force = space.read(sweep.tip_force);
    return use(RigidSolution{bodies.group, orientation.view(), omega.view(), force.view(),
                             torque.view(), moment.view(), alpha.view(), acceleration.view(),
                             direction.view(), tip_direction.view(), bias.view(),
                             joint_force.view(), tip_bias.view(), tip_force.view()});
}

}  // namespace catena::rigid_bodies
