// Factory of JointDynamics on the host.
#include "dynamics/joint/joint_dynamics_in.hpp"

namespace catena {

std::vector<JointedTip> tips_at_start(ChainGroup const& group, Scene const& scene,
                                      Communicator const& communicator) {
    if (!group.ends.has_tips()) return {};
    auto const executor = serial_executor();
    HostSpace const host(*executor);
    JointState start = make_joint_state(group, scene);
    BodyMotion motion(group, host);
    JointKinematics(group, host, communicator).evaluate(start.view(), true, motion.view());
    return jointed_tips(group, scene, motion);
}

std::unique_ptr<JointDynamics> make_joint_dynamics(ChainGroup const& group, Scene const& scene,
                                                   Executor const& executor,
                                                   Communicator const& communicator,
                                                   std::unique_ptr<ChainSolver> solver,
                                                   double implicit_step) {
    return std::make_unique<JointDynamicsIn<HostSpace>>(
        group, scene, HostSpace(executor), communicator, std::move(solver), implicit_step);
}

}  // namespace catena
