// Evaluation of a group in joint coordinates in any Space: update, matrices, solution, refinement.
#pragma once

#include "dynamics/joint/joint_solution.hpp"
#include "dynamics/joint/joint_updates.hpp"

namespace catena::joint_coordinates {

template <class Space>
void assemble_matrices(JointBodies<Space>& bodies) {
    bodies.solver.assemble_matrices(bodies.configuration());
    bodies.solution.matrices = MatricesHeld::assembled;
}

/// Updates motion and loads; `leaves_loads` leaves to the solver what it can compute itself.
template <class Space>
void go_to_configuration(JointBodies<Space>& bodies, bool leaves_loads) {
    bodies.solution.matrices = MatricesHeld::none;
    if (leaves_loads)
        bodies.loads.left = LoadsLeft::loads;
    else
        bodies.loads.leave_beads();
    if (!may_follow_revolutes(bodies)) return update_all(bodies, false);
    if (follows_revolutes(bodies))
        follow_revolutes(bodies);
    else
        update_all(bodies, false);
    bodies.motion.forget_orientations();
}

/// JointDynamics::update().
template <class Space>
void update(JointBodies<Space>& bodies, JointUpdate what) {
    if (what != JointUpdate::velocities)
        return go_to_configuration(bodies, what == JointUpdate::to_solve_once &&
                                               static_cast<bool>(bodies.loads.eliminated));
    bodies.loads.left = LoadsLeft::nothing;
    update_all(bodies, true);
}

/// Computes the loads that had been left to the solver, for a solution with assembled matrices.
template <class Space>
void complete_loads(JointBodies<Space>& bodies) {
    bool const left = bodies.loads.leaves_loads(), finds_motions = may_follow_revolutes(bodies);
    if (left) bodies.loads.leave_beads();
    if (finds_motions)
        update_all(bodies, false);
    else if (left || bodies.loads.left == LoadsLeft::beads)
        bodies.set_loads();
}

/// Adds the forces of loops to the results of a solution.
template <class Space>
AccelerationsView with_loops(JointBodies<Space>& bodies, AccelerationsView out) {
    out.loop_force = bodies.closed_loops.force().data();
    return out;
}

/// JointDynamics::solve().
template <class Space>
void solve(JointBodies<Space>& bodies, SolvedWith matrices) {
    if (matrices == SolvedWith::assembled) {
        complete_loads(bodies);
        bodies.solver.solve(bodies.given_to_solver(),
                            with_loops(bodies, bodies.solution.next(false)));
    } else {
        if (bodies.loads.carried) bodies.set_loads();
        find_rotations(bodies);
        bodies.solver.assemble_and_solve(
            bodies.configuration(), bodies.given_to_solver(),
            with_loops(bodies, bodies.solution.next(bodies.loads.leaves_loads())));
        bodies.solution.matrices = MatricesHeld::none;
    }
    bodies.exchange_ends();
}

/// Computes the loads that are still left to the solver. Precondition: the motion is known.
template <class Space>
void leave_nothing(JointBodies<Space>& bodies) {
    if (!bodies.loads.leaves_loads()) return;
    bodies.loads.leave_beads();
    bodies.set_loads();
}

/// Completes the last solution by what no step has requested: orientations, loads, and all
/// accelerations and joint forces. Precondition: nothing has changed since.
template <class Space>
void find_all(JointBodies<Space>& bodies) {
    auto& solution = bodies.solution;
    bodies.motion.orient(bodies.state.now.view());
    bool const assembled = solution.matrices == MatricesHeld::assembled;
    if (assembled) leave_nothing(bodies);
    if (std::exchange(solution.found, Found::all) != Found::all) {
        find_rotations(bodies);
        AccelerationsView const all = with_loops(bodies, solution.all());
        assembled ? bodies.solver.solve(bodies.given_to_solver(), all)
                  : bodies.solver.assemble_and_solve(bodies.configuration(),
                                                     bodies.given_to_solver(), all);
    }
    leave_nothing(bodies);
}

/// Calls use() with the last solution, completed and copied to the host.
template <class Space, class Use>
void with_solution(JointBodies<Space>& bodies, Use const& use) {
    find_all(bodies);
    Space const& space = bodies.space;
    auto const& motion = bodies.motion.fields();
    auto& loads = bodies.loads;
    auto& solution = bodies.solution;
    auto const &joint_turn = space.read(motion.joint_turn),
               &orientation = space.read(motion.orientation);
    auto const &omega = space.read(motion.omega), &velocity = space.read(motion.velocity),
               &r2 = space.read(motion.r2);
    auto const& axes2 = space.read(motion.axes2);
    auto const &torque = space.read(loads.torque), &force = space.read(loads.force),
               &alpha = space.read(solution.alpha),
               &acceleration = space.read(solution.acceleration),
               &bead_force = space.read(loads.beads.force());
    auto const& compliance = space.read(loads.implicit.compliance());
    auto const &bias = space.read(loads.bias), &joint_force = space.read(solution.joint_force),
               &tip_bias = space.read(bodies.tips.bias()),
               &tip_force = space.read(solution.tip_force);
    JointSolution all{bodies.group,
                      loads.given,
                      bodies.motion.kinematics().joints().levels(),
                      joint_turn.view(),
                      orientation.view(),
                      omega.view(),
                      velocity.view(),
                      {r2.view(), axes2.view()},
                      torque.view(),
                      loads.has_forces ? force.view() : ConstView<3>{},
                      alpha.view(),
                      acceleration.view(),
                      loads.beads.any() ? bead_force.view() : ConstView<3>{},
                      bias.view(),
                      joint_force.view(),
                      tip_bias.view(),
                      tip_force.view(),
                      compliance.view()};
    Field<3> pushed_torque, pushed_force;
    if (bodies.closed_loops.any()) {
        all.loops = &bodies.closed_loops;
        pushed_torque = torque, pushed_force = force;
        bodies.closed_loops.add_forces(pushed_torque, pushed_force);
        all.torque = pushed_torque.view(), all.force = pushed_force.view();
    }
    if (!solution.refinement) return use(all);
    auto const &turned = space.read(solution.refinement->alpha),
               &moved = space.read(solution.refinement->acceleration);
    all.change = {turned.view(), moved.view()};
    use(all);
}

/// Adds the numbers `found` of `count` bodies to those of `to`.
template <class Space>
void add_to(Space const& space, std::int64_t count, View<3> const& found, View<3> const& to) {
    space.for_each(count, [found, to] CATENA_LAMBDA(std::int64_t k) {
        to.store(k, to.load(k) + found.load(k));
    });
}
template <class Space>
void add_to(Space const& space, std::int64_t count, DirectionsView const& found,
            DirectionsView const& to, int directions) {
    space.for_each(count, [found, to, directions] CATENA_LAMBDA(std::int64_t k) {
        for (int i = 0; i < directions; ++i) to.at(k, i) += found.at(k, i);
    });
}

/// JointDynamics::add_response().
template <class Space>
void add_response(JointBodies<Space>& bodies, JointDefect const& defect) {
    // The same matrices that produced the accelerations.
    if (bodies.solution.matrices == MatricesHeld::none) assemble_matrices(bodies);
    Space const& space = bodies.space;
    ChainGroup const& group = bodies.group;
    auto& solution = bodies.solution;
    if (!solution.refinement) solution.refinement.emplace(group);
    JointRefinement<Space>& r = *solution.refinement;
    fill(space, r.torque, defect.torque);
    fill(space, r.force, defect.force);
    space.write(r.bias, defect.bias);
    space.write(r.tip_bias, defect.tip_bias);
    std::vector<Vector<double, 6>> found(defect.loop_bias.size());
    LoadsView lacking = r.loads(group);
    lacking.loop_bias = defect.loop_bias.data();
    AccelerationsView response = r.response(group);
    response.loop_force = found.data();
    bodies.solver.solve(lacking, response);
    for (std::size_t l = 0; l < found.size(); ++l)
        bodies.closed_loops.force()[l] = bodies.closed_loops.force()[l] + found[l];
    add_to(space, group.size, r.alpha.view(), solution.alpha.view());
    add_to(space, group.size, r.acceleration.view(), solution.acceleration.view());
    int const directions = group.directions;
    add_to(space, group.size + 1, r.joint_force.view(), solution.joint_force.view(), directions);
    add_to(space, group.ends.has_tips() ? group.size : 0, r.tip_force.view(),
           solution.tip_force.view(), directions);
    bodies.exchange_ends();
    space.wait();
}

}  // namespace catena::joint_coordinates
