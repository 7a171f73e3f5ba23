// ChainSystem: a scene with everything that computes its motion on this rank, that is executor,
// groups, dynamics, solvers and forces.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "chain/scene_windows.hpp"
#include "dynamics/absolute_dynamics.hpp"
#include "dynamics/joint/joint_dynamics.hpp"
#include "force/openmm_force.hpp"
#include "integrate/timeline.hpp"
#include "io/array_part.hpp"

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

/// All chains of a scene on this rank, with their forces and solvers. The scene and the
/// communicator must outlive it.
class ChainSystem {
  public:
    /// Chains of beads always have absolute coordinates. Chains of bodies have those of `axes`
    /// (joint or world, see uses_joint_coordinates()).
    /// `implicit_step`: time step of an implicit integrator, whose matrices include the effect of
    /// springs and dampers within a step; 0 for forward dynamics.
    /// `shares`: the ranks' shares of the bodies, which change no result.
    /// Throws InputError, also if GPU memory does not suffice (cuda::TooLittleMemory). Collective.
    ChainSystem(Scene const&, Axes axes, Communicator const&, double implicit_step = 0,
                dca::Shares const& shares = {});
    ~ChainSystem();
    /// Makes the GPU context of this system current. If OpenMM computes on the chains' GPU, the
    /// system lives in OpenMM's context, which the constructor makes current. Call this before
    /// using a system again after another one was made or used.
    void make_current();

    /// Computes kinematics, forces, matrices and biases at the present state, and from them the
    /// accelerations of every body. With OpenMM, the matrix sweep runs while OpenMM computes.
    /// With `project`, velocities in absolute coordinates are first projected onto the joints'
    /// velocities. Without, those of the last projection are used. Collective.
    void evaluate(bool project = true);
    /// Computes forces and matrices at the present configuration, for the constrained integrators.
    /// Precondition: update_configuration() of every group has been called. Adds the phases to
    /// `timeline`, if given. Collective.
    void forces_and_matrices(StepTimeline* timeline);

    /// Does one step of iterative refinement of the last evaluate(), for the groups in joint
    /// coordinates (JointDynamics::refine()). Collective.
    void refine();
    /// Returns the largest JointDynamics::correction() of a group after the last refine(); 0 if no
    /// group has joint coordinates. Collective.
    double correction();

    /// Returns the largest local backward residual of the last evaluate() over all ranks.
    /// Collective.
    double residual();
    /// Returns the bound c depth eps of residual().
    double residual_bound() const;

    /// Motion of all bodies in scene order.
    struct Snapshot {
        /// Position and velocity of the centre of mass or bead, W (nm, nm/ps); angular velocity in
        /// body axes, rad/ps.
        std::vector<Vec3> position, velocity, omega;
        std::vector<Quat> orientation;  // body axes in W; identity for beads
    };
    /// Returns the motion of all bodies on rank 0. Collective.
    Snapshot snapshot();
    /// Consecutive bodies of the scene, from `first` on.
    struct Bodies {
        std::int64_t first = 0;
        Snapshot motion;
        /// Constraint wrench [torque, force] at the inboard joint, W; empty unless asked for.
        std::vector<Vector<double, 6>> joint_force;
        /// BodyArrays::q of each body; empty unless asked for, zeros in absolute coordinates.
        std::vector<std::array<double, 4>> joint_position;
        /// BodyArrays::qd of each body; present if joint_position is.
        std::vector<Vec3> joint_rate;
    };
    /// Calls `take` on rank 0 with all bodies of the scene, in scene order and in parts of bounded
    /// size. Collective.
    void pass_bodies(bool joint_forces, std::function<void(Bodies const&)> const& take) {
        pass_bodies(own_bodies(joint_forces), take);
    }
    /// Columns of a row besides position and velocity: orientation and angular velocity, joint
    /// force, joint coordinates and rates.
    struct BodyColumns {
        bool turning = false, joint_forces = false, joint_states = false;
        /// Number of columns.
        int width() const {
            return (turning ? 13 : 6) + (joint_forces ? 6 : 0) + (joint_states ? 7 : 0);
        }
    };
    /// Motion of this rank's bodies at the time of own_bodies().
    struct OwnBodies {
        BodyColumns columns;
        /// Rows of each group, one per body.
        std::vector<std::vector<double>> rows;
    };
    /// Motion of all bodies in scene order. Ranks other than 0 have no rows.
    struct AllBodies {
        BodyColumns columns;
        std::vector<double> rows;
    };
    /// Copies the motion of this rank's bodies. `rows` is memory of an earlier copy that is used
    /// again. Collective if `joint_forces`.
    OwnBodies own_bodies(bool joint_forces, bool joint_states = false,
                         std::vector<std::vector<double>> rows = {});
    /// Passes bodies as pass_bodies() above does, from a copy. Collective.
    void pass_bodies(OwnBodies const&, std::function<void(Bodies const&)> const& take) const;
    /// Passes bodies as pass_bodies() above does, from the copy of rank 0. Rank 0 only.
    void pass_bodies(AllBodies const&, std::function<void(Bodies const&)> const& take) const;
    /// Gathers all ranks' bodies. `rows` is memory of an earlier copy that is used again.
    /// Collective.
    AllBodies gather_bodies(OwnBodies const&, std::vector<double> rows) const;
    /// Passes this rank's bodies to `take`, in scene order, without exchange between ranks. Each
    /// round is of bounded size and consists of runs of consecutive bodies. All ranks have the same
    /// number of rounds. Collective.
    void pass_own_bodies(OwnBodies const&,
                         std::function<void(std::vector<Bodies> const&)> const& take) const;
    /// Returns the runs of consecutive bodies of the scene that this rank owns.
    std::vector<SceneWindows::Run> own_runs() const {
        return SceneWindows(communicator_, groups_).own_runs();
    }
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
    };
    /// Returns the results of the last evaluate() on rank 0. Collective.
    Accelerations accelerations();
    /// Returns OpenMM's forces of the last evaluation on rank 0, by bead of BeadSystem, kJ/mol/nm,
    /// W. Collective.
    std::vector<Vec3> bead_forces() const;
    /// Returns the constraint wrenches at the chains' tips on rank 0, in scene order. Collective.
    std::vector<TipForce> tip_forces() const { return tip_forces(results()); }

    /// Chains of this rank, grouped by kind of handles.
    std::vector<std::unique_ptr<ChainGroup>> const& groups() const { return groups_; }
    /// Groups in absolute coordinates.
    std::vector<AbsoluteDynamics*> absolute() const;
    /// Groups in joint coordinates.
    std::vector<JointDynamics*> joint() const;
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
    /// Computes the accelerations of the groups in joint coordinates at their states, and refines
    /// them `solver.refine` times. OpenMM computes while matrices are assembled. Collective.
    void solve_joint_groups();
    /// Computes the accelerations again with the present velocities, but with the coordinates,
    /// OpenMM's forces and matrices of the last solve_joint_groups(). Precondition: solves_once()
    /// is false. Collective.
    void solve_joint_groups_again();
    /// Calls JointDynamics::close_tips() of every group in joint coordinates. Collective.
    void close_tips(int corrections = JointDynamics::usual_corrections);
    /// Forces of OpenMM; null if the scene has none.
    OpenMmForce* openmm() const { return openmm_.get(); }
    /// The scene's beads as OpenMM sees them; empty without OpenMM.
    BeadSystem const& beads() const { return bead_system_; }
    Executor const& executor() const { return *executor_; }
    Scene const& scene() const { return scene_; }
    Communicator const& communicator() const { return communicator_; }
    Backend backend() const { return backend_; }
    /// Returns the report of every group's solver.
    std::vector<SolverReport> solver_reports() const;
    /// Throws ComputationError if OpenMM's last forces or positions on a GPU were not finite.
    /// Precondition: the chains' state has been waited for.
    void check_forces() const;
    /// Calls ChainSolver::wait() of every group.
    void wait() const;
    /// Calls ChainSolver::measure() of every group.
    void measure(bool on) const;
    /// Seconds of the phases so far: "kinematics and loads", "matrix sweep", "bias sweep",
    /// "forces", "waiting for forces", "exchange".
    std::map<std::string, double> const& seconds() const { return seconds_; }
    /// Seconds of matrix sweeps so far.
    double matrix_seconds() const { return matrix_seconds_; }
    /// Seconds of matrix sweeps during which OpenMM computed on other resources; 0 on one core.
    double hidden_seconds() const { return hidden_seconds_; }
    /// Messages of this rank that carried positions to OpenMM.
    Traffic openmm_traffic() const { return openmm_traffic_; }

    /// One array of a checkpoint on this rank: `width` numbers per body, group by group. Groups
    /// without the quantity hold zeros.
    struct OwnArray {
        int width = 0;
        std::vector<std::vector<double>> of_group;
    };
    /// All arrays of a checkpoint, by name.
    using OwnState = std::map<std::string, OwnArray>;
    /// Returns the state of this rank's bodies.
    OwnState own_state() const;
    /// Adds the accelerations of a joint group that an integrator carries from step to step.
    void add_rates(ChainGroup const&, JointRates const&, OwnState&) const;
    /// Passes an array to `take` on rank 0, in scene order and in parts of bounded size.
    /// Collective.
    void pass_array(OwnArray const&, std::function<void(ArrayPart const&)> const& take) const;
    /// Passes this rank's part of an array to `take` without exchange between ranks, in ascending
    /// order. All ranks have the same number of rounds. Collective.
    void pass_own_array(OwnArray const&,
                        std::function<void(std::vector<ArrayPart> const&)> const& take) const;
    /// Returns all arrays in scene order on rank 0, which is where set_state() needs them.
    /// Collective.
    std::map<std::string, std::vector<double>> gathered(OwnState const&) const;
    /// Returns the state on rank 0. Collective.
    std::map<std::string, std::vector<double>> state() const { return gathered(own_state()); }
    /// Sets the state from rank 0's arrays. Throws InputError if one is missing or of wrong length.
    /// Collective.
    void set_state(std::map<std::string, std::vector<double>> const&);
    /// Returns the accelerations that add_rates() stored, one entry per group of joint().
    /// Collective.
    std::vector<JointRates> own_rates(
        std::map<std::string, std::vector<double>> const& arrays) const;

  private:
    /// Makes the GPU context current. Returns false on failure.
    bool is_current() noexcept;
    /// Throws cuda::TooLittleMemory on all ranks if the GPU memory of a rank does not suffice.
    /// Collective.
    void require_gpu_memory() const;
    /// Finds the groups with beads.
    void find_bead_groups();
    std::unique_ptr<AbsoluteDynamics> make_absolute(ChainGroup const&) const;
    std::unique_ptr<JointDynamics> make_joint(ChainGroup const&) const;
    std::unique_ptr<ChainSolver> make_solver(ChainGroup const&) const;
    /// Makes OpenMM's forces. Collective.
    void make_openmm();
    /// Finds the dynamics that hold the positions of beads.
    void find_bead_hosts();
    /// Fills bead_system_, except for its owners.
    void describe_beads();
    /// Sets the owners of beads.
    void order_beads_by_rank();
    /// True if all chains are of beads, and no term but OpenMM's forces has an energy.
    bool is_free_of_potentials() const;
    std::vector<BodyResults> results() const;
    std::size_t index_of(ChainGroup const&) const;
    std::vector<Vector<double, 6>> joint_forces(std::vector<BodyResults> const&) const;
    std::vector<TipForce> tip_forces(std::vector<BodyResults> const&) const;
    /// Copies the positions of own beads, in the order of BeadSystem::by_rank.
    ConstView<3> own_bead_positions();
    /// True if OpenMM reads the beads' positions on the GPU.
    bool on_device() const { return !device_beads_.empty(); }
    /// Starts OpenMM's forces at the present positions; `timed`: the GPU's clock will be read.
    /// Collective.
    void begin_openmm(bool timed);
    /// Path `device`: continues after the matrix sweep was enqueued. Collective.
    void go_on_openmm();
    /// Path `device`: reads the GPU's clock and adds up the seconds of the phases.
    DevicePath::Clock read_device_clock();
    /// Waits for OpenMM's forces and adds them to the beads.
    void finish_openmm();
    /// Adds up the seconds of the phases if OpenMM is not on path `device`.
    void note_overlap(double start, double begun, double assembled, double waits, double finished);
    bool is_absolute(ChainGroup const& group) const {
        return group.beads || group.linked || axes_ == Axes::world;
    }
    /// Throws InputError on every rank unless rank 0's arrays include these names with `widths`
    /// numbers per body. Collective.
    void require_arrays(std::map<std::string, std::vector<double>> const& arrays,
                        std::map<std::string, int> const& widths) const;
    /// Returns this rank's part of one array, group by group. Collective.
    std::vector<std::vector<double>> own_part(
        std::map<std::string, std::vector<double>> const& arrays, std::string const& name,
        int width) const;
    /// Adds the numbers of one group's own bodies to an array of a checkpoint.
    void add_part(ChainGroup const&, std::vector<double> own, int width, std::string const& name,
                  OwnState&) const;
    Scene const& scene_;
    Communicator const& communicator_;
    Axes axes_;
    Backend backend_;
    double implicit_step_;
    bool keeps_matrices_ = false;
    std::unique_ptr<Executor> executor_;  // threads of the host, also if chains are on a GPU
    std::vector<std::unique_ptr<ChainGroup>> groups_;
    /// Groups that are beads or carry some, in the order of bead_hosts_.
    std::vector<ChainGroup const*> bead_groups_;
    BeadSystem bead_system_;
    // Declared before what lives in its GPU context.
    std::unique_ptr<OpenMmForce> openmm_;
    std::vector<std::unique_ptr<JointDynamics>> joint_;
    std::vector<std::unique_ptr<AbsoluteDynamics>> absolute_;
    std::vector<BeadHost*> bead_hosts_;
    /// Entries of bead_hosts_ whose beads OpenMM reads on a GPU; else empty.
    std::vector<DeviceBeads*> device_beads_;
    /// Positions (nm) and forces (kJ/mol/nm) of own beads at the last evaluation, W, host after
    /// host.
    Field<3> bead_position_, openmm_force_;
    std::map<std::string, double> seconds_;
    double matrix_seconds_ = 0, hidden_seconds_ = 0;
    Traffic openmm_traffic_;
    // The GPU's clock is read at every eighth evaluation only, because reading it takes time.
    static constexpr std::int64_t evaluations_a_clock = 8;
    bool clock_is_due_ = false, timed_before_ = false;
    std::int64_t evaluations_since_clock_ = 0;
    /// Adds forces that are computed outside the library; may be empty.
    std::function<void()> added_forces_;
};

}  // namespace catena
