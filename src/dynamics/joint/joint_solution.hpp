// Results of an evaluation in joint coordinates, on the host.
#pragma once

#include "dynamics/absolute_dynamics.hpp"
#include "dynamics/joint/closed_loops.hpp"
#include "dynamics/joint/joint_chains.hpp"
#include "tree/levels.hpp"

namespace catena {

/// Residuals of the equations of bodies and joints, as loads for the solver. The solver's response
/// to them is minus the error of the solution.
struct JointDefect {
    Field<3> torque, force;
    DirectionsField bias, tip_bias;
    std::vector<Vector<double, 6>> loop_bias;  // By loop.
};

/// Fields of MotionView: handle 2 and the axes there, where they move.
struct MeetingPlaces {
    ConstView<3> r2;
    ConstView<6> axes2;
};

/// Additions of a refinement to accelerations, B.
struct RefinedBy {
    ConstView<3> alpha, acceleration;
};

/// Motion, loads and solution of a rank's bodies, with results and residuals computed from them. B
/// axes unless stated otherwise.
struct JointSolution {
    ChainGroup const& group;
    BodyLoads const& given;
    /// Bodies that hang on each body of branched chains; without levels for other chains.
    dca::Levels const& levels;
    /// Quaternions MotionView::joint_turn and MotionView::orientation.
    ConstView<4> joint_turn, rotation;
    /// Fields of MotionView.
    ConstView<3> omega, velocity;
    MeetingPlaces moving;
    /// Fields of JointChains, with the forces of loops. `force` has no origin if no body has a
    /// force.
    ConstView<3> torque, force, alpha, acceleration;
    /// Forces on carried beads, W.
    ConstView<3> bead_force;
    ConstDirectionsView bias, joint_force, tip_bias, tip_force;
    ConstView<6> compliance;  // Compliance of implicit joints (ConfigurationView::compliance).
    /// Addition of the last refinement to `alpha` and `acceleration`; no origin without one.
    RefinedBy change{};
    /// Loops of the chains; null without any.
    ClosedLoops const* loops = nullptr;

    /// Accelerations and joint forces for output, W. Collective.
    BodyResults results(Communicator const&) const;
    /// Largest local backward residual over all ranks: Newton-Euler equations of every body and
    /// closing of every joint, each relative to the sizes of its own terms (src/dca/README.md,
    /// "Residuals"). Collective.
    double residual(Communicator const&, Executor const&) const;
    /// Residuals of the equations of bodies and joints. Collective.
    JointDefect defect(Communicator const&, Executor const&) const;

  private:
    /// Adds the constraint forces across the plane of planar chains. Collective.
    void add_across_plane(Communicator const&, BodyResults&) const;
    /// Adds the forces of loops.
    void add_loop_forces(BodyResults&) const;
    Mat3 orientation(std::int64_t k) const { return to_matrix(as_quaternion(rotation.load(k))); }
    /// Axes of the outboard joint, B. In branched chains, entry k is of the inboard body of body k
    /// at the joint between them; likewise r2().
    Mat3 axes2(std::int64_t k) const {
        return axes_of(group.joints.moving_meeting() ? moving.axes2.load(k)
                                                     : group.bodies.axes2[k]);
    }
    Vec3 r2(std::int64_t k) const {
        return group.joints.moving_meeting() ? moving.r2.load(k) : group.bodies.r2[k];
    }
    /// Axes of the inboard joint, B.
    Mat3 axes1(std::int64_t k) const {
        return transposed_times(to_matrix(as_quaternion(joint_turn.load(k))),
                                axes_of(group.bodies.axes1[k]));
    }
    /// Screw of the inboard joint of body k.
    Screw<double> screw(std::int64_t k) const;
    /// Screw of the outboard joint or the tip's joint of body k.
    Screw<double> outboard_screw(std::int64_t k) const;
    Vec3 gyroscopic_torque(std::int64_t k) const {
        return cross(omega.load(k), as_symmetric(group.bodies.inertia[k]) * omega.load(k));
    }
    /// External force on body k, W.
    Vec3 outside_force(std::int64_t k) const;
    /// Force of the terms that act in the axes of body k, B.
    Vec3 force_of_terms(std::int64_t k) const;
    /// Forces and moments on one body, by origin.
    struct Terms;
    struct Pair {
        Vec3 force, torque;
    };
    /// Force and torque along a joint's axes, from the components along its directions.
    Pair along_axes(ConstDirectionsView forces, std::int64_t at, Screw<double> const&) const;
    /// Constraint force of the outboard joint of body k, along that joint's axes.
    Pair outboard_pair(std::int64_t k) const;
    /// Adds the reaction to the constraint force of a joint, given along its axes, to the terms of
    /// the inboard body. `handle_of`: place of that body's handle.
    void add_reaction(std::int64_t handle_of, Pair const& outboard, Terms&) const;
    /// Terms of the Newton-Euler equations of body k.
    Terms terms(std::int64_t k) const;
    /// Variant of terms() for the equations that are solved: in planar chains only moments about
    /// the axis are.
    Terms terms_solved_for(std::int64_t k) const;
    /// Moment J alpha of body k, about the axis in planar chains.
    Vec3 inertial_moment(std::int64_t k) const;
    /// Acceleration of the handle at r, and the sizes of its terms.
    Vector<double, 8> handle(std::int64_t k, Vec3 const& r, Mat3 const& axes) const;
    /// Value of handle() at handle 2 of the last body on the inboard neighbour's rank. Collective.
    Vector<double, 8> handle_before_first(Communicator const&) const;
    /// Value of handle() at handle 2 of the body inboard of body k.
    Vector<double, 8> handle_before(std::int64_t k, Vector<double, 8> const& before_first) const;
    /// For each of the group's tips, handle() of what it is joined to: the ground, or handle 1 of a
    /// ring's first body. Collective.
    std::vector<Vector<double, 8>> handles_at_tips(Communicator const&) const;
    /// Relative acceleration of an implicit joint that its constraint force causes through its
    /// compliance, along the last three directions; 0 for other joints.
    Vec3 yielded(std::int64_t k) const;
    /// Relative acceleration of two handles along the restricted directions, plus the bias; 0 for a
    /// perfect solution.
    static Vector<double, 6> opening(Vector<double, 8> const& outboard,
                                     Vector<double, 8> const& inboard,
                                     Vector<double, 6> const& bias, Screw<double> const&,
                                     int restricted);
    /// Relative residual of a joint's closing.
    static double closing(Vector<double, 8> const& outboard, Vector<double, 8> const& inboard,
                          Vector<double, 6> const& bias, Screw<double> const&, int restricted,
                          double size, Vec3 const& yielded);
    /// Values of handle() on the outboard and the inboard side of a loop's joint.
    std::pair<Vector<double, 8>, Vector<double, 8>> handles_of_loop(std::size_t loop) const;
    /// Largest residual of a loop's closing.
    double residual_of_loops() const;
};

/// Potential energy of bodies at `motion`, which must include positions.
PotentialEnergy potential_of(ChainGroup const&, BodyLoads const&, Field<4> const& q,
                             BodyMotion const& motion);

}  // namespace catena
