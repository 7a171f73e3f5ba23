#include "chain/joint_kinematics.hpp"

#include "scene/pose.hpp"

namespace catena {
namespace {

/// R^T v for the rotation of q.
Vec3 rotate_back(Quat const& q, Vec3 const& v) { return transposed_times(to_matrix(q), v); }

Motion const still{Quat::identity(), Vec3::zero(), Vec3::zero(), Vec3::zero()};

Vec3 axis_of(ChainGroup const& group, std::int64_t k) {
    ConstView<9> const axes = group.axes1.view();
    return {{axes.at(k, 2), axes.at(k, 5), axes.at(k, 8)}};
}
/// {c, s, rate} of ChainGroup::screw: the joint turns by c rate q and slides by s rate q.
Vec3 screw_of(ChainGroup const& group, std::int64_t k) { return group.has_screws ? group.screw.view().load(k) : Vec3{{1, 0, 1}}; }

/// Of B in M.
Quat turn_of(ChainGroup const& group, JointState const& state, std::int64_t k) {
    Vector<double, 4> const q = state.q.view().load(k);
    switch (group.joint[k]) {
        case JointType::free:
        case JointType::spherical:
            return as_quaternion(q);
        case JointType::universal:
            return from_axis_angle(axis_of(group, k), q[1]);
        case JointType::weld:
        case JointType::link:
            return Quat::identity();
        default:
            Vec3 const screw = screw_of(group, k);
            return from_axis_angle(axis_of(group, k), screw[0] * screw[2] * q[0]);
    }
}

/// Of the meeting frame M of joint k in the inboard body's axes.
Quat meeting_rotation(ChainGroup const& group, JointState const& state, std::int64_t k) {
    Quat const frame = as_quaternion(group.joint_rotation.view().load(k));
    if (group.joint[k] != JointType::universal) return frame;
    return frame * from_axis_angle(group.first_axis.view().load(k), state.q.view().at(k, 0));
}

/// Of the meeting point from the inboard body's origin, its axes.
Vec3 meeting_point(ChainGroup const& group, JointState const& state, std::int64_t k) {
    Vec3 const point = group.joint_translation.view().load(k);
    if (!group.has_screws) return point;
    Vec3 const screw = screw_of(group, k);
    if (screw[1] == 0) return point;
    Mat3 const frame = to_matrix(as_quaternion(group.joint_rotation.view().load(k)));
    return point + frame * ((screw[1] * screw[2] * state.q.view().at(k, 0)) * axis_of(group, k));
}

}  // namespace

JointRate joint_rate(ChainGroup const& group, JointState const& state, std::int64_t k) {
    Vec3 const qd = state.qd.view().load(k);
    switch (group.joint[k]) {
        case JointType::free:
        case JointType::spherical:
            return {to_matrix(turn_of(group, state, k)) * qd, Vec3::zero()};
        case JointType::universal:
            return {qd[0] * group.first_axis.view().load(k) + qd[1] * axis_of(group, k), Vec3::zero()};
        case JointType::weld:
        case JointType::link:
            return {Vec3::zero(), Vec3::zero()};
        default:
            Vec3 const screw = screw_of(group, k), axis = axis_of(group, k);
            return {(screw[0] * screw[2] * qd[0]) * axis, (screw[1] * screw[2] * qd[0]) * axis};
    }
}

void follow_courses(ChainGroup const& group, JointState& state) {
    for (LocalDrive const& drive : group.drives) {
        bool const two = group.joint[drive.body] == JointType::universal;
        Course const& a = drive.course[0];
        Course const& b = drive.course[1];
        state.q.set(drive.body, {{scene::value_at(a, state.time), two ? scene::value_at(b, state.time) : 0.0, 0, 0}});
        state.qd.set(drive.body, {{scene::rate_at(a, state.time), two ? scene::rate_at(b, state.time) : 0.0, 0}});
    }
}

template <bool positions>
Motion compose(Motion const& ab, Motion const& bc) {
    Mat3 const turn = to_matrix(bc.rotation);
    Motion ac{ab.rotation * bc.rotation, transposed_times(turn, ab.omega) + bc.omega, Vec3::zero(), Vec3::zero()};
    if constexpr (positions) {
        ac.translation = ab.translation + to_matrix(ab.rotation) * bc.translation;
        ac.velocity = transposed_times(turn, ab.velocity + cross(ab.omega, bc.translation)) + bc.velocity;
    }
    return ac;
}
template Motion compose<true>(Motion const&, Motion const&);
template Motion compose<false>(Motion const&, Motion const&);

BodyMotion make_body_motion(ChainGroup const& group) {
    std::int64_t const n = group.size;
    BodyMotion motion{Field<4>(n), Field<4>(n), Field<3>(n), Field<3>(n), Field<3>(n), {}, {}};
    if (!group.moving_meeting()) return motion;
    motion.r2 = group.r2;
    motion.axes2 = group.axes2;
    return motion;
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
    follow_courses(group, state);
    return state;
}

JointKinematics::JointKinematics(ChainGroup const& group, Executor const& executor, Communicator const& communicator)
    : group_(group), executor_(executor), communicator_(communicator), units_(local_units(group)) {
    for (dca::Piece const& piece : group.pieces) composites_needed_ = composites_needed_ || group.partition.trees[piece.chain].units > 1;
}

Motion JointKinematics::joint_motion(JointState const& state, std::size_t piece, std::int64_t k) const {
    Quat const turn = turn_of(group_, state, k);
    if (group_.joint[k] == JointType::free)
        return {turn, state.qd.view().load(k), state.base_position[piece], rotate_back(turn, state.base_velocity[piece])};
    Motion m{meeting_rotation(group_, state, k) * turn, Vec3::zero(), meeting_point(group_, state, k), Vec3::zero()};
    switch (group_.joint[k]) {
        case JointType::spherical:
            m.omega = state.qd.view().load(k);
            break;
        case JointType::revolute:  // B's axis is M's
            m.omega = state.qd.view().at(k, 0) * axis_of(group_, k);
            break;
        case JointType::weld:
            break;
        default:
            JointRate const rate = joint_rate(group_, state, k);
            m.omega = rotate_back(turn, rate.angular);
            m.velocity = rotate_back(turn, rate.linear);
    }
    return m;
}

/// In a plane bodies turn about its normal alone: composing rounds a part across it, which grows with the chain.
void JointKinematics::keep_in_plane(std::int64_t k, Motion& m) const {
    if (!group_.planar) return;
    Vec3 const axis = axis_of(group_, k);  // the same in M and B
    m.omega = dot(axis, m.omega) * axis;
}

template <bool positions>
Motion JointKinematics::unit_motion(JointState const& state, LocalUnit const& unit) const {
    Motion m = still;
    for (std::int64_t k = unit.begin; k < unit.begin + unit.count; ++k) {
        m = compose<positions>(m, joint_motion(state, unit.piece, k));
        keep_in_plane(k, m);
    }
    m.rotation = normalized(m.rotation);
    return m;
}

template <bool positions>
std::vector<Motion> JointKinematics::starts_of_units(JointState const& state) const {
    std::vector<Motion> starts(units_.size(), still);
    if (composites_needed_) {
        std::vector<Motion> own(units_.size());
        executor_.for_each(static_cast<std::int64_t>(units_.size()),
                           [&](std::int64_t i) { own[i] = unit_motion<positions>(state, units_[i]); });
        for (std::size_t i = 1; i < units_.size(); ++i)
            if (group_.pieces[units_[i].piece].whole() && units_[i].index > 0) starts[i] = compose<positions>(starts[i - 1], own[i - 1]);
        if (!group_.schedule.shared.empty()) gather_shared<positions>(own, starts);
    } else if (!group_.schedule.shared.empty()) {
        gather_shared<positions>({}, starts);
    }
    return starts;
}

/// One collective: the motions of the units of shared chains; every rank then goes along its own shared chains in the same order.
template <bool positions>
void JointKinematics::gather_shared(std::vector<Motion> const& own, std::vector<Motion>& starts) const {
    std::vector<Motion> const all = gather_shared_units(communicator_, group_, units_, own);
    std::size_t next = 0;
    std::size_t first_of_chain = 0;
    for (int chain = 0; chain < group_.partition.chains(); ++chain) {
        if (!group_.partition.is_split(chain)) continue;
        Motion m = still;
        for (std::int64_t unit = 0; unit < group_.partition.trees[chain].units; ++unit) {
            while (next < units_.size() && group_.pieces[units_[next].piece].whole()) ++next;
            if (next < units_.size() && group_.pieces[units_[next].piece].chain == chain && units_[next].index == unit) starts[next++] = m;
            m = compose<positions>(m, all[first_of_chain + static_cast<std::size_t>(unit)]);
        }
        first_of_chain += static_cast<std::size_t>(group_.partition.trees[chain].units);
    }
}

/// The inboard sides of universal and sliding joints, seen from the bodies they are in: joint k's from body k - 1.
void JointKinematics::set_meetings(JointState const& state, BodyMotion& out) const {
    auto const meeting = [&](std::int64_t k) {  // point from the inboard body's origin, axes
        Vec3 const point = meeting_point(group_, state, k);
        Mat3 const axes = to_matrix(meeting_rotation(group_, state, k)) * as_matrix(group_.axes1.view().load(k));
        Vector<double, 12> m;
        for (int i = 0; i < 3; ++i) m[i] = point[i];
        for (int i = 0; i < 9; ++i) m[3 + i] = axes.data[i];
        return m;
    };
    auto const set = [&](std::int64_t body, Vector<double, 12> const& m) {
        out.r2.set(body, Vec3{{m[0], m[1], m[2]}} + group_.r1.view().load(body));
        out.axes2.set(body, {{m[3], m[4], m[5], m[6], m[7], m[8], m[9], m[10], m[11]}});
    };
    executor_.for_each(group_.size, [&](std::int64_t k) {
        if (k > 0 && !group_.is_first[k]) set(k - 1, meeting(k));
    });
    Vector<double, 12> send = group_.neighbour_inboard >= 0 ? meeting(0) : Vector<double, 12>::zero(), receive = send;
    communicator_.exchange(std::as_bytes(std::span(send.data)), group_.neighbour_inboard, std::as_writable_bytes(std::span(receive.data)),
                           group_.neighbour_outboard);
    if (group_.neighbour_outboard >= 0) set(group_.size - 1, receive);
}

void JointKinematics::evaluate(JointState const& state, bool with_positions, BodyMotion& out) const {
    with_positions ? evaluate<true>(state, out) : evaluate<false>(state, out);
    if (group_.moving_meeting()) set_meetings(state, out);
}

template <bool positions>
void JointKinematics::evaluate(JointState const& state, BodyMotion& out) const {
    std::vector<Motion> const starts = starts_of_units<positions>(state);
    View<4> const turn = out.joint_turn.view(), orientation = out.orientation.view();
    View<3> const omega = out.omega.view(), origin = out.origin.view(), velocity = out.velocity.view();
    executor_.for_each(static_cast<std::int64_t>(units_.size()), [&](std::int64_t i) {
        LocalUnit const& unit = units_[i];
        Motion m = starts[i];
        for (std::int64_t k = unit.begin; k < unit.begin + unit.count; ++k) {
            turn.store(k, as_vector(turn_of(group_, state, k)));
            m = compose<positions>(m, joint_motion(state, unit.piece, k));
            m.rotation = normalized(m.rotation);
            keep_in_plane(k, m);
            orientation.store(k, as_vector(m.rotation));
            omega.store(k, m.omega);
            if constexpr (positions) {
                origin.store(k, m.translation);
                velocity.store(k, m.velocity);
            }
        }
    });
}

}  // namespace catena
