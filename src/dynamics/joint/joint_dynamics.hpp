// Forward dynamics of body chains in joint coordinates: accelerations from the state by one matrix
// sweep and one bias sweep. The object holds the state, on the host or on a GPU. Frames: W ground
// axes, B body axes. Units: nm, ps, amu, kJ/mol, rad, unless the scene has `units: si`.
#pragma once

#include <memory>

#include "dca/solver.hpp"
#include "dynamics/absolute_dynamics.hpp"
#include "dynamics/joint/joint_operation.hpp"
#include "kinematics/joint_kinematics.hpp"

namespace catena {

/// Time derivatives of the velocities of JointState, on the host. RatesView documents the fields.
struct JointRates {
    Field<3> qdd, base_acceleration;
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

    // Steps, operator by operator. Those that use accelerations follow a solve().
    /// Applies an operator of a step of length h to the state and its time; `evaluate` and
    /// `evaluate_again` are not among them. Collective for `noise`.
    virtual void apply(JointOperation const&, double h) = 0;
    /// Applies a stage of an embedded pair. The start of the step is kept, so that it can be
    /// repeated.
    virtual void apply(EmbeddedStage const&) = 0;
    /// Measure of how implausible the next stage is, for a step of this length, on this rank. Its
    /// equations are worth solving if it is below 1.
    virtual double stage_divergence(double length) = 0;
    /// Largest velocities at the two ends of the last substep, on this rank.
    virtual Speeds fastest() = 0;
    /// Largest error of the last substep relative to the tolerances, on this rank; NaN if anything
    /// is not finite. Precondition: another solve() at the substep's end.
    virtual double embedded_error(EmbeddedDifference const&, AllowedErrors const&) = 0;
    /// Characteristic length: contour length of the longest chain plus the size of a body, nm.
    /// Returns the same value on every rank.
    virtual double reach() const = 0;
    /// Saved accelerations (JointOperator::save), on the host.
    virtual JointRates saved_rates() const = 0;
    /// Saves the given accelerations, such as those of a checkpoint.
    virtual void save_rates(JointRates const&) = 0;

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
