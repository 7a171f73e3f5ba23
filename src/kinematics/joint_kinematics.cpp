// Initial states in joint coordinates, and the index lists that the kinematics needs.
#include "kinematics/joint_kinematics.hpp"

#include "joints/joint_models.hpp"

namespace catena {

JointState make_joint_state(ChainGroup const& group, Scene const& scene) {
    JointState state(group);
    for (std::size_t p = 0; p < group.pieces.size(); ++p) {
        dca::Piece const& piece = group.pieces[p];
        BodyArrays const& b = scene.chains[group.chains[piece.chain].in_scene].bodies;
        for (std::int64_t i = 0; i < piece.count; ++i) {
            auto const& q = b.q[piece.body + i];
            state.q.set(piece.local + i, {{q[0], q[1], q[2], q[3]}});
            state.qd.set(piece.local + i, b.qd[piece.body + i]);
        }
        state.base_position.set(static_cast<std::int64_t>(p), b.free_base.position);
        state.base_velocity.set(static_cast<std::int64_t>(p), b.free_base.velocity);
    }
    for (LocalDrive const& d : group.joints.drives) {
        bool const two = has_two_coordinates(group.joints.type[d.body]);
        state.q.set(d.body, {{scene::value_at(d.first, 0), two ? scene::value_at(d.second, 0) : 0.0,
                              0, 0}});
        state.qd.set(d.body,
                     {{scene::rate_at(d.first, 0), two ? scene::rate_at(d.second, 0) : 0.0, 0}});
    }
    return state;
}

std::vector<std::int64_t> first_bodies(ChainGroup const& group) {
    std::vector<std::int64_t> first;
    for (dca::Piece const& piece : group.pieces) first.push_back(piece.local);
    return first;
}

std::vector<std::int32_t> run_slots(ChainGroup const& group) {
    std::vector<std::int32_t> slots(static_cast<std::size_t>(group.size));
    for (dca::Run const& run : group.schedule.runs)
        for (std::int64_t k = run.body; k < run.body + run.count; ++k)
            slots[k] = static_cast<std::int32_t>(run.slot);
    return slots;
}

}  // namespace catena
