// Starting poses of rigid chains and the principal axes of their bodies.
#include "dynamics/rigid/rigid_dynamics.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "kinematics/joint_kinematics.hpp"

namespace catena {
namespace {

/// Start of bodies on links: their poses are in the scene.
void place_linked(ChainGroup const& group, Scene const& scene, RigidStart& start) {
    for (dca::Piece const& piece : group.pieces) {
        LinkedArrays const& linked = scene.chains[group.chains[piece.chain].in_scene].linked;
        for (std::int64_t i = 0; i < piece.count; ++i) {
            std::int64_t const k = piece.local + i;
            auto const body = static_cast<std::size_t>(piece.body + i);
            auto const& q = linked.orientation[body];
            start.position.set(k, linked.position[body]);
            start.velocity.set(k, linked.velocity[body]);
            start.omega.set(k, linked.omega[body]);
            start.orientation.set(k, {{q[0], q[1], q[2], q[3]}});
        }
    }
}

/// Start of bodies on joints: the forward kinematics of their joint coordinates.
void place_jointed(ChainGroup const& group, Scene const& scene, Communicator const& communicator,
                   RigidStart& start) {
    auto const executor = serial_executor();
    HostSpace const host(*executor);
    JointState state = make_joint_state(group, scene);
    BodyMotion motion(group, host);
    JointKinematics(group, host, communicator).evaluate(state.view(), true, motion.view());
    for (std::int64_t k = 0; k < group.size; ++k) {
        Mat3 const axes = to_matrix(as_quaternion(motion.orientation[k]));
        start.position.set(k, motion.origin[k] - axes * group.bodies.r1[k]);
        start.velocity.set(
            k, axes * (motion.velocity[k] - cross(motion.omega[k], group.bodies.r1[k])));
        start.omega.set(k, motion.omega[k]);
        start.orientation.set(k, motion.orientation[k]);
    }
}

/// Principal axes and moments of one inertia; identity and zero for a point bead.
PrincipalFrame principal_frame(Sym3 const& inertia) {
    if (inertia.data[0] == 0) return {Quat::identity(), Vec3::zero()};
    Eigen::Matrix3d j;
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) j(a, b) = inertia(a, b);
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> const solver(j);
    Eigen::Matrix3d axes = solver.eigenvectors();
    if (axes.determinant() < 0) axes.col(2) = -axes.col(2);
    Mat3 m;
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) m(a, b) = axes(a, b);
    return {to_quaternion(m),
            {{solver.eigenvalues()[0], solver.eigenvalues()[1], solver.eigenvalues()[2]}}};
}

}  // namespace

RigidStart place_bodies(ChainGroup const& group, Scene const& scene,
                        Communicator const& communicator) {
    RigidStart start{Field<3>(group.size), Field<3>(group.size), Field<3>(group.size),
                     Field<4>(group.size)};
    if (group.linked)
        place_linked(group, scene, start);
    else
        place_jointed(group, scene, communicator, start);
    return start;
}

PrincipalFrames principal_frames(ChainGroup const& group) {
    PrincipalFrames frames{Field<4>(group.size), Field<3>(group.size)};
    for (std::int64_t k = 0; k < group.size; ++k) {
        PrincipalFrame const frame = principal_frame(as_symmetric(group.bodies.inertia[k]));
        frames.axes.set(k, as_vector(frame.rotation));
        frames.moment.set(k, frame.moments);
    }
    return frames;
}

double reach_of_joints(ChainGroup const& group, Communicator const& communicator) {
    double reach = 0;
    for (std::int64_t k = 0; k < group.size; ++k)
        reach = std::max({reach, norm(group.bodies.r1[k]), norm(group.bodies.r2[k]),
                          radius_of_gyration(as_symmetric(group.bodies.inertia[k]),
                                             group.bodies.mass.view().at(k, 0))});
    return communicator.max(reach);
}

std::unique_ptr<AbsoluteDynamics> make_rigid_dynamics(ChainGroup const& group, Scene const& scene,
                                                      Executor const& executor,
                                                      Communicator const& communicator,
                                                      std::unique_ptr<ChainSolver> solver,
                                                      double implicit_step) {
    return std::make_unique<RigidDynamics<HostSpace>>(
        group, scene, HostSpace(executor), communicator, std::move(solver), implicit_step);
}

}  // namespace catena
