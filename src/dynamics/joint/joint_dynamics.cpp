// What all Spaces have in common of the dynamics in joint coordinates.
#include "dynamics/joint/joint_dynamics.hpp"

#include "dynamics/joint/joint_correction.hpp"
#include "dynamics/joint/joint_solution.hpp"
#include "dynamics/joint/jointed_tips.hpp"

namespace catena {

JointDynamics::JointDynamics(ChainGroup const& group, Scene const& scene,
                             Communicator const& communicator, std::unique_ptr<ChainSolver> solver)
    : group_(group),
      communicator_(communicator),
      solver_(std::move(solver)),
      given_(make_body_loads(group, scene)),
      reach_(reach_of(group, scene)) {}

std::vector<double> JointDynamics::time_at_once(int chained, int repeat) {
    return time_chained(chained, repeat, [this] {
        update_to_solve_once();
        solve_once();
        set_rates();
    });
}

void JointDynamics::apply(EmbeddedStage const& stage) {
    JointOperation op{JointOperator::embedded_stage};
    op.stage = stage;
    apply(op, 0);
}

void JointDynamics::refine(Executor const& executor) {
    JointDefect lacking;
    with_solution(
        [&](JointSolution const& found) { lacking = found.defect(communicator_, executor); });
    add_response(lacking);
}

double JointDynamics::correction() {
    double change = 0;
    with_solution([&](JointSolution const& found) {
        change = RefinedSolution{group_,
                                 given_.gravity,
                                 reach_,
                                 found.torque,
                                 found.force,
                                 found.alpha,
                                 found.acceleration,
                                 found.change.alpha,
                                 found.change.acceleration}
                     .relative_change(communicator_);
    });
    return change;
}

void JointDynamics::close_tips(int corrections) {
    if (!group_.has_closures()) return;
    for (int i = 0; i < corrections; ++i) apply({JointOperator::project}, 0);
    apply({JointOperator::project_velocities}, 0);
}

double JointDynamics::closure_error() {
    solver_->check();
    double worst = largest({JointQuantity::trouble});
    if (group_.has_closures()) worst = larger(worst, largest({JointQuantity::opening}));
    return communicator_.max(worst);
}

BodyResults JointDynamics::results() {
    solver_->check();
    BodyResults all;
    with_solution([&](JointSolution const& found) { all = found.results(communicator_); });
    return all;
}

double JointDynamics::residual(Executor const& executor) {
    solver_->check();
    double worst = 0;
    with_solution(
        [&](JointSolution const& found) { worst = found.residual(communicator_, executor); });
    return worst;
}

PotentialEnergy JointDynamics::potential() {
    JointState const now = read_state();
    return potential_of(group_, given_, now.q, motion());
}

}  // namespace catena
