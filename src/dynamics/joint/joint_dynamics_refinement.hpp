// Members of JointDynamicsIn beyond the solution of a step: motion on the host, noise, refinement,
// closing of tips, and the exchange of chains' ends for these. Included by joint_dynamics_in.hpp.
#pragma once

#include "dynamics/joint/joint_correction.hpp"
#include "dynamics/joint/joint_dynamics_in.hpp"

namespace catena {

/// Residual of a solution, and the correction that the solver computes from it.
template <class Space>
struct JointRefinement {
    explicit JointRefinement(ChainGroup const& group)
        : JointRefinement(group.size, group.has_tips() ? group.size : 0, group.directions) {}

    typename Space::template FieldOf<3> torque, force, alpha, acceleration;
    typename Space::Directions bias, joint_force, tip_bias, tip_force;

  private:
    JointRefinement(std::int64_t size, std::int64_t tips, int directions)
        : torque(size),
          force(size),
          alpha(size),
          acceleration(size),
          bias(size + 1, directions),
          joint_force(size + 1, directions),
          tip_bias(tips, directions),
          tip_force(tips, directions) {}
};

template <class Space>
BodyMotion JointDynamicsIn<Space>::motion() {
    move();
    BodyMotion m;
    m.joint_turn = space_.read(motion_.joint_turn);
    m.orientation = space_.read(motion_.orientation);
    m.omega = space_.read(motion_.omega);
    m.origin = space_.read(motion_.origin);
    m.velocity = space_.read(motion_.velocity);
    m.r2 = space_.read(motion_.r2);
    m.axes2 = space_.read(motion_.axes2);
    return m;
}

template <class Space>
void JointDynamicsIn<Space>::thermalise(Thermostat const& thermostat, std::uint64_t step) {
    leaves_loads_ = false;
    update(false);
    assemble_matrices();
    need_for_noise();
    JointChains noisy = chains();
    noisy.force = noise_force_.view();
    space_.for_each(group_.size, [noisy, piece = pieces_in_scene_.data(), pieces = pieces(),
                                  seed = thermostat.seed, step] CATENA_LAMBDA(std::int64_t k) {
        noisy.set_noise(k, piece_of(piece, pieces, k).body_of(k), seed, step);
    });
    if (group_.has_tips())
        space_.for_each(tips(), [t = jointed_tips(), out = tip_bias_.view()] CATENA_LAMBDA(
                                    std::int64_t i) { t.set_no_bias(i, out); });
    solver_->solve(
        {torque_.view(), noise_force_.view(), {}, bias_.view(), of_tips(group_, tip_bias_)},
        {alpha_.view(), acceleration_.view(), {}, {}});
    has_revolutes_ = false;
    JointSteps const still = at_rest();
    exchange_ends(still.chains);
    space_.for_each(group_.size, [still, state = state_.view(), keep = thermostat.keep,
                                  spread = thermostat.spread] CATENA_LAMBDA(std::int64_t k) {
        still.mix(k, state, keep, spread);
    });
    relative_ = false;
}

template <class Space>
void JointDynamicsIn<Space>::set_ends() {
    space_.for_each(tips(), [t = jointed_tips()] CATENA_LAMBDA(std::int64_t i) { t.take_ends(i); });
    for (std::int64_t i = 0; i < tips(); ++i) {
        JointedTip const& t = tip_[static_cast<std::size_t>(i)];
        if (t.neighbour < 0) continue;
        bool const has_last = t.body >= 0;
        View<13> const own = (has_last ? last_end_ : other_end_).view(),
                       other = (has_last ? other_end_ : last_end_).view();
        space_.exchange(communicator_,
                        BodyExchange<13>{own, i, t.neighbour, other, i, t.neighbour});
    }
    space_.for_each(tips(),
                    [t = jointed_tips()] CATENA_LAMBDA(std::int64_t i) { t.set_meeting(i); });
}

template <class Space>
void JointDynamicsIn<Space>::correct(bool velocities) {
    move();
    assemble_matrices();
    space_.for_each(tips(), [t = jointed_tips(), velocities, out = tip_bias_.view()] CATENA_LAMBDA(
                                std::int64_t i) { t.set_opening(i, velocities, out); });
    solver_->solve({{}, {}, {}, {}, tip_bias_.view()},
                   {alpha_.view(), acceleration_.view(), {}, {}});
    has_revolutes_ = false;
    JointSteps const still = at_rest();
    exchange_ends(still.chains);
    space_.for_each(group_.size, [still, state = state_.view(), velocities] CATENA_LAMBDA(
                                     std::int64_t k) { still.correct(k, state, velocities); });
}

template <class Space>
void JointDynamicsIn<Space>::exchange_ends(JointChains const& c) {
    View<4> const end = outboard_end_.view();
    space_.exchange(
        communicator_,
        BodyExchange<4>{end, 0, group_.neighbour_outboard, end, -1, group_.neighbour_inboard},
        [c, last = group_.size - 1] CATENA_LAMBDA(std::int64_t) {
            c.outboard_end.store(0, c.outboard_end_of(last));
        });
}

template <class Space>
void JointDynamicsIn<Space>::add(std::int64_t count, DirectionsView const& found,
                                 DirectionsView const& to) {
    space_.for_each(count,
                    [found, to, directions = group_.directions] CATENA_LAMBDA(std::int64_t k) {
                        for (int i = 0; i < directions; ++i) to.at(k, i) += found.at(k, i);
                    });
}

/// Completes the last solution by what no step has requested: orientations, loads, and all
/// accelerations and joint forces. Precondition: nothing has changed since.
template <class Space>
void JointDynamicsIn<Space>::find_all() {
    if (!std::exchange(has_orientations_, true)) {
        relative_ = false;
        kinematics_.evaluate(state_.view(), false, motion_.view());
        has_rotations_ = false;
    }
    bool const has_all = std::exchange(has_all_, true);
    if (has_matrices_) leave_nothing();
    if (!has_all) {
        find_rotations();
        has_matrices_ ? solver_->solve(loads(), all())
                      : solver_->assemble_and_solve(configuration(), loads(), all());
    }
    leave_nothing();
}

template <class Space>
template <class Use>
auto JointDynamicsIn<Space>::with_solution(Use const& use) {
    find_all();
    auto const &joint_turn = space_.read(motion_.joint_turn),
               &orientation = space_.read(motion_.orientation);
    auto const &omega = space_.read(motion_.omega), &velocity = space_.read(motion_.velocity),
               &r2 = space_.read(motion_.r2);
    auto const& axes2 = space_.read(motion_.axes2);
    auto const &torque = space_.read(torque_), &force = space_.read(force_),
               &alpha = space_.read(alpha_), &acceleration = space_.read(acceleration_),
               &bead_force = space_.read(beads_.force());
    auto const& compliance = space_.read(compliance_);
    auto const &bias = space_.read(bias_), &joint_force = space_.read(joint_force_),
               &tip_bias = space_.read(tip_bias_), &tip_force = space_.read(tip_force_);
    return use(JointSolution{
        group_, given_, joint_turn.view(), orientation.view(), omega.view(), velocity.view(),
        r2.view(), axes2.view(), torque.view(), has_forces_ ? force.view() : ConstView<3>{},
        alpha.view(), acceleration.view(), beads_.any() ? bead_force.view() : ConstView<3>{},
        bias.view(), joint_force.view(), tip_bias.view(), tip_force.view(), compliance.view()});
}

template <class Space>
void JointDynamicsIn<Space>::refine(Executor const& executor) {
    /// Done first, with the same matrices that produced the accelerations.
    find_all();
    has_revolutes_ = false;
    if (!has_matrices_) assemble_matrices();
    auto const lacking = with_solution(
        [&](JointSolution const& found) { return found.defect(communicator_, executor); });
    std::int64_t const size = group_.size, of_tip = group_.has_tips() ? size : 0;
    if (!refinement_) refinement_.emplace(group_);
    JointRefinement<Space>& r = *refinement_;
    fill(space_, r.torque, lacking.torque);
    fill(space_, r.force, lacking.force);
    space_.write(r.bias, lacking.bias);
    space_.write(r.tip_bias, lacking.tip_bias);
    solver_->solve(
        {r.torque.view(), r.force.view(), {}, r.bias.view(), of_tips(group_, r.tip_bias)},
        {r.alpha.view(), r.acceleration.view(), r.joint_force.view(),
         of_tips(group_, r.tip_force)});
    space_.for_each(size, [more = r.alpha.view(), sum = alpha_.view()] CATENA_LAMBDA(
                              std::int64_t k) { sum.store(k, sum.load(k) + more.load(k)); });
    space_.for_each(size, [more = r.acceleration.view(), sum = acceleration_.view()] CATENA_LAMBDA(
                              std::int64_t k) { sum.store(k, sum.load(k) + more.load(k)); });
    add(size + 1, r.joint_force.view(), joint_force_.view());
    add(of_tip, r.tip_force.view(), tip_force_.view());
    exchange_ends();
    space_.wait();
}

template <class Space>
double JointDynamicsIn<Space>::correction() {
    auto const &torque = space_.read(torque_), &force = space_.read(force_),
               &alpha = space_.read(alpha_), &acceleration = space_.read(acceleration_),
               &turned = space_.read(refinement_->alpha),
               &moved = space_.read(refinement_->acceleration);
    return RefinedSolution{group_,
                           given_.gravity,
                           reach_,
                           torque.view(),
                           has_forces_ ? force.view() : ConstView<3>{},
                           alpha.view(),
                           acceleration.view(),
                           turned.view(),
                           moved.view()}
        .relative_change(communicator_);
}

}  // namespace catena
