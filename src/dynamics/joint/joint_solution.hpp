// What an evaluation in joint coordinates found, on the host.
#pragma once

#include "dynamics/absolute_dynamics.hpp"
#include "dynamics/joint/joint_chains.hpp"

namespace catena {

struct JointSolution {
    ChainGroup const& group;
    BodyLoads const& given;
    ConstView<4> joint_turn, turn;            // MotionView::joint_turn, orientation
    ConstView<3> omega, velocity, moving_r2;  // MotionView
    ConstView<6> moving_axes2;
    ConstView<3> torque, force, alpha, acceleration;  // force: absent where no body has any
    ConstView<3> bead_force;                          // on carried beads
    ConstDirectionsView bias, joint_force, tip_bias, tip_force;
    ConstView<6> compliance;  // ConfigurationView::compliance

    /// Collective.
    BodyResults results(Communicator const&) const;
    /// Largest local backward residual: Newton-Euler of every body and the closing of every joint,
    /// each relative to the sizes of its own terms (src/dca/README.md, "Residuals"). Over all
    /// ranks; collective.
    double residual(Communicator const&, Executor const&) const;
    /// By how much the equations of bodies and joints fail, as loads for the solver: what it
    /// answers to them is missing in the solution. Collective.
    struct Defect {
        Field<3> torque, force;
        DirectionsField bias, tip_bias;
    };
    Defect defect(Communicator const&, Executor const&) const;

  private:
    void add_across_plane(Communicator const&, BodyResults&) const;
    Mat3 orientation(std::int64_t k) const { return to_matrix(as_quaternion(turn.load(k))); }
    Mat3 axes2(std::int64_t k) const {
        return axes_of(group.moving_meeting() ? moving_axes2.load(k) : group.axes2[k]);
    }
    Vec3 r2(std::int64_t k) const {
        return group.moving_meeting() ? moving_r2.load(k) : group.r2[k];
    }
    /// The inboard joint's, in the body.
    Mat3 axes1(std::int64_t k) const {
        return transposed_times(to_matrix(as_quaternion(joint_turn.load(k))),
                                axes_of(group.axes1[k]));
    }
    Screw<double> screw(std::int64_t k) const;
    Screw<double> outboard_screw(std::int64_t k) const;
    Vec3 gyroscopic_torque(std::int64_t k) const {
        return cross(omega.load(k), as_symmetric(group.inertia[k]) * omega.load(k));
    }
    Vec3 outside_force(std::int64_t k) const;
    struct Terms;
    struct Pair {
        Vec3 force, torque;
    };
    /// Along a joint's axes.
    Pair along_axes(ConstDirectionsView forces, std::int64_t at, Screw<double> const&) const;
    Pair outboard_pair(std::int64_t k) const;
    Terms terms(std::int64_t k) const;
    /// Planar: about the axis alone, the other moments are not solved for.
    Terms terms_solved_for(std::int64_t k) const;
    Vec3 inertial_moment(std::int64_t k) const;
    Vector<double, 8> handle(std::int64_t k, Vec3 const& r, Mat3 const& axes) const;
    /// Handle 2 of the last body on the rank before.
    Vector<double, 8> handle_before_first(Communicator const&) const;
    /// Handle 2 of the body that body k hangs on.
    Vector<double, 8> handle_before(std::int64_t k, Vector<double, 8> const& before_first) const;
    /// What each of the group's tips is joined to: the ground's handle, or handle 1 of a ring's
    /// first body. Collective.
    std::vector<Vector<double, 8>> handles_at_tips(Communicator const&) const;
    /// What an implicit joint yields to its force along its last three directions; 0 of others.
    Vec3 yielded(std::int64_t k) const;
    static Vector<double, 6> opening(Vector<double, 8> const& outboard,
                                     Vector<double, 8> const& inboard,
                                     Vector<double, 6> const& bias, Screw<double> const&,
                                     int restricted);
    double closing(Vector<double, 8> const& outboard, Vector<double, 8> const& inboard,
                   ConstDirectionsView biases, std::int64_t at, Screw<double> const&,
                   int restricted, double size, Vec3 const& yielded) const;
};

/// Of bodies at `motion`, positions included.
PotentialEnergy potential_of(ChainGroup const&, BodyLoads const&, Field<4> const& q,
                             BodyMotion const& motion);

}  // namespace catena
