// Independent solvers that the divide-and-conquer backends are checked against. They read ChainSpec
// itself, share no model, no kinematics and no operator with the solver, and run in any of three
// scalars: double, long double, Quad. Frames: W ground axes, B body axes. Units: those of the
// chain. Nothing here is tuned.
#pragma once

#include <vector>

#include "math/linear.hpp"
#include "oracle/quad.hpp"
#include "scene/scene.hpp"

namespace catena::oracle {

/// What acts on a chain beside the wrenches, torques, springs and dampers that its ChainSpec holds.
struct Loads {
    Vec3 gravity = Vec3::zero();  // W
    std::vector<Vec3>
        bead_forces;  // W, one a bead (bodies, linked: one a carried bead, in order); empty: zero
    double linear_drag = 0,
           angular_drag =
               0;  // force -linear v, torque -angular omega on every body without a drag of its own
    std::vector<std::pair<Vec3, Vec3>> wrenches =
        {};           // bodies of a linked chain: external {torque, force} at com, W; empty: zero
    double time = 0;  // at which driven joints are taken
    /// Rigid bodies: acceleration {angular, linear} (of the body's origin, W) by which each inboard
    /// joint fails to close: what an error in those equations comes to. Empty: zero.
    std::vector<std::pair<Vec3, Vec3>> gaps = {};
    /// The same of beads and linked bodies: along each link, outboard end less inboard end, that of
    /// a jointed tip behind the last.
    std::vector<double> link_gaps = {};
};

template <class Scalar>
struct SpatialForce {
    Vector<Scalar, 3> torque = Vector<Scalar, 3>::zero();
    Vector<Scalar, 3> force = Vector<Scalar, 3>::zero();
};

/// Accelerations and joint forces of one chain; entry k belongs to body (bead) k + 1.
template <class Scalar>
struct OracleResult {
    /// Rigid bodies: second derivatives of the coordinates, as qd: {q'', 0, 0}; universal {q1'',
    /// q2'', 0}; weld zeros; spherical and free: time derivative of qd's components, B; driven:
    /// what the course prescribes. Empty for beads.
    std::vector<Vector<Scalar, 3>> qdd;
    /// Free base: acceleration of the origin of body 1 (second time derivative of its position), W.
    /// Zero otherwise.
    Vector<Scalar, 3> base_acceleration = Vector<Scalar, 3>::zero();
    std::vector<Vector<Scalar, 3>> com_acceleration;  // centre of mass, or bead, W
    std::vector<Vector<Scalar, 3>> alpha;             // angular acceleration, W. Empty for beads
    /// Whole wrench that the inboard joint exerts on the body, W, torque about the body's origin:
    /// the constraint's (a drive's included) and that of the joint's given torque, spring and
    /// damper. A free body 1: zero. Empty for beads.
    std::vector<SpatialForce<Scalar>> joint_force;
    /// The constraint's part D lambda alone. With P the joint's directions it obeys P^T f = 0, and
    /// the rest of joint_force, P (P^T P)^-1 tau, lies in the span of P (src/dca/README.md,
    /// "Joints": D^T T = 0). Driven: all of joint_force.
    std::vector<SpatialForce<Scalar>> constraint_force;
    /// Beads and linked bodies: tension of the inboard link, positive when it pulls its two ends
    /// together. Free base: entry 0 is zero.
    std::vector<Scalar> tension;
    /// Jointed tip: wrench of the tip joint on the last body, W, torque about the origin of the
    /// tip's joint frame (the one fixed in the last body). A tip link: its force on the last bead,
    /// or on the last body's `outboard` point.
    SpatialForce<Scalar> tip_force;
};

/// Articulated-body algorithm (Featherstone, Rigid Body Dynamics Algorithms, 2008, section 7.3) in
/// body axes, about the joints, O(n). Accelerations are those of points (not Featherstone's spatial
/// ones): linear velocities then do not enter, and nothing large has to cancel far from the base.
/// Beads: articulated 3 x 3 masses. Jointed tips: the open chain's answer and its answers to unit
/// wrenches at the tip, then the small system of the tip joint. Linked bodies: the scalar
/// tridiagonal system of the link forces by elimination; their rings: dense(). Where a tip holds a
/// chain more than once (a planar chain on joints that hold it in its plane anyway), accelerations
/// are unique and joint forces are one choice of many. Preconditions: validated chain, velocities
/// that fit the tip. Throws ComputationError (body index) when an articulated inertia is not
/// positive definite.
template <class Scalar>
OracleResult<Scalar> aba(ChainSpec const& chain, Loads const& loads);

/// The same from one dense linear system: Newton and Euler of every body and the closure of every
/// joint (second time derivative; the tip's too) for all accelerations and all joint forces at
/// once, in ground axes, by LU with partial pivoting and one step of iterative refinement. Cost (12
/// n)^3: n of some hundreds at most.
template <class Scalar>
OracleResult<Scalar> dense(ChainSpec const& chain, Loads const& loads);

template <class Scalar>
struct Kinematics {
    std::vector<Matrix<Scalar, 3, 3>> orientation;  // R_WB. Empty for beads, as omega
    std::vector<Vector<Scalar, 3>> origin;          // of the body, W
    std::vector<Vector<Scalar, 3>> com_position;    // W
    std::vector<Vector<Scalar, 3>> com_velocity;    // W
    std::vector<Vector<Scalar, 3>> omega;           // absolute, W
    Scalar kinetic_energy = Scalar(0);
    Scalar potential_energy = Scalar(0);  // gravity: - sum m g . com
    Scalar spring_energy = Scalar(0);     // joint springs: 1/2 sum k e^2 in the coordinates
                                          // (spherical: in the rotation vector e)
};

/// Forward kinematics and energies.
template <class Scalar>
Kinematics<Scalar> kinematics(ChainSpec const& chain, Loads const& loads);

/// Recursive Newton-Euler inverse dynamics (Featherstone 2008, section 5.3) of given accelerations:
/// per joint the torque they need less the torque that acts, over the largest term of that joint's
/// own balance (moments; prismatic: forces); the largest ratio of the chain. Driven joints take
/// whatever they need. A free base adds the force balance of the whole. Beads: `accelerations` are
/// the beads', and the ratio is the part of a link's force across the link. Jointed tips: under the
/// tip force that fits best (least squares). Linked bodies are not covered: ComputationError.
/// Information, no measure of a solver at large n: it grows with the condition number. Shapes:
/// accelerations[k] as OracleResult::qdd (beads: com_acceleration).
template <class Scalar>
Scalar rnea_residual(ChainSpec const& chain, Loads const& loads,
                     std::vector<Vector<Scalar, 3>> const& accelerations,
                     Vector<Scalar, 3> const& base_acceleration = Vector<Scalar, 3>::zero());

/// 2-norm condition number of the joint-space inertia, column by column from inverse dynamics and
/// then dense eigenvalues (rigid bodies, without driven joints; a free base counts with 6; a
/// jointed tip is left out), or of the links' matrix G M^-1 G^T (beads and linked bodies, a tip
/// link included). O(n^3): moderate n. In double precision: trustworthy up to some 1e13, never
/// above 1 / eps.
double condition_estimate(ChainSpec const& chain, Loads const& loads = {});

/// Makes the velocities (qd, free_velocity; beads and linked bodies: velocity, omega) fit a jointed
/// tip and every link: the least change (sum of squares of the numbers), to rounding. Driven joints
/// keep the rates they have at `time`.
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
