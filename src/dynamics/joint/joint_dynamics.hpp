// Forward dynamics of body chains in joint coordinates: accelerations from the state by one matrix
// sweep and one bias sweep. The object holds the state, on the host or on a GPU. Frames: W ground
// axes, B body axes. Units: nm, ps, amu, kJ/mol, rad, unless the scene has `units: si`.
#pragma once

#include <memory>

#include "dca/solver.hpp"
#include "dynamics/absolute_dynamics.hpp"
#include "dynamics/constrained_step.hpp"
#include "kinematics/joint_kinematics.hpp"

namespace catena {

/// Time derivatives of the velocities of JointState, on the host. RatesView documents the fields.
struct JointRates {
    Field<3> qdd, base_acceleration;
};

/// A substep of an adaptive integrator, within a step of given length.
struct InnerStep {
    /// Length of the substep, and the time at its end, ps.
    double length = 0, end = 0;
    bool again = false;  // Repeats from the start of the last substep, which was rejected.
};
/// Largest velocities of each kind, rad/ps and nm/ps. Those of free bases and sliding joints are
/// linear.
struct Speeds {
    double angular = 0, linear = 0;
};
/// Error tolerances of a substep: coordinates (angles and lengths) and velocities.
struct AllowedErrors {
    double angle = 0, length = 0;
    Speeds speed;
};

/// State and equations of motion of a group of chains in joint coordinates. An integrator builds a
/// step from its operations; observers read results.
class JointDynamics : public BeadHost {
  public:
    /// Coordinates and velocities of bodies and free bases, copied to the host.
    virtual JointState state() const = 0;
    virtual void set_state(JointState const&) = 0;
    /// Time of the state, ps; prescribed motions depend on it.
    double time() const { return time_; }
    void set_time(double time) { time_ = time; }

    /// Computes the motion, the loads that depend on the state alone and the positions of carried
    /// beads. Clears the forces on these beads. Collective.
    virtual void update_configuration() = 0;
    /// Variant of update_configuration() before solve_once(). It omits what the solver can compute
    /// itself. Collective.
    virtual void update_to_solve_once() = 0;
    /// Assembles the matrices at the last updated configuration. Needs no forces. Collective.
    virtual void assemble_matrices() = 0;
    /// Computes accelerations of bodies at the last updated configuration with the current forces.
    /// Collective.
    virtual void solve() = 0;
    /// Fuses assemble_matrices() and solve(), for use when there is no force computation to overlap
    /// with. The matrices are not kept, and the last bits of the result may differ. Collective.
    virtual void solve_once() = 0;
    /// Solves at the same coordinates with the current velocities. The matrices and the forces on
    /// carried beads are reused. Collective.
    virtual void solve_again() = 0;
    /// Computes the rates (second derivatives of coordinates) after solve().
    virtual void set_rates() = 0;
    /// Measures update_to_solve_once(), solve_once() and set_rates() together, in seconds. Returns
    /// `repeat` means over `chained` consecutive evaluations. Precondition: all three have been
    /// called before. Collective.
    virtual std::vector<double> time_at_once(int chained, int repeat) = 0;
    /// One step of iterative refinement of the last solve(): the residual of the equations of
    /// bodies and joints is solved for with the same matrices and added. It restores digits that
    /// are lost where the forces on a body nearly cancel, because accelerations are stored
    /// separately from forces. `executor` computes the residual on the host. Collective.
    virtual void refine(Executor const& executor) = 0;
    /// Change of bodies' accelerations by the last refine(), relative to their size: an estimate of
    /// the relative error before it. Returns the larger value of angular and linear accelerations.
    /// Accelerations near zero are compared with those that gravity and the loads would give the
    /// chains as a whole. NaN if anything is not finite. Precondition: refine() was called.
    /// Collective.
    virtual double correction() = 0;
    /// Copies the last set rates to the host.
    virtual JointRates rates() const = 0;

    // Steps, stage by stage. Each stage except the first half of a Verlet step follows a solve().
    /// Stage 0, 1, 2 or 3 of a Runge-Kutta step of length h.
    virtual void runge_kutta(int stage, double h) = 0;
    /// Stage 0 to 5 of a step of the Dormand-Prince pair (embedded_steps.hpp), which starts from
    /// the carried accelerations. The start of the step is kept, so that a step with `again` can
    /// repeat it.
    virtual void embedded_stage(int stage, InnerStep const&) = 0;
    /// Measure of how implausible the next stage is, for a step of this length, on this rank. Its
    /// equations are worth solving if it is below 1.
    virtual double stage_divergence(double length) = 0;
    /// Largest velocities at the two ends of the last substep, on this rank.
    virtual Speeds fastest() = 0;
    /// Largest error of the last substep relative to the tolerances, on this rank; NaN if anything
    /// is not finite. Precondition: another solve() at the substep's end.
    virtual double embedded_error(double length, AllowedErrors const&) = 0;
    /// Characteristic length: contour length of the longest chain plus the size of a body, nm.
    /// Returns the same value on every rank.
    virtual double reach() const = 0;
    /// Carries the accelerations of the last solve(). Velocity Verlet and the Dormand-Prince pair
    /// carry accelerations from step to step.
    virtual void carry_rates() = 0;
    /// Carries the given accelerations instead, such as those of a checkpoint.
    virtual void carry_rates(JointRates const&) = 0;
    virtual JointRates carried_rates() const = 0;
    /// First half of a velocity Verlet step of length h: coordinates, and a first guess of
    /// velocities.
    virtual void verlet_move(double h) = 0;
    /// Second half: final velocities, after a solve() with the guess.
    virtual void verlet_finish(double h) = 0;

    /// Drift: advances coordinates by h at the current velocities. These are kept as the start of
    /// kick().
    virtual void drift(double h) = 0;
    /// Kick: sets velocities to those kept by drift() plus h times the last solved accelerations.
    virtual void kick(double h) = 0;
    /// Kick: adds h times the carried accelerations to the current velocities.
    virtual void kick_by_carried(double h) = 0;
    /// Thermostat: velocities become keep u + spread xi, with xi normal noise. The covariance of xi
    /// is the inverse of the mass matrix at the current coordinates, including the parts of springs
    /// and dampers. `step` keys the noise. Collective.
    virtual void thermalise(Thermostat const&, std::uint64_t step) = 0;

    /// Computes the motion at the current state, positions included, and copies it to the host.
    /// Collective.
    virtual BodyMotion motion() = 0;
    /// Results of the last solution, W. Precondition, as for residual() and refine(): nothing has
    /// changed since. Collective.
    virtual BodyResults results() = 0;
    /// Largest local backward residual of the last solution over all ranks
    /// (JointSolution::residual()). Collective.
    virtual double residual(Executor const&) = 0;
    /// Potential energy at the current state. Collective.
    virtual PotentialEnergy potential() = 0;
    /// Default number of Newton steps that close tips.
    static constexpr int usual_corrections = 2;
    /// Closes jointed tips again: `corrections` Newton steps for positions, then one for
    /// velocities. Each correction is the smallest in the metric of the masses. Does nothing
    /// without jointed tips. Collective.
    virtual void close_tips(int corrections = usual_corrections) = 0;
    /// Largest opening of a jointed tip over all ranks, relative to reach(); NaN if the state is
    /// not finite. Collective.
    virtual double closure_error() = 0;
    virtual ChainSolver& solver() const = 0;

  protected:
    double time_ = 0;
};

/// Dynamics on the host. `implicit_step`: the step length h of implicit joint springs; 0 for
/// explicit ones.
std::unique_ptr<JointDynamics> make_joint_dynamics(ChainGroup const&, Scene const&, Executor const&,
                                                   Communicator const&,
                                                   std::unique_ptr<ChainSolver>,
                                                   double implicit_step = 0);

}  // namespace catena
