// Evaluation of forces, matrices and accelerations of a system's chains.
#pragma once

#include <functional>

#include "integrate/system_chains.hpp"
#include "integrate/timeline.hpp"

namespace catena {

/// Chains with the evaluations of which steps consist.
class SystemEvaluator : public SystemChains {
  public:
    using SystemChains::SystemChains;

    /// Computes kinematics, forces, matrices and biases at the present state, and from them the
    /// accelerations of every body. With OpenMM, the matrix sweep runs while OpenMM computes.
    /// With `project`, velocities in absolute coordinates are first projected onto the joints'
    /// velocities. Without, those of the last projection are used. Collective.
    void evaluate(bool project = true);
    /// Computes forces and matrices at the present configuration, for the constrained integrators.
    /// Precondition: update_configuration() of every group has been called. Adds the phases to
    /// `timeline`, if given. Collective.
    void forces_and_matrices(StepTimeline* timeline);
    /// Computes the accelerations of the groups in joint coordinates at their states, and refines
    /// them `solver.refine` times. OpenMM computes while matrices are assembled. Collective.
    void solve_joint_groups();
    /// Computes the accelerations again with the present velocities, but with the coordinates,
    /// OpenMM's forces and matrices of the last solve_joint_groups(). Precondition: solves_once()
    /// is false. Collective.
    void solve_joint_groups_again();
    /// Does one step of iterative refinement of the last evaluate(), for the groups in joint
    /// coordinates (JointDynamics::refine()). Collective.
    void refine();
    /// True if matrices and accelerations are computed in one sweep: no OpenMM computation could be
    /// hidden behind the matrix sweep, and the matrices are not needed again.
    bool solves_once() const { return !openmm_ && scene_.solver.refine == 0 && !keeps_matrices_; }
    /// Makes the system keep its matrices from now on, so that solves_once() is false.
    void keep_matrices() { keeps_matrices_ = true; }
    /// Calls `add` at every evaluation from now on, after OpenMM's forces. It adds to
    /// BeadHost::bead_forces() of absolute() and joint(). Precondition: one rank, a backend without
    /// GPU.
    void add_forces_by(std::function<void()> add) {
        added_forces_ = std::move(add);
        keep_matrices();
    }
    /// Calls JointDynamics::close_tips() of every group in joint coordinates. Collective.
    void close_tips(int corrections = JointDynamics::usual_corrections);
    /// Seconds of the phases so far: "kinematics and loads", "matrix sweep", "bias sweep",
    /// "forces", "waiting for forces", "exchange".
    std::map<std::string, double> const& seconds() const { return times_.seconds; }
    /// Seconds of matrix sweeps so far.
    double matrix_seconds() const { return times_.matrices; }
    /// Seconds of matrix sweeps during which OpenMM computed on other resources; 0 on one core.
    double hidden_seconds() const { return times_.hidden; }
    /// Messages of this rank that carried positions to OpenMM.
    Traffic openmm_traffic() const { return openmm_ ? openmm_->traffic() : Traffic(); }

  private:
    /// Adds up the seconds of the phases if OpenMM is not on path `device`.
    void note_overlap(double start, double begun, double assembled, double waits, double finished);
    bool on_device() const { return openmm_ && openmm_->on_device(); }

    bool keeps_matrices_ = false;
    EvaluationTimes times_;
    /// Adds forces that are computed outside the library; may be empty.
    std::function<void()> added_forces_;
};

}  // namespace catena
