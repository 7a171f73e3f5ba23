// Forward dynamics of body chains in joint coordinates: accelerations from the state by one matrix
// sweep and one bias sweep. The object holds the state, on the host or on a GPU. Frames: W ground
// axes, B body axes. Units: nm, ps, amu, kJ/mol, rad, unless the scene has `units: si`.
#pragma once

#include <functional>
#include <memory>

#include "dca/solver.hpp"
#include "dynamics/absolute_dynamics.hpp"
#include "dynamics/joint/joint_operation.hpp"
#include "kinematics/joint_kinematics.hpp"

namespace catena {

struct JointDefect;
struct JointSolution;

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

/// Time of the state, and time at the start of the current step, ps.
struct JointClock {
    double now = 0, start = 0;
};

/// Extent of JointDynamics::update().
enum class JointUpdate : std::uint8_t {
    /// The motion, the loads that depend on the state alone and the positions of carried beads.
    /// Clears the forces on these beads.
    configuration,
    /// Everything before a solution `at_once`, without what the solver can compute itself.
    to_solve_once,
    /// Motion and loads at the same coordinates with the current velocities. Matrices and the
    /// forces on carried beads stay.
    velocities
};
/// Matrices of a solution: those assembled before, or such as are assembled with it and not kept.
/// The last bits of the result may differ.
enum class SolvedWith : std::uint8_t { assembled, at_once };
/// Rates on the host: those of the last solution, or those that JointOperator::save has kept.
enum class RatesOf : std::uint8_t { solution, saved };

/// Quantities whose largest value over bodies JointDynamics measures.
enum class JointQuantity : std::uint8_t {
    /// 0, or NaN if the state is not finite.
    trouble,
    /// Opening of jointed tips and loops relative to reach(), after computing the motion.
    /// Collective.
    opening,
    /// JointDynamics::stage_divergence().
    divergence,
    /// Velocities at the two ends of the last substep.
    angular_speed,
    linear_speed,
    /// JointDynamics::embedded_error().
    error
};
/// A quantity with what it depends on.
struct JointMeasure {
    JointQuantity what;
    double length = 0;  // Of `divergence`: the step's length.
    /// Parameters of `error`.
    EmbeddedDifference difference = {};
    AllowedErrors allowed = {};
};

/// State and equations of motion of a group of chains in joint coordinates. An integrator builds a
/// step from its operations; observers read results. A Space implements the virtual functions.
class JointDynamics : public BeadHost {
  public:
    ChainGroup const& group() const final { return group_; }
    ChainSolver& solver() const { return *solver_; }
    /// Time of the state, ps; prescribed motions depend on it.
    double time() const { return clock_.now; }
    void set_time(double time) { clock_.now = time; }
    /// Characteristic length: contour length of the longest chain plus the size of a body, nm.
    /// Returns the same value on every rank.
    double reach() const { return reach_; }
    /// Coordinates and velocities of bodies and free bases, copied to the host.
    JointState state() const {
        solver_->check();
        return read_state();
    }
    virtual void set_state(JointState const&) = 0;

    // Evaluations.

    /// Computes motion and loads. Collective.
    virtual void update(JointUpdate) = 0;
    void update_configuration() { update(JointUpdate::configuration); }
    void update_to_solve_once() { update(JointUpdate::to_solve_once); }
    /// Assembles the matrices at the last updated configuration. Needs no forces. Collective.
    void assemble_matrices() { apply({JointOperator::assemble}, 0); }
    /// Computes accelerations of bodies at the last updated configuration with the current forces.
    /// Collective.
    virtual void solve(SolvedWith) = 0;
    void solve() { solve(SolvedWith::assembled); }
    /// Fuses assemble_matrices() and solve(), for use when there is no force computation to overlap
    /// with. Collective.
    void solve_once() { solve(SolvedWith::at_once); }
    /// Solves at the same coordinates with the current velocities. Collective.
    void solve_again() {
        update(JointUpdate::velocities);
        solve();
    }
    /// Computes the rates (second derivatives of coordinates) after solve().
    void set_rates() { apply({JointOperator::set_rates}, 0); }
    /// Copies rates to the host.
    virtual JointRates rates(RatesOf = RatesOf::solution) const = 0;
    /// Measures update_to_solve_once(), solve_once() and set_rates() together, in seconds. Returns
    /// `repeat` means over `chained` consecutive evaluations. Precondition: all three have been
    /// called before. Collective.
    std::vector<double> time_at_once(int chained, int repeat);
    /// One step of iterative refinement of the last solve(): the residual of the equations of
    /// bodies and joints is solved for with the same matrices and added. It restores digits that
    /// are lost where the forces on a body nearly cancel, because accelerations are stored
    /// separately from forces. `executor` computes the residual on the host. Collective.
    void refine(Executor const& executor);
    /// Change of bodies' accelerations by the last refine(), relative to their size: an estimate of
    /// the relative error before it. Returns the larger value of angular and linear accelerations.
    /// Accelerations near zero are compared with those that gravity and the loads would give the
    /// chains as a whole. NaN if anything is not finite. Precondition: refine() was called.
    /// Collective.
    double correction();

    // Steps, operator by operator. Those that use accelerations follow a solve().

    /// Applies an operator of a step of length h to the state and its time; `evaluate` and
    /// `evaluate_again` are not among them. Collective for `assemble`, `noise` and `project`.
    virtual void apply(JointOperation const&, double h) = 0;
    /// Applies JointOperator::embedded_stage.
    void apply(EmbeddedStage const&);
    /// Measure of how implausible the next stage is, for a step of this length, on this rank. Its
    /// equations are worth solving if it is below 1.
    double stage_divergence(double length) { return largest({JointQuantity::divergence, length}); }
    /// Largest velocities at the two ends of the last substep, on this rank.
    Speeds fastest() {
        return {largest({JointQuantity::angular_speed}), largest({JointQuantity::linear_speed})};
    }
    /// Largest error of the last substep relative to the tolerances, on this rank; NaN if anything
    /// is not finite. Precondition: another solve() at the substep's end.
    double embedded_error(EmbeddedDifference const& difference, AllowedErrors const& allowed) {
        return largest({JointQuantity::error, 0, difference, allowed});
    }
    /// Saves the given accelerations, such as those of a checkpoint, as JointOperator::save does.
    virtual void save_rates(JointRates const&) = 0;
    /// Default number of Newton steps that close tips.
    static constexpr int usual_corrections = 2;
    /// Closes jointed tips and loops again: `corrections` Newton steps for positions, then one for
    /// velocities. Each correction is the smallest in the metric of the masses. Does nothing
    /// without any. Collective.
    void close_tips(int corrections = usual_corrections);
    /// Largest opening of a jointed tip or loop over all ranks, relative to reach(); NaN if the
    /// state is not finite. Collective.
    double closure_error();

    // Results.

    /// Computes the motion at the current state, positions included, and copies it to the host.
    /// Collective.
    virtual BodyMotion motion() = 0;
    /// Results of the last solution, W. Precondition, as for residual() and refine(): nothing has
    /// changed since. Collective.
    BodyResults results();
    /// Largest local backward residual of the last solution over all ranks
    /// (JointSolution::residual()). Collective.
    double residual(Executor const&);
    /// Potential energy at the current state. Collective.
    PotentialEnergy potential();

  protected:
    JointDynamics(ChainGroup const&, Scene const&, Communicator const&,
                  std::unique_ptr<ChainSolver>);

    /// Copies the state to the host.
    virtual JointState read_state() const = 0;
    /// Largest value of a quantity over this rank's bodies.
    virtual double largest(JointMeasure const&) = 0;
    /// Calls use() with the last solution, completed and copied to the host. Collective.
    virtual void with_solution(std::function<void(JointSolution const&)> const& use) = 0;
    /// Adds the solver's response to a defect to the last solution. Collective.
    virtual void add_response(JointDefect const&) = 0;
    /// Returns `repeat` times in seconds, each the mean of `chained` consecutive calls of `action`.
    virtual std::vector<double> time_chained(int chained, int repeat,
                                             std::function<void()> const& action) const = 0;

    ChainGroup const& group_;
    Communicator const& communicator_;
    std::unique_ptr<ChainSolver> solver_;
    BodyLoads given_;
    double reach_;
    JointClock clock_;
};

/// Dynamics on the host. `implicit_step`: the step length h of implicit joint springs; 0 for
/// explicit ones.
std::unique_ptr<JointDynamics> make_joint_dynamics(ChainGroup const&, Scene const&, Executor const&,
                                                   Communicator const&,
                                                   std::unique_ptr<ChainSolver>,
                                                   double implicit_step = 0);

}  // namespace catena
