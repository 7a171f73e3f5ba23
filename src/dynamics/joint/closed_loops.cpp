// Implements the geometry, velocity terms and openings of loops.
#include "dynamics/joint/closed_loops.hpp"

#include <cmath>
#include <string>

#include "dynamics/absolute_dynamics.hpp"
#include "error.hpp"

namespace catena {
namespace {

/// Centre of mass of a body from its origin, B; zero for the ground.
Vec3 com_of(ChainGroup const& group, std::int64_t body) {
    return body == LoopClosure::ground ? Vec3::zero() : -group.bodies.r1[body];
}

Motion motion_of(std::int64_t body, MotionView const& m) {
    if (body == LoopClosure::ground) return Motion::none();
    return {as_quaternion(m.orientation.load(body)), m.omega.load(body), m.origin.load(body),
            m.velocity.load(body)};
}

}  // namespace

ClosedLoops::ClosedLoops(ChainGroup const& group, double reach)
    : group_(group),
      reach_(reach),
      motions_(group.loops.own.size(), {Motion::none(), Motion::none()}),
      places_(group.loops.own.size()),
      ends_(group.loops.own.size()),
      bias_(group.loops.own.size(), Vector<double, 6>::zero()),
      force_(group.loops.own.size(), Vector<double, 6>::zero()) {
    for (LocalLoop const& loop : group.loops.own) {
        joints_.push_back(tip_of(loop.joint, loop.axes, loop.screw, loop.restricted));
        joints_.back().com = com_of(group, loop.inboard);
        end_rotation_.push_back(to_quaternion(loop.end_rotation));
    }
}

/// The frame G moves with the outboard body.
JointedTips::Ends ClosedLoops::motions_of(std::size_t l, MotionView const& m) const {
    LocalLoop const& loop = group_.loops.own[l];
    Motion const body = motion_of(loop.outboard, m);
    Mat3 const& to_body = loop.end_rotation;
    Vec3 const& at = loop.end_translation;
    return {motion_of(loop.inboard, m),
            {body.rotation * end_rotation_[l], transposed_times(to_body, body.omega),
             body.translation + to_matrix(body.rotation) * at,
             transposed_times(to_body, body.velocity + cross(body.omega, at))}};
}

void ClosedLoops::set_ends(MotionView const& m) {
    for (std::size_t l = 0; l < joints_.size(); ++l) {
        motions_[l] = motions_of(l, m);
        JointedTips::Place const& at = places_[l] = JointedTips::place(joints_[l], motions_[l]);
        LocalLoop const& loop = group_.loops.own[l];
        Mat3 const axes = to_matrix(motions_[l].last.rotation) * at.axes;
        Quat const outboard = motion_of(loop.outboard, m).rotation;
        ends_[l] = {{at.point, at.axes},
                    {loop.end_translation - com_of(group_, loop.outboard),
                     transposed_times(to_matrix(outboard), axes)}};
    }
}

void ClosedLoops::set_acceleration_bias(Vec3 const& gravity) {
    for (std::size_t l = 0; l < joints_.size(); ++l) {
        LocalLoop const& loop = group_.loops.own[l];
        JointedTips::Pair terms = JointedTips::velocity_terms(joints_[l], motions_[l], places_[l]);
        // Bodies accelerate relative to a frame that falls; the ground rises in it.
        double const rises = (loop.outboard == LoopClosure::ground ? 1.0 : 0.0) -
                             (loop.inboard == LoopClosure::ground ? 1.0 : 0.0);
        Mat3 const axes = to_matrix(motions_[l].last.rotation) * places_[l].axes;
        terms.linear = terms.linear + rises * transposed_times(axes, gravity);
        bias_[l] = JointedTips::along_directions(joints_[l], {-terms.angular, -terms.linear});
    }
}

void ClosedLoops::set_opening(bool velocities) {
    for (std::size_t l = 0; l < joints_.size(); ++l)
        bias_[l] = JointedTips::along_directions(
            joints_[l], velocities ? JointedTips::opening_rate(joints_[l], motions_[l], places_[l])
                                   : JointedTips::opening(joints_[l], motions_[l], places_[l]));
}

double ClosedLoops::error() const {
    double worst = 0;
    for (std::size_t l = 0; l < joints_.size(); ++l)
        worst = larger(worst,
                       JointedTips::largest_opening(joints_[l], motions_[l], places_[l], reach_));
    return worst;
}

void ClosedLoops::refuse_parting(ConstView<3> const& alpha,
                                 ConstView<3> const& acceleration) const {
    // A contradiction leaves much of the speeds; near a singular position less than 1e-4 is left.
    double constexpr much = 1e-3;
    for (std::size_t l = 0; l < joints_.size(); ++l) {
        LocalLoop const& loop = group_.loops.own[l];
        auto const change = [&](std::int64_t body, LoopEnd const& end) -> JointedTips::Pair {
            if (body == LoopClosure::ground) return {Vec3::zero(), Vec3::zero()};
            Vec3 const turn = alpha.load(body);
            return {transposed_times(end.axes, turn),
                    transposed_times(end.axes, acceleration.load(body) + cross(turn, end.arm))};
        };
        JointedTips::Pair const out = change(loop.outboard, ends_[l].outboard),
                                in = change(loop.inboard, ends_[l].inboard);
        Vector<double, 6> left =
            bias_[l] + JointedTips::along_directions(
                           joints_[l], {out.angular - in.angular, out.linear - in.linear});
        for (int i = loop.restricted; i < 6; ++i) left[i] = 0;
        dca::AlongAxes<double> const parts = dca::along_axes(joints_[l].screw, left);
        Motion const &a = motions_[l].last, &b = motions_[l].other;
        double const turning = norm(a.omega) + norm(b.omega),
                     speed = norm(a.velocity) + norm(b.velocity);
        if (!(norm(parts.angular) > much * turning) &&
            !(norm(parts.linear) > much * (speed + reach_ * turning)))
            continue;
        dca::Piece const& piece = group_.pieces[static_cast<std::size_t>(loop.piece)];
        auto const name = [&](std::int64_t body) {
            return body == LoopClosure::ground ? std::string("the ground")
                                               : "body " + std::to_string(body - piece.local + 1);
        };
        throw ComputationError("the prescribed motions of chain " +
                               group_.chains[static_cast<std::size_t>(piece.chain)].name +
                               " contradict its loops: the joint between " + name(loop.inboard) +
                               " and " + name(loop.outboard) +
                               " would come apart; prescribe fewer joints, or other motions");
    }
}

void ClosedLoops::add_forces(Field<3>& torque, Field<3>& force) const {
    for (std::size_t l = 0; l < joints_.size(); ++l) {
        LocalLoop const& loop = group_.loops.own[l];
        dca::AlongAxes<double> const along = dca::along_axes(joints_[l].screw, force_[l]);
        auto const add = [&](std::int64_t body, LoopEnd const& end, double sign) {
            if (body == LoopClosure::ground) return;
            Vec3 const f = sign * (end.axes * along.linear);
            force.set(body, force[body] + f);
            torque.set(body, torque[body] + sign * (end.axes * along.angular) + cross(end.arm, f));
        };
        add(loop.outboard, ends_[l].outboard, 1);
        add(loop.inboard, ends_[l].inboard, -1);
    }
}

}  // namespace catena
