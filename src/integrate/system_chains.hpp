// The chains of a scene on this rank: executor, groups, dynamics with their solvers, and OpenMM.
#pragma once

#include <memory>
#include <vector>

#include "chain/chain_group.hpp"
#include "dynamics/absolute_dynamics.hpp"
#include "dynamics/joint/joint_dynamics.hpp"
#include "integrate/openmm_evaluation.hpp"

namespace catena {

/// Returns the backend that the scene names. `auto` becomes segments or openmp if no planner
/// (plan/choice.hpp) has chosen. Throws InputError if the scene asks for a GPU and some rank has
/// none. Collective.
Backend choose_backend(Scene const&, Communicator const&);
/// Returns the number of threads of this rank: solver.threads, else the host's cores divided by its
/// ranks. They are used by openmp, and by cuda-levels for what it leaves to the host.
int choose_threads(Scene const&, Communicator const&);
/// Returns the SIMD level that the scene names, or the best one that all ranks support. Throws
/// InputError if a rank cannot run the level that the scene names. Collective.
SimdLevel choose_simd_level(Scene const&, Communicator const&);

/// All chains of a scene on this rank, as made for one backend. The scene and the communicator must
/// outlive it.
class SystemChains {
  public:
    /// Chains of beads always have absolute coordinates. Chains of bodies have those of `axes`
    /// (joint or world, see uses_joint_coordinates()).
    /// `implicit_step`: time step of an implicit integrator, whose matrices include the effect of
    /// springs and dampers within a step; 0 for forward dynamics.
    /// `shares`: the ranks' shares of the bodies, which change no result.
    /// Throws InputError, also if GPU memory does not suffice (cuda::TooLittleMemory). Collective.
    SystemChains(Scene const&, Axes axes, Communicator const&, double implicit_step,
                 dca::Shares const& shares);
    ~SystemChains();
    /// Makes the GPU context of this system current. If OpenMM computes on the chains' GPU, the
    /// system lives in OpenMM's context, which the constructor makes current. Call this before
    /// using a system again after another one was made or used.
    void make_current();

    Scene const& scene() const { return scene_; }
    Communicator const& communicator() const { return communicator_; }
    Backend backend() const { return backend_; }
    Executor const& executor() const { return *executor_; }
    /// Chains of this rank, grouped by kind of handles.
    std::vector<std::unique_ptr<ChainGroup>> const& groups() const { return groups_; }
    /// Index of one of groups().
    std::size_t index_of(ChainGroup const&) const;
    /// Groups in absolute coordinates.
    std::vector<AbsoluteDynamics*> absolute() const;
    /// Groups in joint coordinates.
    std::vector<JointDynamics*> joint() const;
    /// Forces of OpenMM; null if the scene has none.
    OpenMmForce* openmm() const { return openmm_ ? &openmm_->force() : nullptr; }
    /// The scene's beads as OpenMM sees them; empty without OpenMM.
    BeadSystem const& beads() const;
    /// Returns the report of every group's solver.
    std::vector<SolverReport> solver_reports() const;
    /// Calls ChainSolver::wait() of every group.
    void wait() const;

  protected:
    bool is_absolute(ChainGroup const& group) const {
        return group.beads || group.linked || axes_ == Axes::world;
    }

  private:
    /// Makes the GPU context current. Returns false on failure.
    bool is_current() noexcept;
    /// Throws cuda::TooLittleMemory on all ranks if the GPU memory of a rank does not suffice.
    /// Collective.
    void require_gpu_memory() const;
    std::unique_ptr<AbsoluteDynamics> make_absolute(ChainGroup const&) const;
    std::unique_ptr<JointDynamics> make_joint(ChainGroup const&) const;
    std::unique_ptr<ChainSolver> make_solver(ChainGroup const&) const;
    /// Groups that are beads or carry some; those in absolute coordinates are first.
    std::vector<ChainGroup const*> bead_groups() const;
    /// Makes OpenMM's forces. Collective.
    void make_openmm();

    Axes axes_;
    double implicit_step_;

  protected:
    // Evaluations use these in every step.
    Scene const& scene_;
    Communicator const& communicator_;
    Backend backend_;
    std::unique_ptr<Executor> executor_;  // threads of the host, also if chains are on a GPU
    std::vector<std::unique_ptr<ChainGroup>> groups_;
    // Declared before what lives in its GPU context.
    std::unique_ptr<OpenMmEvaluation> openmm_;
    std::vector<std::unique_ptr<JointDynamics>> joint_;
    std::vector<std::unique_ptr<AbsoluteDynamics>> absolute_;
};

/// Results of the last solution of every group: those in absolute coordinates, then the others.
/// Collective.
std::vector<BodyResults> results_of(SystemChains const&);

}  // namespace catena
