// Integrators in joint coordinates. Constraint violation occurs only at jointed tips, which must be
// closed after every time step (ChainSystem::close_tips()).
#pragma once

#include <memory>
#include <optional>

#include "dynamics/joint/joint_operation.hpp"
#include "integrate/chain_system.hpp"
#include "io/output.hpp"

namespace catena {

class StepControl;

/// Number of sweeps per time step of an integrator in joint coordinates. There are as many passes
/// of the kinematics as bias sweeps.
struct SweepsAStep {
    int matrices = 1, biases = 1;
    int closings = 1;  // closings of jointed tips, whose sweeps are not included above
};

/// An integrator of all groups in joint coordinates.
class JointIntegrator {
  public:
    virtual ~JointIntegrator() = default;
    /// Advances the states and times of all groups by a time step h. Collective.
    virtual void step(double h) = 0;
    /// Computes what the next step needs besides the states, unless it is available. Collective.
    virtual void prepare() {}
    /// Sets the groups' time at step 0, from which the noise counts steps. It is not 0 in a branch
    /// with another time step.
    virtual void set_origin(double /*time*/) {}
    /// True if accelerations are carried from step to step, in the groups' carried rates.
    virtual bool carries_rates() const { return false; }
    /// Sets the number of corrections of jointed tips that are closed between inner steps.
    virtual void close_with(int /*corrections*/) {}
    /// Returns the sweeps of the last step if steps differ in their number.
    virtual std::optional<SweepsAStep> last_step() const { return std::nullopt; }
    /// Returns the controller of inner steps; null if there are none.
    virtual StepControl const* control() const { return nullptr; }
    /// Saves what the integrator needs besides states and rates.
    virtual void save(Checkpoint&) const {}
    /// Called after states and rates have been set to those of this checkpoint.
    virtual void restored(Checkpoint const&) {}
};

/// True if steps in joint coordinates assemble matrices in a sweep of their own. Forces are
/// computed meanwhile, or the matrices are needed again (ChainSystem::solves_once()).
inline bool keeps_matrices(Scene const& scene) {
    return scene.forces.openmm || scene.solver.refine > 0 || !is_refined(scene.dynamics.integrator);
}
/// True if a chain of the scene has a jointed tip, as rings have, or loops.
bool has_closures(Scene const&);
/// Returns the sweeps per time step, with an adaptive step per inner step; zeros for integrators in
/// absolute coordinates. `tips`: has_closures() of the scene.
SweepsAStep sweeps_a_step(DynamicsSpec const&, bool tips);
/// Makes the integrator that the scene's dynamics names. But for the Dormand-Prince pair each is a
/// program (joint_program.hpp):
///
/// - `rk4`: the classical fourth-order Runge-Kutta integrator (that of the DCA chapter).
///   Quaternions follow q' = 1/2 q (0, omega) and are normalised at the end of the step.
/// - `velocity-verlet`: velocity Verlet for accelerations that depend on velocities, with one
///   evaluation per step and second order (Groot & Warren, J. Chem. Phys. 107, 4423, 1997, with
///   lambda = 1). q is advanced by h q' + h^2/2 q'', and the acceleration is evaluated there with
///   q' + h q''. Then q' is advanced by h times the mean of both accelerations. Orientations are
///   advanced by the exponential of that rotation vector.
/// - `leapfrog`: drift-kick-drift of second order. Accelerations are those in the middle of the
///   step, with velocities in the middle of the kick. Nothing is carried from step to step.
/// - `staggered`: kick-drift-kick of second order with one matrix sweep per step.
///   Velocity-dependent forces are evaluated at the middle of the kick, where a first bias sweep
///   finds the velocities. With springs K and dampers C of implicit joints (JointDynamics) it is
///   the staggered scheme (src/dca/README.md, "Implicit joint springs"). Its rotors are B = c h^2 K
///   + h C / 2 (rotor_of_spring()). It is stable however stiff they are: it equals velocity Verlet
///   of a chain with a rotor of inertia B in every joint.
/// - `baoab`, `implicit-baoab`: the same with friction is Langevin dynamics: an
///   Ornstein-Uhlenbeck step in the middle of the drift (BAOAB: Leimkuhler & Matthews, J. Chem.
///   Phys. 138, 174102, 2013). Its velocities have the covariance kt (M + B)^-1 at the present
///   configuration. B changes how fast the chain moves. Positions sample harmonic springs exactly
///   at any time step. A rotor changes no more than the weight sqrt(det(M + B)) of rigid joints.
std::unique_ptr<JointIntegrator> make_joint_integrator(ChainSystem&, DynamicsSpec const&);

/// A substep of an adaptive integrator, within a step of given length.
struct InnerStep {
    /// Time at its start, length, and time at its end, ps.
    double start = 0, length = 0, end = 0;
    bool again = false;  // Repeats from the start of the last substep, which was rejected.
};
/// Returns a stage of the Dormand-Prince pair, and the weights of the difference of its solutions.
EmbeddedStage embedded_stage(int stage, InnerStep const&);
EmbeddedDifference embedded_difference(double length);
/// Makes the Dormand-Prince integrator (dormand_prince.cpp); quaternions are treated as under
/// `rk4`. With a tolerance, a step consists of inner steps whose lengths StepControl chooses.
/// The last one ends where the step does. With tolerance 0, a step is one step of fifth order.
std::unique_ptr<JointIntegrator> make_dormand_prince(ChainSystem&, double tolerance, double step);

/// Parameters of a Langevin thermostat: friction (1/time), Boltzmann constant times temperature,
/// seed.
struct JointThermostat {
    double friction = 0, kt = 0;
    std::uint64_t seed = 1;
};

/// Makes ghost lists now if they are due. They belong to the step at which they were requested: a
/// restart makes them there. Collective.
void make_ghosts(ChainSystem&);

}  // namespace catena
