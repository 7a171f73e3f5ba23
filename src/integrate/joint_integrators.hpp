// Steps in joint coordinates: nothing drifts apart but jointed tips, which are to be closed after
// every step (ChainSystem::close_tips).
#pragma once

#include <memory>
#include <optional>

#include "integrate/chain_system.hpp"
#include "io/output.hpp"

namespace catena {

class StepControl;

/// Of an integrator in joint coordinates. As many bias sweeps, so many passes of the kinematics.
struct SweepsAStep {
    int matrices = 1, biases = 1;
    int closings = 1;  // of jointed tips, whose own sweeps are not among those
};

class JointIntegrator {
  public:
    virtual ~JointIntegrator() = default;
    /// One step of length h of all groups' states, whose time is their own. Collective.
    virtual void step(double h) = 0;
    /// What the next step needs beside the states is made where it is not there yet. Collective.
    virtual void prepare() {}
    /// The groups' time at step 0, from where noise counts steps: not 0 in a branch with another
    /// step.
    virtual void set_origin(double /*time*/) {}
    /// Whether that is the groups' carried rates.
    virtual bool carries_rates() const { return false; }
    /// Corrections of jointed tips within a step, where these are closed between inner steps.
    virtual void close_with(int /*corrections*/) {}
    /// Of the last step, where not all are alike.
    virtual std::optional<SweepsAStep> last_step() const { return std::nullopt; }
    /// Of inner steps; null where there are none.
    virtual StepControl const* control() const { return nullptr; }
    /// What it needs beside states and rates; these were set from outside, to those of this
    /// checkpoint.
    virtual void save(Checkpoint&) const {}
    virtual void restored(Checkpoint const&) {}
};

/// Whether its solutions are refined `solver.refine` times: those of the others are solved for more
/// than once with one matrix.
inline bool is_refined(Integrator i) { return i <= Integrator::velocity_verlet; }
/// Whether steps in joint coordinates assemble matrices by themselves: forces are computed
/// meanwhile, or they are needed again (ChainSystem::solves_once()).
inline bool keeps_matrices(Scene const& scene) {
    return scene.forces.openmm || scene.solver.refine > 0 || !is_refined(scene.dynamics.integrator);
}
bool has_jointed_tips(Scene const&);
/// `tips`: whether the scene has jointed ones. Of an adaptive step: of one inner step.
SweepsAStep sweeps_a_step(DynamicsSpec const&, bool tips);
/// The one that the scene's dynamics names.
std::unique_ptr<JointIntegrator> make_joint_integrator(ChainSystem&, DynamicsSpec const&);

/// The classical fourth-order Runge-Kutta step (the chapter's integrator). Quaternions follow q' =
/// 1/2 q (0, omega) and are normalised at the end of the step.
std::unique_ptr<JointIntegrator> make_runge_kutta4(ChainSystem&);

/// The Dormand-Prince pair (embedded_steps.hpp), quaternions as under Runge-Kutta. With a tolerance
/// a step is made of inner steps whose lengths StepControl chooses; the last one ends where the
/// step does. Without it (0) a step is one of fifth order.
std::unique_ptr<JointIntegrator> make_dormand_prince(ChainSystem&, double tolerance, double step);

/// Velocity Verlet for accelerations that depend on velocities, one evaluation a step, second order
/// (Groot & Warren, J. Chem. Phys. 107, 4423, 1997, with lambda = 1): q moves by h q' + h^2/2 q'',
/// the acceleration is taken there with q' + h q'', and q' gets the mean of both accelerations.
/// Orientations move by the exponential of that rotation vector.
std::unique_ptr<JointIntegrator> make_velocity_verlet(ChainSystem&);

/// Kick, drift, kick with velocity-dependent forces at the kick's middle, whose velocities a first
/// bias sweep finds: second order, one matrix sweep per step. With springs K and dampers C of
/// implicit joints (JointDynamics) it is the staggered scheme (src/dca/README.md, "Implicit joint
/// springs"), B = c h^2 K + h C / 2 (rotor_of_spring()), stable however stiff they are: velocity
/// Verlet of a chain with a rotor of inertia B in every joint.
///
/// With friction Langevin dynamics: an Ornstein-Uhlenbeck step in the middle of the drift (BAOAB:
/// Leimkuhler & Matthews, J. Chem. Phys. 138, 174102, 2013), whose velocities have the covariance
/// kt (M + B)^-1 of where the chain is. How fast the chain moves depends on B; where it is,
/// harmonic springs sample exactly at any step, for a rotor changes no more than the weight
/// sqrt(det(M + B)) of rigid joints.
struct JointThermostat {
    double friction = 0, kt = 0;
    std::uint64_t seed = 1;
};
std::unique_ptr<JointIntegrator> make_kicks(ChainSystem&, JointThermostat const&);

/// Lists of ghosts belong to the step at which they were asked for: a restart makes them there.
void make_ghosts(ChainSystem&);

}  // namespace catena
