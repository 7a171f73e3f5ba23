// Jointed tips in joint coordinates: how far they are open, and the corrections that close them.
#include <utility>

#include "integrate/joint_dynamics.hpp"

namespace catena {

double JointDynamics::closure_error(JointState const& state) {
    if (!group_.has_tips()) return 0;
    return communicator_.max(tips_.error(motion(state)));
}

/// One Newton step: the solver with openings in the place of accelerations.
void JointDynamics::correct(JointState& state, bool velocities) {
    motion(state);
    assemble_matrices();
    tips_.set_opening(motion_, velocities, tip_bias_.view());
    solver_->solve({{}, {}, {}, {}, tip_bias_.view()}, {alpha_.view(), acceleration_.view(), {}, {}});
    // Coordinates of the correction: those of accelerations without velocities and gravity.
    JointState still = state;
    still.qd = Field<3>(group_.size);
    motion_.omega = Field<3>(group_.size);
    JointRates change = make_rates();
    Vec3 const gravity = std::exchange(given_.gravity, Vec3::zero());
    rates(still, change);
    given_.gravity = gravity;
    for (LocalDrive const& drive : group_.drives) change.qdd.set(drive.body, Vec3::zero());
    for (std::int64_t k = 0; k < group_.size; ++k) {
        Vec3 const d = change.qdd[k];
        Vector<double, 4> const q = state.q[k];
        if (velocities)
            state.qd.set(k, state.qd[k] + d);
        else if (group_.joint[k] == JointType::spherical || group_.joint[k] == JointType::free)
            state.q.set(k, as_vector(normalized(as_quaternion(q) * from_rotation_vector(d))));
        else
            state.q.set(k, {{q[0] + d[0], q[1] + d[1], q[2], q[3]}});
    }
    auto& base = velocities ? state.base_velocity : state.base_position;
    for (std::size_t p = 0; p < base.size(); ++p) base[p] = base[p] + change.base_acceleration[p];
}

void JointDynamics::close_tips(JointState& state, int corrections) {
    if (!group_.has_tips()) return;
    for (int i = 0; i < corrections; ++i) correct(state, false);
    correct(state, true);
}

}  // namespace catena
