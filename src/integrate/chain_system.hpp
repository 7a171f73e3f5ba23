// A scene made ready to compute: executor, groups, solvers and forces, on this rank.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "chain/scene_windows.hpp"
#include "dynamics/absolute_dynamics.hpp"
#include "dynamics/joint/joint_dynamics.hpp"
#include "force/openmm_force.hpp"
#include "integrate/timeline.hpp"
#include "io/array_part.hpp"

namespace catena {

/// What `auto` becomes where no planner has chosen (plan/choice.hpp). Throws where a GPU is asked
/// for and some rank has none. Collective.
Backend choose_backend(Scene const&, Communicator const&);
/// Threads of this rank with openmp, and of what cuda-levels leaves to the host: solver.threads,
/// else the host's cores over its ranks.
int choose_threads(Scene const&, Communicator const&);
/// What the scene asks for, or the best; the weakest of all ranks'. Collective. InputError where a
/// rank cannot run what is asked for.
SimdLevel choose_simd_level(Scene const&, Communicator const&);

class ChainSystem {
  public:
    /// Bead chains are always in absolute coordinates; body chains by `axes`: joint or world, as
    /// uses_joint_coordinates() has it for integrators. Collective.
    /// `implicit_step`: of an implicit integrator, in whose matrices stand what springs and dampers
    /// do within a step; 0: those of forward dynamics. `shares`: of the bodies, rank by rank; they
    /// change no number.
    ChainSystem(Scene const&, Axes axes, Communicator const&, double implicit_step = 0,
                dca::Shares const& shares = {});
    ~ChainSystem();
    /// Where OpenMM computes on the chains' GPU, the system lives in OpenMM's context there, which
    /// construction makes that of the thread. To be called before a system is used again after
    /// another was made or used.
    void make_current();

    /// Kinematics, forces, matrices and biases at the present state: accelerations of every body.
    /// With OpenMM the matrix sweep runs while it computes. Collective. With `project`, velocities
    /// in absolute coordinates are first made to fit the joints; without, those of the last
    /// projection count.
    void evaluate(bool project = true);
    /// Forces and matrices at the present configuration, for the constrained integrators:
    /// `update_configuration` must have run. Collective.
    void forces_and_matrices(StepTimeline* timeline);

    /// One step of iterative refinement of the last evaluate(), for the groups in joint coordinates
    /// (JointDynamics::refine). Collective.
    void refine();
    /// JointDynamics::correction of the last refine(), of the group where it is largest; 0 without
    /// such groups. Collective.
    double correction();

    /// Largest local backward residual of the last evaluate(), and its bound c depth eps.
    double residual();
    double residual_bound() const;

    /// Bodies of the scene in scene order, on rank 0. Collective.
    struct Snapshot {
        std::vector<Vec3> position, velocity, omega;  // centre of mass or bead, W; omega: B
        std::vector<Quat> orientation;                // identity for beads
    };
    Snapshot snapshot();
    /// The same in parts of bounded size, in scene order, each as it comes: bodies from `first` on.
    /// Collective.
    struct Bodies {
        std::int64_t first = 0;
        Snapshot motion;
        std::vector<Vector<double, 6>> joint_force;  // where they are asked for
        std::vector<std::array<double, 4>>
            joint_position;  // as BodyArrays::q, where they are asked for; zeros in absolute
                             // coordinates
        std::vector<Vec3> joint_rate;  // as BodyArrays::qd, as joint_position
    };
    void pass_bodies(bool joint_forces, std::function<void(Bodies const&)> const& take) {
        pass_bodies(own_bodies(joint_forces), take);
    }
    /// This rank's bodies as they are now.
    struct OwnBodies {
        bool turning = false, joint_forces = false,
             joint_states = false;              // what a row holds beside position and velocity
        std::vector<std::vector<double>> rows;  // of each group, one a body
        int width() const {
            return (turning ? 13 : 6) + (joint_forces ? 6 : 0) + (joint_states ? 7 : 0);
        }
    };
    OwnBodies own_bodies(bool joint_forces, bool joint_states = false);
    void pass_bodies(OwnBodies const&, std::function<void(Bodies const&)> const& take) const;
    /// They alone, in scene order, in rounds of bounded size, as many on every rank: neighbours
    /// together. Collective.
    void pass_own_bodies(OwnBodies const&,
                         std::function<void(std::vector<Bodies> const&)> const& take) const;
    std::vector<SceneWindows::Run> own_runs() const {
        return SceneWindows(communicator_, groups_).own_runs();
    }
    /// Potential energy term by term, the same on every rank after OpenMM, on rank 0 for the
    /// others: gravity, springs, fixman, then OpenMM's. Collective.
    std::vector<EnergyTerm> potential_energy();
    /// Accelerations and joint forces of the last evaluate() in scene order on rank 0; for bodies
    /// in joint coordinates `joint_acceleration` holds qdd (revolute: first entry) and
    /// `base_acceleration` a free base's. Collective.
    struct Accelerations {
        std::vector<Vec3> joint_acceleration, acceleration;
        std::vector<Vec3>
            bead_force;           // OpenMM's, one a bead (BeadSystem's order); empty without OpenMM
        std::vector<Vec3> alpha;  // angular, W; zero for beads
        std::vector<Vec3>
            base_acceleration;  // one a body; counts for the first body of a free base
        std::vector<Vector<double, 6>> joint_force;
        std::vector<TipForce> tip_force;  // in scene order
    };
    Accelerations accelerations();
    /// OpenMM's forces of the last evaluation alone. Collective.
    std::vector<Vec3> bead_forces() const;
    /// At the chains' tips, in scene order on rank 0. Collective.
    std::vector<TipForce> tip_forces() const { return tip_forces(results()); }

    std::vector<std::unique_ptr<ChainGroup>> const& groups() const { return groups_; }
    std::vector<AbsoluteDynamics*> absolute() const;
    std::vector<JointDynamics*> joint() const;
    /// Whether matrices have nothing to hide and are not needed again.
    bool solves_once() const { return !openmm_ && scene_.solver.refine == 0 && !keeps_matrices_; }
    /// From here on they are.
    void keep_matrices() { keeps_matrices_ = true; }
    /// Accelerations of the groups in joint coordinates at their states, refined `solver.refine`
    /// times; OpenMM computes while matrices are assembled. Collective.
    void solve_joint_groups();
    /// The same at the same coordinates and with OpenMM's forces and the matrices of then, but the
    /// velocities of now. Precondition: the integrator keeps matrices (solves_once()). Collective.
    void solve_joint_groups_again();
    /// JointDynamics::close_tips of every group. Collective.
    void close_tips(int corrections = JointDynamics::usual_corrections);
    OpenMmForce* openmm() const { return openmm_.get(); }
    /// What OpenMM knows; empty without it.
    BeadSystem const& beads() const { return bead_system_; }
    Executor const& executor() const { return *executor_; }
    Scene const& scene() const { return scene_; }
    Communicator const& communicator() const { return communicator_; }
    Backend backend() const { return backend_; }
    std::vector<SolverReport> solver_reports() const;
    /// Throws ComputationError where OpenMM's last forces, or the positions it had, were not
    /// finite. To be asked once the chains' state was waited for.
    void check_forces() const;
    /// ChainSolver::wait and measure, of every group.
    void wait() const;
    void measure(bool on) const;
    /// Seconds of the phases so far: "kinematics and loads", "matrix sweep", "bias sweep",
    /// "forces", "waiting for forces", "exchange".
    std::map<std::string, double> const& seconds() const { return seconds_; }
    /// Seconds of matrix sweep, and of these the ones during which OpenMM's forces were under way
    /// beside it (on one core none are).
    double matrix_seconds() const { return matrix_seconds_; }
    double hidden_seconds() const { return hidden_seconds_; }
    /// Messages of this rank that brought positions to OpenMM.
    Traffic openmm_traffic() const { return openmm_traffic_; }

    /// Everything a checkpoint needs by name, where it is: numbers of this rank's bodies, group by
    /// group, zeros where a group has none.
    struct OwnArray {
        int width = 0;
        std::vector<std::vector<double>> of_group;
    };
    using OwnState = std::map<std::string, OwnArray>;
    OwnState own_state() const;
    /// Accelerations of a joint group that an integrator carries from step to step belong to it.
    void add_rates(ChainGroup const&, JointRates const&, OwnState&) const;
    /// One of these to rank 0, in scene order, part by part as they come. Collective.
    void pass_array(OwnArray const&, std::function<void(ArrayPart const&)> const& take) const;
    /// The same without a message: every rank its own, in ascending order, in rounds, as many on
    /// every rank. Collective.
    void pass_own_array(OwnArray const&,
                        std::function<void(std::vector<ArrayPart> const&)> const& take) const;
    /// All of them at once, in scene order on rank 0, which alone has them to set the state by.
    /// Collective.
    std::map<std::string, std::vector<double>> gathered(OwnState const&) const;
    std::map<std::string, std::vector<double>> state() const { return gathered(own_state()); }
    void set_state(std::map<std::string, std::vector<double>> const&);
    /// As add_rates() put them there, of each of joint(). Collective.
    std::vector<JointRates> own_rates(
        std::map<std::string, std::vector<double>> const& arrays) const;

  private:
    bool is_current() noexcept;
    void require_gpu_memory() const;
    void find_bead_groups();
    std::unique_ptr<AbsoluteDynamics> make_absolute(ChainGroup const&) const;
    std::unique_ptr<JointDynamics> make_joint(ChainGroup const&) const;
    std::unique_ptr<ChainSolver> make_solver(ChainGroup const&) const;
    void make_openmm();
    void find_bead_hosts();
    void describe_beads();
    void order_beads_by_rank();
    bool is_free_of_potentials() const;
    std::vector<BodyResults> results() const;
    std::size_t index_of(ChainGroup const&) const;
    std::vector<Vector<double, 6>> joint_forces(std::vector<BodyResults> const&) const;
    std::vector<TipForce> tip_forces(std::vector<BodyResults> const&) const;
    ConstView<3> own_bead_positions();
    bool on_device() const { return !device_beads_.empty(); }
    void begin_openmm(bool timed);
    void go_on_openmm();
    DevicePath::Clock read_device_clock();
    void finish_openmm();
    void note_overlap(double start, double begun, double assembled, double waits, double finished);
    bool is_absolute(ChainGroup const& group) const {
        return group.beads || group.linked || axes_ == Axes::world;
    }
    /// That rank 0's arrays of a checkpoint have these, with so many numbers a body; InputError
    /// where not. Collective.
    void require_arrays(std::map<std::string, std::vector<double>> const& arrays,
                        std::map<std::string, int> const& widths) const;
    /// This rank's part of one of them, group by group. Collective.
    std::vector<std::vector<double>> own_part(
        std::map<std::string, std::vector<double>> const& arrays, std::string const& name,
        int width) const;
    /// Into an array of a checkpoint.
    void add_part(ChainGroup const&, std::vector<double> own, int width, std::string const& name,
                  OwnState&) const;
    Scene const& scene_;
    Communicator const& communicator_;
    Axes axes_;
    Backend backend_;
    double implicit_step_;
    bool keeps_matrices_ = false;
    std::unique_ptr<Executor> executor_;  // of the host, wherever the chains are
    std::vector<std::unique_ptr<ChainGroup>> groups_;
    std::vector<ChainGroup const*>
        bead_groups_;  // those that are beads or carry some, in the order of bead_hosts_
    BeadSystem bead_system_;
    std::unique_ptr<OpenMmForce> openmm_;  // before what lives in its GPU context
    std::vector<std::unique_ptr<JointDynamics>> joint_;
    std::vector<std::unique_ptr<AbsoluteDynamics>> absolute_;
    std::vector<BeadHost*> bead_hosts_;
    std::vector<DeviceBeads*> device_beads_;  // of bead_hosts_, where OpenMM reaches them on a GPU
    Field<3> bead_position_, openmm_force_;   // of the last evaluation, own beads, host after host
    std::map<std::string, double> seconds_;
    double matrix_seconds_ = 0, hidden_seconds_ = 0;
    Traffic openmm_traffic_;
    // On a GPU the clock is asked now and then: questions take time there.
    static constexpr std::int64_t evaluations_a_clock = 8;
    bool clock_is_due_ = false, timed_before_ = false;
    std::int64_t evaluations_since_clock_ = 0;
};

}  // namespace catena
