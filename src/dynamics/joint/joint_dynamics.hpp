// Forward dynamics of body chains in joint coordinates: state -> accelerations, by one matrix and
// one bias sweep. The state is within, wherever that is.
#pragma once

#include <memory>

#include "dca/solver.hpp"
#include "dynamics/absolute_dynamics.hpp"
#include "dynamics/constrained_step.hpp"
#include "kinematics/joint_kinematics.hpp"

namespace catena {

/// Time derivatives of JointState's velocities (RatesView), on the host.
struct JointRates {
    Field<3> qdd, base_acceleration;
};

/// A step within one whose length is given.
struct InnerStep {
    double length = 0, end = 0;  // end: the time there
    bool again = false;          // from where the one before began, which was rejected
};
/// The largest of each kind. Bases' and sliding joints' are linear.
struct Speeds {
    double angular = 0, linear = 0;
};
/// Of a step.
struct AllowedErrors {
    double angle = 0, length = 0;
    Speeds speed;
};

class JointDynamics : public BeadHost {
  public:
    /// Of bodies and free bases, on the host.
    virtual JointState state() const = 0;
    virtual void set_state(JointState const&) = 0;
    double time() const { return time_; }
    void set_time(double time) { time_ = time; }

    /// What the state alone decides, and where carried beads are. Clears their forces. Collective.
    virtual void update_configuration() = 0;
    /// The same where solve_once() follows, which leaves out what its solver needs not be told.
    virtual void update_to_solve_once() = 0;
    /// At the configuration updated last. Needs no forces. Collective.
    virtual void assemble_matrices() = 0;
    /// Accelerations of bodies with the forces of now, at the configuration updated last.
    /// Collective.
    virtual void solve() = 0;
    /// assemble_matrices() and solve() together, where nothing is to be hidden between them: the
    /// matrices are not kept, and the last bits may be others. Collective.
    virtual void solve_once() = 0;
    /// solve() at the same coordinates with the velocities of now; matrices and forces on carried
    /// beads are those of before. Collective.
    virtual void solve_again() = 0;
    /// Those of coordinates, after solve(); and as they were set last, on the host.
    virtual void set_rates() = 0;
    /// Seconds of update_to_solve_once(), solve_once() and set_rates() together, `repeat` times the
    /// mean of `chained` of them one after the other. Precondition: they were called before.
    /// Collective.
    virtual std::vector<double> time_at_once(int chained, int repeat) = 0;
    /// One step of iterative refinement of what solve() found last: what the equations of bodies
    /// and joints lack is solved for with the same matrices and added. Digits come back that were
    /// lost where a body's forces are far larger than what they leave of them: accelerations are
    /// carried apart from the forces they came from. `executor`: of the host, which looks for what
    /// is lacking. Collective.
    virtual void refine(Executor const& executor) = 0;
    /// How much the last refine() changed bodies' accelerations, over their size: an estimate of
    /// the relative error of what it was given. Turning and linear accelerations apart, the larger
    /// of both. Where accelerations all but vanish, they count as what gravity and the loads would
    /// give the chains as a whole. NaN where something is not finite. Precondition: refine() was
    /// called. Collective.
    virtual double correction() = 0;
    virtual JointRates rates() const = 0;

    // Steps, stage by stage: each but the first half of Verlet's follows a solve().
    /// Stage 0, 1, 2 or 3 of a Runge-Kutta step of length h.
    virtual void runge_kutta(int stage, double h) = 0;
    /// Stage 0 to 5 of a step of the Dormand-Prince pair (embedded_steps.hpp), from the carried
    /// accelerations on; what the stages began with is kept until the next step that is not taken
    /// `again`.
    virtual void embedded_stage(int stage, InnerStep const&) = 0;
    /// Of the stage that comes next: below 1 where it is worth a solution. On this rank.
    virtual double wildness(double length) = 0;
    /// At the ends of that step, and after another solve() its largest error over what is allowed;
    /// NaN where something is not finite. On this rank.
    virtual Speeds fastest() = 0;
    virtual double embedded_error(double length, AllowedErrors const&) = 0;
    /// A length that lengths are measured by, the same on every rank: of the longest chain.
    virtual double reach() const = 0;
    /// The accelerations that velocity Verlet and the Dormand-Prince pair carry from step to step:
    /// those solved for last; others.
    virtual void carry_rates() = 0;
    virtual void carry_rates(JointRates const&) = 0;
    virtual JointRates carried_rates() const = 0;
    /// Positions and a first guess of velocities after h, and then the velocities.
    virtual void verlet_move(double h) = 0;
    virtual void verlet_finish(double h) = 0;

    /// Coordinates after h of the velocities, which are kept as the start of kicks.
    virtual void drift(double h) = 0;
    /// Velocities after h of the accelerations solved for last, from those at the start; and from
    /// those of now, of the carried ones.
    virtual void kick(double h) = 0;
    virtual void kick_by_carried(double h) = 0;
    /// Velocities keep u + spread xi: xi normal, its covariance the inverse of the matrix at the
    /// coordinates of now, springs' and dampers' part included. `step` numbers the noise.
    /// Collective.
    virtual void thermalise(Thermostat const&, std::uint64_t step) = 0;

    /// Motion at the present state, positions included, on the host. Collective.
    virtual BodyMotion motion() = 0;
    /// Of the solution evaluated last; nothing may have changed since, here and in residual() and
    /// refine(). Collective.
    virtual BodyResults results() = 0;
    /// Largest local backward residual of the solution evaluated last (JointSolution). Over all
    /// ranks; collective.
    virtual double residual(Executor const&) = 0;
    /// At the present state. Collective.
    virtual PotentialEnergy potential() = 0;
    /// Corrects positions by so many Newton steps and velocities by one, each by the least in the
    /// metric of the masses, so that jointed tips close again; nothing happens where there are
    /// none. Collective.
    static constexpr int usual_corrections = 2;
    virtual void close_tips(int corrections = usual_corrections) = 0;
    /// Largest opening of a jointed tip over the chains' reach, over all ranks; NaN where the state
    /// is not finite. Collective.
    virtual double closure_error() = 0;
    virtual ChainSolver& solver() const = 0;

  protected:
    double time_ = 0;
};

std::unique_ptr<JointDynamics> make_joint_dynamics(ChainGroup const&, Scene const&, Executor const&,
                                                   Communicator const&,
                                                   std::unique_ptr<ChainSolver>,
                                                   double implicit_step = 0);

}  // namespace catena
