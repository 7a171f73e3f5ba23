// Independent reference solvers ("oracles") for checks of the divide-and-conquer backends. They
// read ChainSpec themselves and share no model, kinematics or operator with the solver. They run in
// three scalars: double, long double and Quad. Frames: W ground axes, B body axes. Units are those
// of the chain. The code is not optimised.
#pragma once

#include <vector>

#include "math/linear.hpp"
#include "oracle/quad.hpp"
#include "scene/scene.hpp"

namespace catena::oracle {

/// Loads on a chain in addition to the constant wrenches, torques, springs and dampers of its
/// ChainSpec.
struct Loads {
    Vec3 gravity = Vec3::zero();  // W
    /// Forces on beads, W, one per bead (bodies and linked chains: one per carried bead, in order).
    /// Empty: zero.
    std::vector<Vec3> bead_forces;
    /// Drag coefficients: force -linear_drag v, torque -angular_drag omega on every body without
    /// its own drag.
    double linear_drag = 0, angular_drag = 0;
    /// External {torque, force} at com on each body of a linked chain, W. Empty: zero.
    std::vector<std::pair<Vec3, Vec3>> wrenches = {};
    double time = 0;  // time for prescribed motion
    /// Rigid bodies: error {angular, linear} of the closure of each inboard joint, as an
    /// acceleration of the body's origin, W. It shows the effect of errors in those equations.
    /// Empty: zero.
    std::vector<std::pair<Vec3, Vec3>> gaps = {};
    /// Beads and linked bodies: error of the closure along each link, outboard end minus inboard
    /// end. The entry of a jointed tip follows the last one. Empty: zero.
    std::vector<double> link_gaps = {};
};

/// Wrench: torque about a stated point, and force.
template <class Scalar>
struct SpatialForce {
    Vector<Scalar, 3> torque = Vector<Scalar, 3>::zero();
    Vector<Scalar, 3> force = Vector<Scalar, 3>::zero();
};

/// Accelerations and joint forces of one chain; entry k belongs to body (bead) k + 1.
template <class Scalar>
struct OracleResult {
    /// Rigid bodies: second derivatives of the coordinates, with components as in qd: {q'', 0, 0};
    /// universal {q1'', q2'', 0}; weld zeros. Spherical and free joints: time derivative of qd's
    /// components, B. Prescribed motion: its second derivative. Empty for beads.
    std::vector<Vector<Scalar, 3>> qdd;
    /// Free base: acceleration of the origin of body 1 (second time derivative of its position), W.
    /// It is zero for other bases.
    Vector<Scalar, 3> base_acceleration = Vector<Scalar, 3>::zero();
    std::vector<Vector<Scalar, 3>> com_acceleration;  // centre of mass or bead, W
    std::vector<Vector<Scalar, 3>> alpha;             // angular acceleration, W; empty for beads
    /// Total wrench that the inboard joint exerts on the body, W, with torque about the body's
    /// origin. It is the sum of the constraint wrench (including that of prescribed motion) and of
    /// the joint's given torque, spring and damper. It is zero for a free body 1. Empty for beads.
    std::vector<SpatialForce<Scalar>> joint_force;
    /// Constraint wrench D lambda alone. It satisfies P^T f = 0, with P the joint's directions. The
    /// rest of joint_force, P (P^T P)^-1 tau, lies in the span of P (src/dca/README.md, "Joints":
    /// D^T T = 0). For prescribed motion it equals joint_force.
    std::vector<SpatialForce<Scalar>> constraint_force;
    /// Beads and linked bodies: tension of the inboard link, positive if it pulls its two ends
    /// together. Entry 0 of a free base is zero.
    std::vector<Scalar> tension;
    /// Tension of each cross-link.
    std::vector<Scalar> crosslink_tension;
    /// Jointed tip: wrench of the tip joint on the last body, W. The torque is about the origin of
    /// the tip's joint frame, which is fixed in the last body. Tip link: its force on the last
    /// bead, or on the last body's `outboard` point.
    SpatialForce<Scalar> tip_force;
};

/// Articulated-body algorithm (Featherstone, Rigid Body Dynamics Algorithms, 2008, section 7.3) in
/// body axes, about the joints, O(n). Accelerations are those of points, not Featherstone's spatial
/// accelerations. Linear velocities then do not enter, and no large terms cancel far from the base.
///
/// Beads have articulated 3 x 3 masses. With a jointed tip or loops, the open chain is solved under
/// the loads and under unit wrenches at the tip; a small system for the tip joint follows. Linked
/// bodies are solved by elimination in the scalar tridiagonal system of the link forces; their
/// rings by dense(). A tip may constrain a chain redundantly (a planar chain whose joints already
/// keep it in its plane). Accelerations are then unique, but joint forces are one choice of many.
///
/// Preconditions: validated chain, velocities consistent with the tip. Throws ComputationError
/// (body index) if an articulated inertia is not positive definite.
template <class Scalar>
OracleResult<Scalar> aba(ChainSpec const& chain, Loads const& loads);

/// Solves the same problem as one dense linear system in ground axes. Its equations are Newton's
/// and Euler's equations of every body, and the second time derivative of every joint's closure,
/// the tip's included. The unknowns are all accelerations and joint forces. The method is LU with
/// full pivoting and one step of iterative refinement. Cost (12 n)^3: n of some hundreds at most.
template <class Scalar>
OracleResult<Scalar> dense(ChainSpec const& chain, Loads const& loads);

/// Positions, velocities and energies of one chain.
template <class Scalar>
struct Kinematics {
    std::vector<Matrix<Scalar, 3, 3>> orientation;  // R_WB; empty for beads, as is `omega`
    std::vector<Vector<Scalar, 3>> origin;          // body origin, W
    std::vector<Vector<Scalar, 3>> com_position;    // W
    std::vector<Vector<Scalar, 3>> com_velocity;    // W
    std::vector<Vector<Scalar, 3>> omega;           // absolute, W
    Scalar kinetic_energy = Scalar(0);
    Scalar potential_energy = Scalar(0);  // gravity: - sum m g . com
    /// Energy of the joint springs: 1/2 sum k e^2 in the coordinates (spherical: in the rotation
    /// vector e).
    Scalar spring_energy = Scalar(0);
};

/// Computes forward kinematics and energies.
template <class Scalar>
Kinematics<Scalar> kinematics(ChainSpec const& chain, Loads const& loads);

/// Residual of given accelerations by recursive Newton-Euler inverse dynamics (Featherstone 2008,
/// section 5.3). For each joint, the required torque minus the acting torque is divided by the
/// largest term of that joint's balance (moments; prismatic: forces). The result is the largest
/// ratio of the chain. Prescribed motion takes any torque. A free base adds the force balance of
/// the whole chain. Beads: `accelerations` are those of the beads, and the ratio measures the
/// component of a link's force across the link. Jointed tips: the tip force is the least-squares
/// fit. Throws ComputationError for linked bodies and for loops.
///
/// The residual is information only, no measure of a solver at large n, because it grows with the
/// condition number. Shapes: accelerations[k] as OracleResult::qdd (beads: com_acceleration).
template <class Scalar>
Scalar rnea_residual(ChainSpec const& chain, Loads const& loads,
                     std::vector<Vector<Scalar, 3>> const& accelerations,
                     Vector<Scalar, 3> const& base_acceleration = Vector<Scalar, 3>::zero());

/// Estimates a 2-norm condition number by dense eigenvalues, O(n^3), for moderate n. Rigid bodies:
/// condition of the joint-space inertia, computed column by column from inverse dynamics. Joints
/// with prescribed motion count as locked. A free base counts with 6 coordinates; a jointed tip is
/// left out. Beads and linked bodies: condition of the links' matrix G M^-1 G^T, a tip link
/// included. In double precision the estimate is reliable up to about 1e13 and never exceeds 1 /
/// eps.
double condition_estimate(ChainSpec const& chain, Loads const& loads = {});

/// Makes the velocities (qd, free_base.velocity; beads and linked bodies: velocity, omega)
/// consistent with a jointed tip, loops and every link. The change has the least sum of squares, up
/// to rounding. Joints with prescribed motion keep their rates at `time`.
void project_velocities(ChainSpec& chain, double time = 0);

#define CATENA_ORACLE(Scalar)                                                              \
    extern template OracleResult<Scalar> aba<Scalar>(ChainSpec const&, Loads const&);      \
    extern template OracleResult<Scalar> dense<Scalar>(ChainSpec const&, Loads const&);    \
    extern template Kinematics<Scalar> kinematics<Scalar>(ChainSpec const&, Loads const&); \
    extern template Scalar rnea_residual<Scalar>(ChainSpec const&, Loads const&,           \
                                                 std::vector<Vector<Scalar, 3>> const&,    \
                                                 Vector<Scalar, 3> const&);
CATENA_ORACLE(double)
CATENA_ORACLE(long double)
CATENA_ORACLE(Quad)
#undef CATENA_ORACLE

}  // namespace catena::oracle
