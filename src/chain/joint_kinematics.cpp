#include "chain/joint_kinematics.hpp"

namespace catena {
namespace {

Quat as_quaternion(Vector<double, 4> const& v) { return {v[0], v[1], v[2], v[3]}; }
Vector<double, 4> as_vector(Quat const& q) { return {{q.w, q.x, q.y, q.z}}; }

/// R^T v for the rotation of q.
Vec3 rotate_back(Quat const& q, Vec3 const& v) { return transposed_times(to_matrix(q), v); }

Motion const still{Quat::identity(), Vec3::zero(), Vec3::zero(), Vec3::zero()};

Quat turn_of(ChainGroup const& group, JointState const& state, std::int64_t k) {
    Vector<double, 4> const q = state.q.view().load(k);
    if (group.joint[k] != JointType::revolute) return as_quaternion(q);
    ConstView<9> const axes = group.axes1.view();
    return from_axis_angle(Vec3{{axes.at(k, 2), axes.at(k, 5), axes.at(k, 8)}}, q[0]);
}

}  // namespace

Motion compose(Motion const& ab, Motion const& bc) {
    return {ab.rotation * bc.rotation, rotate_back(bc.rotation, ab.omega) + bc.omega,
            ab.translation + to_matrix(ab.rotation) * bc.translation,
            rotate_back(bc.rotation, ab.velocity + cross(ab.omega, bc.translation)) + bc.velocity};
}

JointState make_joint_state(ChainGroup const& group, Scene const& scene) {
    JointState state{Field<4>(group.size), Field<3>(group.size), {}, {}};
    for (dca::Piece const& piece : group.pieces) {
        BodyArrays const& b = scene.chains[group.chain[piece.chain]].bodies;
        for (std::int64_t i = 0; i < piece.count; ++i) {
            auto const& q = b.q[piece.body + i];
            state.q.set(piece.local + i, {{q[0], q[1], q[2], q[3]}});
            state.qd.set(piece.local + i, b.qd[piece.body + i]);
        }
        state.base_position.push_back(b.free_position);
        state.base_velocity.push_back(b.free_velocity);
    }
    return state;
}

JointKinematics::JointKinematics(ChainGroup const& group, Executor const& executor, Communicator const& communicator)
    : group_(group), executor_(executor), communicator_(communicator) {
    for (std::size_t p = 0; p < group.pieces.size(); ++p) {
        dca::Piece const& piece = group.pieces[p];
        dca::ChainTree const& tree = group.partition.trees[piece.chain];
        for (std::int64_t i = 0; i < piece.units; ++i) {
            std::int64_t const unit = piece.first_unit + i;
            std::int64_t const begin = tree.first_body_of_unit(unit), end = tree.first_body_of_unit(unit + 1);
            units_.push_back({p, piece.local + begin - piece.body, end - begin, unit});
        }
        composites_needed_ = composites_needed_ || tree.units > 1;
    }
}

Motion JointKinematics::joint_motion(JointState const& state, std::size_t piece, std::int64_t k) const {
    Vec3 const qd = state.qd.view().load(k);
    Quat const turn = turn_of(group_, state, k);
    if (group_.joint[k] == JointType::free) return {turn, qd, state.base_position[piece], rotate_back(turn, state.base_velocity[piece])};
    Motion m{as_quaternion(group_.joint_rotation.view().load(k)) * turn, qd, group_.joint_translation.view().load(k), Vec3::zero()};
    if (group_.joint[k] == JointType::revolute) {
        ConstView<9> const axes = group_.axes1.view();
        m.omega = qd[0] * Vec3{{axes.at(k, 2), axes.at(k, 5), axes.at(k, 8)}};
    }
    return m;
}

Motion JointKinematics::unit_motion(JointState const& state, Unit const& unit) const {
    Motion m = still;
    for (std::int64_t k = unit.begin; k < unit.begin + unit.count; ++k) m = compose(m, joint_motion(state, unit.piece, k));
    m.rotation = normalized(m.rotation);
    return m;
}

std::vector<Motion> JointKinematics::starts_of_units(JointState const& state) const {
    std::vector<Motion> starts(units_.size(), still);
    if (composites_needed_) {
        std::vector<Motion> own(units_.size());
        executor_.for_each(static_cast<std::int64_t>(units_.size()), [&](std::int64_t i) { own[i] = unit_motion(state, units_[i]); });
        for (std::size_t i = 1; i < units_.size(); ++i)
            if (group_.pieces[units_[i].piece].whole() && units_[i].index > 0) starts[i] = compose(starts[i - 1], own[i - 1]);
        if (!group_.schedule.shared.empty()) gather_shared(own, starts);
    } else if (!group_.schedule.shared.empty()) {
        gather_shared({}, starts);
    }
    return starts;
}

/// One collective: the motions of the units of shared chains; every rank then goes along its own shared chains in the same order.
void JointKinematics::gather_shared(std::vector<Motion> const& own, std::vector<Motion>& starts) const {
    std::vector<Motion> send, all(group_.schedule.shared.size());
    std::vector<std::int64_t> bytes(static_cast<std::size_t>(communicator_.size()), 0);
    for (dca::SharedUnit const& unit : group_.schedule.shared) bytes[unit.owner] += sizeof(Motion);
    for (std::size_t i = 0; i < units_.size(); ++i)
        if (!group_.pieces[units_[i].piece].whole()) send.push_back(own[i]);
    communicator_.all_gather(std::as_bytes(std::span(send)), std::as_writable_bytes(std::span(all)), bytes);
    std::size_t next = 0;
    std::size_t first_of_chain = 0;
    for (int chain = 0; chain < group_.partition.chains(); ++chain) {
        if (!group_.partition.is_split(chain)) continue;
        Motion m = still;
        for (std::int64_t unit = 0; unit < group_.partition.trees[chain].units; ++unit) {
            while (next < units_.size() && group_.pieces[units_[next].piece].whole()) ++next;
            if (next < units_.size() && group_.pieces[units_[next].piece].chain == chain && units_[next].index == unit) starts[next++] = m;
            m = compose(m, all[first_of_chain + static_cast<std::size_t>(unit)]);
        }
        first_of_chain += static_cast<std::size_t>(group_.partition.trees[chain].units);
    }
}

void JointKinematics::evaluate(JointState const& state, bool with_positions, BodyMotion& out) const {
    std::vector<Motion> const starts = starts_of_units(state);
    View<4> const turn = out.joint_turn.view(), orientation = out.orientation.view();
    View<3> const omega = out.omega.view(), origin = out.origin.view(), velocity = out.velocity.view();
    executor_.for_each(static_cast<std::int64_t>(units_.size()), [&](std::int64_t i) {
        Unit const& unit = units_[i];
        Motion m = starts[i];
        for (std::int64_t k = unit.begin; k < unit.begin + unit.count; ++k) {
            turn.store(k, as_vector(turn_of(group_, state, k)));
            m = compose(m, joint_motion(state, unit.piece, k));
            m.rotation = normalized(m.rotation);
            orientation.store(k, as_vector(m.rotation));
            omega.store(k, m.omega);
            if (!with_positions) continue;
            origin.store(k, m.translation);
            velocity.store(k, m.velocity);
        }
    });
}

}  // namespace catena
