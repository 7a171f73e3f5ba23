// Solution of a group's equations of motion in joint coordinates in any Space, and what is known of
// it.
#pragma once

#include <optional>

#include "dynamics/absolute_dynamics.hpp"

namespace catena {

/// Content of the last solution.
enum class Found : std::uint8_t {
    accelerations,  // Accelerations of bodies.
    revolutes,  // AccelerationsView::revolute_acceleration, and bodies where that is not enough.
    all         // Accelerations of bodies, and all joint forces.
};
/// Matrices of the last updated configuration: the solver holds none of it, or those assembled.
enum class MatricesHeld : std::uint8_t { none, assembled };

/// Residual of a solution, and the correction that the solver computes from it.
template <class Space>
struct JointRefinement {
    explicit JointRefinement(ChainGroup const& group)
        : JointRefinement(group.size, group.ends.has_tips() ? group.size : 0, group.directions) {}

    LoadsView loads(ChainGroup const& group) {
        return {torque.view(), force.view(), {}, bias.view(), of_tips(group, tip_bias)};
    }
    AccelerationsView response(ChainGroup const& group) {
        return {alpha.view(), acceleration.view(), joint_force.view(), of_tips(group, tip_force)};
    }

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

/// Arrays of the solution, and its phase.
template <class Space>
struct JointSolutionIn {
    template <int D>
    using FieldOf = typename Space::template FieldOf<D>;

    /// `eliminates`: the solver eliminates_revolute_joints().
    JointSolutionIn(ChainGroup const& of_group, bool eliminates)
        : group(of_group),
          revolute_acceleration(eliminates ? group.size + 1 : 0),
          alpha(group.size),
          acceleration(group.size),
          outboard_end(1),
          joint_force(group.size + 1, group.directions),
          tip_force(group.ends.has_tips() ? group.size : 0, group.directions) {}

    /// Output arrays of a full solution.
    AccelerationsView all() {
        return {alpha.view(), acceleration.view(), joint_force.view(), of_tips(group, tip_force)};
    }
    /// Output arrays of a solution of accelerations alone.
    AccelerationsView accelerations() {
        found = Found::accelerations;
        return {alpha.view(), acceleration.view(), {}, {}};
    }
    /// Output arrays of the next solution. Joint forces, which no step needs, are included only if
    /// the solution will be refined. `revolutes`: accelerations of revolute joints replace those of
    /// bodies where they suffice.
    AccelerationsView next(bool revolutes) {
        if (refinement) {
            found = Found::all;
            return all();
        }
        AccelerationsView out = accelerations();
        if (!revolutes) return out;
        found = Found::revolutes;
        out.revolute_acceleration = revolute_acceleration.view();
        return out;
    }

    ChainGroup const& group;
    Found found = Found::all;
    MatricesHeld matrices = MatricesHeld::none;
    FieldOf<2> revolute_acceleration;
    FieldOf<3> alpha, acceleration;
    /// JointChains::outboard_end of the body before this rank's first one.
    FieldOf<4> outboard_end;
    typename Space::Directions joint_force, tip_force;
    std::optional<JointRefinement<Space>> refinement;
};

}  // namespace catena
