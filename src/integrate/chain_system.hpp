// ChainSystem: a scene with everything that computes its motion on this rank, that is executor,
// groups, dynamics, solvers and forces.
#pragma once

#include "integrate/checkpoint_parts.hpp"
#include "integrate/snapshots.hpp"
#include "integrate/system_evaluator.hpp"

namespace catena {

/// All chains of a scene on this rank, with their forces and solvers: chains (SystemChains),
/// evaluations (SystemEvaluator), and the results of evaluations. Snapshots and CheckpointParts
/// collect motion and state. The scene and the communicator must outlive it.
class ChainSystem : public SystemEvaluator {
  public:
    /// Parameters and errors are those of SystemChains. Collective.
    ChainSystem(Scene const& scene, Axes axes, Communicator const& communicator,
                double implicit_step = 0, dca::Shares const& shares = {})
        : SystemEvaluator(scene, axes, communicator, implicit_step, shares) {}

    /// Returns the largest JointDynamics::correction() of a group after the last refine(); 0 if no
    /// group has joint coordinates. Collective.
    double correction();
    /// Returns the largest local backward residual of the last evaluate() over all ranks.
    /// Collective.
    double residual();
    /// Returns the bound c (depth + directions that loops restrict) eps of residual().
    double residual_bound() const;
    /// Returns the motion of all bodies on rank 0. Collective.
    SceneMotion snapshot() const { return Snapshots(*this).motion(); }
    /// Returns the potential energy term by term, kJ/mol: terms::energy_columns(), then OpenMM's
    /// terms. OpenMM's terms are the same on every rank; the others are valid on rank 0 only.
    /// Collective.
    std::vector<EnergyTerm> potential_energy();
    /// Accelerations and joint forces in scene order, W unless stated otherwise.
    struct Accelerations {
        /// `joint_acceleration` is qdd in joint coordinates (revolute: first entry), else equal to
        /// `acceleration`. `acceleration` is that of the centre of mass or bead.
        std::vector<Vec3> joint_acceleration, acceleration;
        /// OpenMM's force on each bead (BeadSystem's order), kJ/mol/nm; empty without OpenMM.
        std::vector<Vec3> bead_force;
        std::vector<Vec3> alpha;  // angular acceleration; zero for beads
        /// Linear acceleration of a free base, in the entry of its first body; other entries are
        /// unused.
        std::vector<Vec3> base_acceleration;
        /// Constraint wrench [torque, force] on each body at its inboard joint.
        std::vector<Vector<double, 6>> joint_force;
        /// Constraint wrench of each jointed tip, in scene order.
        std::vector<TipForce> tip_force;
        /// Tension of each cross-link, in scene order.
        std::vector<double> crosslink_tension = {};
        /// Constraint wrench of each loop, in scene order.
        std::vector<TipForce> loop_force = {};
    };
    /// Returns the results of the last evaluate() on rank 0. Collective.
    Accelerations accelerations();
    /// Returns OpenMM's forces of the last evaluation on rank 0, by bead of BeadSystem, kJ/mol/nm,
    /// W. Collective.
    std::vector<Vec3> bead_forces() const;
    /// Returns the constraint wrenches at the chains' tips on rank 0, in scene order. Collective.
    std::vector<TipForce> tip_forces() const { return tip_forces(results_of(*this)); }
    /// Throws ComputationError if OpenMM's last forces or positions on a GPU were not finite.
    /// Precondition: the chains' state has been waited for.
    void check_forces() const;
    /// Calls ChainSolver::measure() of every group.
    void measure(bool on) const;
    /// Returns the state on rank 0. Collective.
    std::map<std::string, std::vector<double>> state() const {
        CheckpointParts const parts(*this);
        return parts.gathered(parts.own_state());
    }
    /// Sets the state from rank 0's arrays (CheckpointParts::set_state()). Collective.
    void set_state(std::map<std::string, std::vector<double>> const& arrays) {
        CheckpointParts(*this).set_state(arrays);
    }

  private:
    /// True if all chains are of beads, and no term but OpenMM's forces has an energy.
    bool is_free_of_potentials() const;
    std::vector<Vector<double, 6>> joint_forces(std::vector<BodyResults> const&) const;
    /// Gathers wrenches of joints of chains on rank 0. Collective.
    std::vector<TipForce> in_scene_order(std::vector<TipForce> const& own) const;
    std::vector<TipForce> tip_forces(std::vector<BodyResults> const&) const;
    std::vector<TipForce> loop_forces(std::vector<BodyResults> const&) const;
    std::vector<double> crosslink_tensions(std::vector<BodyResults> const&) const;
};

}  // namespace catena
