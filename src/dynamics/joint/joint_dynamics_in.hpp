// Implementation of JointDynamics in any Space, which holds state, kinematics, loads and steps.
#pragma once

#include <optional>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "dca/host_space.hpp"
#include "dynamics/joint/embedded_steps.hpp"
#include "dynamics/joint/joint_dynamics.hpp"
#include "dynamics/joint/joint_lanes.hpp"
#include "dynamics/joint/joint_solution.hpp"
#include "dynamics/joint/joint_steps.hpp"
#include "dynamics/joint/revolute_scan.hpp"
#include "error.hpp"

namespace catena {

/// Jointed tips of the group on this rank at the scene's start. Collective.
std::vector<JointedTip> tips_at_start(ChainGroup const&, Scene const&, Communicator const&);

template <class Space>
struct JointRefinement;

/// Drives kinematics, loads, solver and steps. On hosts with SIMD, bodies and runs are processed
/// side by side in vector lanes (JointLanes).
template <class Space>
class JointDynamicsIn final : public JointDynamics {
    template <int D>
    using FieldOf = typename Space::template FieldOf<D>;
    template <int D>
    using Fixed = typename Space::template Fixed<D>;
    template <class T>
    using List = typename Space::template List<T>;
    static constexpr bool has_lanes = requires(Space const& space) { space.simd(); };

  public:
    /// `solver` must read and write views of the same Space. `implicit_step` is the step length of
    /// implicit joint springs; 0 if there are none.
    JointDynamicsIn(ChainGroup const& group, Scene const& scene, Space const& space,
                    Communicator const& communicator, std::unique_ptr<ChainSolver> solver,
                    double implicit_step = 0)
        : group_(group),
          space_(space),
          communicator_(communicator),
          solver_(std::move(solver)),
          given_(make_body_loads(group, scene)),
          of_stiffness_(rotor_of_spring(scene.dynamics.integrator) * implicit_step * implicit_step),
          of_damping_(0.5 * implicit_step),
          implicit_list_(group.implicit_joint),
          pieces_list_(local_pieces(group, scene)),
          pieces_in_scene_(pieces_list_),
          tip_(tips_at_start(group, scene, communicator)),
          reach_(reach_of(group, scene)),
          has_wrenches_(given_.wrenches || group.carried_beads() > 0),
          has_forces_(has_wrenches_ || given_.act_on_bodies() ||
                      (given_.joint_loads && group.has_screws)),
          needs_positions_(given_.use_positions() || group.has_tips() || group.carried_in_scene),
          needs_orientations_(given_.use_orientations() || needs_positions_),
          eliminates_revolute_joints_(solver_->eliminates_revolute_joints()),
          in_run_(eliminates_revolute_joints_ ? revolutes_in_runs(group)
                                              : std::vector<std::uint8_t>{}),
          in_run_list_(in_run_),
          kinematics_(group, space, communicator),
          loads_(given_),
          tips_(tip_),
          beads_(group, space),
          mass_(group.mass),
          inertia_(group.inertia),
          r2_(group.r2),
          axes2_(group.axes2),
          state_(group),
          start_(group),
          sum_(group),
          motion_(group, space),
          joint_load_(given_.joint_loads ? group.size : 0),
          compliance_(group.implicit_joint.empty() ? 0 : group.size),
          yielding_(group.implicit_joint.empty() ? 0 : group.size),
          revolute_acceleration_(eliminates_revolute_joints_ ? group.size + 1 : 0),
          torque_(group.size),
          force_(has_forces_ ? group.size : 0),
          alpha_(group.size),
          acceleration_(group.size),
          qdd_(group.size),
          saved_qdd_(group.size),
          base_acceleration_(pieces()),
          saved_base_acceleration_(pieces()),
          outboard_end_(1),
          zero_(group.has_tips() ? group.size : 0),
          last_end_(tips()),
          other_end_(tips()),
          bias_(group.size + 1, group.directions),
          joint_force_(group.size + 1, group.directions),
          tip_bias_(group.has_tips() ? group.size : 0, group.directions),
          tip_force_(group.has_tips() ? group.size : 0, group.directions) {
        if constexpr (has_lanes)
            if (JointLanes lanes(group, given_.springs,
                                 eliminates_revolute_joints_ && solver_->has_runs_side_by_side(),
                                 space.simd());
                lanes.any())
                lanes_ = std::move(lanes);
        if (scene.dynamics.given && is_adaptive(scene.dynamics.integrator)) pair_.emplace(group);
        if (scene.solver.refine > 0) refinement_.emplace(group);
        set_state(make_joint_state(group, scene));
        if (tips() > 0)
            space_.edit(other_end_, [&](View<13> view) {
                for (std::int64_t i = 0; i < tips(); ++i)
                    view.store(i, as_numbers(tip_[static_cast<std::size_t>(i)].ground));
            });
    }

    JointState state() const override {
        solver_->check();
        JointState s;
        s.q = space_.read(state_.q);
        s.qd = space_.read(state_.qd);
        s.base_position = space_.read(state_.base_position);
        s.base_velocity = space_.read(state_.base_velocity);
        return s;
    }
    void set_state(JointState const& s) override {
        fill(space_, state_.q, s.q);
        fill(space_, state_.qd, s.qd);
        fill(space_, state_.base_position, s.base_position);
        fill(space_, state_.base_velocity, s.base_velocity);
        relative_ = false;
    }

    void update_configuration() override { go_to_configuration(false); }
    void update_to_solve_once() override { go_to_configuration(eliminates_revolute_joints_); }
    void assemble_matrices() override {
        solver_->assemble_matrices(configuration());
        has_matrices_ = true;
    }
    void solve() override {
        bool const finds_motions = may_follow_revolutes();
        if (std::exchange(leaves_loads_, false)) finds_motions ? update(false) : set_loads();
        set_carried_loads();
        solver_->solve(loads(), found(false));
        exchange_ends();
    }
    void solve_once() override {
        set_carried_loads();
        find_rotations();
        solver_->assemble_and_solve(configuration(), loads(), found(leaves_loads_));
        has_matrices_ = false;
        exchange_ends();
    }
    void solve_again() override {
        leaves_loads_ = false;
        update(true);
        solver_->solve(loads(), found(false));
        exchange_ends();
    }
    std::vector<double> time_at_once(int chained, int repeat) override {
        return space_.time_chained(chained, repeat, communicator_.size() > 1, [this] {
            update_to_solve_once();
            solve_once();
            set_rates();
        });
    }
    /// The residual is computed on the host.
    void refine(Executor const& executor) override;
    double correction() override;
    void set_rates() override { set_rates({qdd_.view(), base_acceleration_.view()}); }
    JointRates rates() const override {
        return {space_.read(qdd_), space_.read(base_acceleration_)};
    }

    void apply(JointOperation const& op, double h) override;
    void apply(EmbeddedStage const&) override;
    double stage_divergence(double length) override;
    Speeds fastest() override;
    double embedded_error(EmbeddedDifference const&, AllowedErrors const&) override;
    double reach() const override { return reach_; }
    void save_rates(JointRates const& rates) override {
        fill(space_, saved_qdd_, rates.qdd);
        fill(space_, saved_base_acceleration_, rates.base_acceleration);
    }
    JointRates saved_rates() const override {
        return {space_.read(saved_qdd_), space_.read(saved_base_acceleration_)};
    }

    BodyMotion motion() override;
    BodyResults results() override {
        solver_->check();
        return with_solution([&](JointSolution const& s) { return s.results(communicator_); });
    }
    double residual(Executor const& executor) override {
        solver_->check();
        return with_solution(
            [&](JointSolution const& s) { return s.residual(communicator_, executor); });
    }
    PotentialEnergy potential() override {
        return potential_of(group_, given_, space_.read(state_.q), motion());
    }

    void close_tips(int corrections) override {
        if (!group_.has_tips()) return;
        for (int i = 0; i < corrections; ++i) correct(false);
        correct(true);
    }
    double closure_error() override {
        solver_->check();
        double worst = space_.largest(
            group_.size,
            [s = steps()] CATENA_LAMBDA(std::int64_t k) -> double { return s.trouble(k); });
        if (group_.has_tips()) {
            move();
            worst =
                larger(worst, space_.largest(tips(),
                                             [t = jointed_tips()] CATENA_LAMBDA(
                                                 std::int64_t i) -> double { return t.error(i); }));
        }
        return communicator_.max(worst);
    }

    View<3> bead_forces() override { return beads_.bead_forces(); }
    ConstView<3> bead_positions() override { return beads_.bead_positions(); }
    void take_bead_forces() override { beads_.take_bead_forces(); }
    ChainSolver& solver() const override { return *solver_; }
    ChainGroup const& group() const override { return group_; }

    /// Calls one(k) for every body. Bodies that are side by side in vector lanes are passed to
    /// some(loops, first bodies, range) instead.
    template <bool positions, class Some, class One>
    void each_body(Some const& some, One const& one) const {
        if constexpr (has_lanes)
            if (lanes_) return lanes_->each(space_, positions, some, one);
        space_.for_each(group_.size, one);
    }

    // Members below are public because nvcc accepts device lambdas in public members only.
    void set_carried_loads() {
        if (group_.carried_in_scene) set_loads();
    }
    /// Computes the loads of all bodies from the current motion.
    void set_loads() {
        space_.for_each(group_.size,
                        [c = chains()] CATENA_LAMBDA(std::int64_t k) { c.set_loads(k); });
    }
    /// Computes the loads that had been left to the solver. Precondition: the motion is known.
    void leave_nothing() {
        leaves_motions_ = false;
        if (std::exchange(leaves_loads_, false)) set_loads();
    }
    /// Updates motion and loads; `leaves_loads` leaves to the solver what it can compute itself.
    void go_to_configuration(bool leaves_loads) {
        leaves_loads_ = leaves_loads;
        has_matrices_ = false;
        if (!may_follow_revolutes()) return update(false);
        if (follows_revolutes())
            follow_revolutes();
        else
            update(false);
        // Cleared also on ranks that have just computed them, because computing them is collective.
        has_orientations_ = false;
    }
    /// Computes motion and loads of all bodies.
    void update(bool again) {
        leaves_motions_ = false;
        needs_positions_ ? update<true>(again) : update<false>(again);
    }
    /// `again`: keeps the forces on carried beads.
    template <bool positions>
    void update(bool again) {
        JointChains c = chains();
        c.scan.motion.orients_first_alone = !needs_orientations_;
        has_orientations_ = needs_orientations_;
        if (!std::exchange(relative_, false))
            each_body<positions>(
                [&c](JointLoops const& loops, auto... bodies) { loops.set_relative(c, bodies...); },
                [c] CATENA_LAMBDA(std::int64_t k) { c.template set_relative<positions>(k); });
        BodyExchange<4> const loads = shown_joint_loads();
        auto const set_motion = [c, again] CATENA_LAMBDA(std::int64_t k) {
            c.template set_motion<positions>(k, again);
        };
        if constexpr (has_lanes) {
            if (lanes_) {
                lanes_->follow(space_, positions, c.scan);
                kinematics_.template sweep<positions>(c.scan, lanes_->tree(), loads);
            } else {
                kinematics_.template sweep<positions>(c.scan, loads);
            }
            each_body<positions>(
                [&c](JointLoops const& loops, auto... bodies) { loops.set_motion(c, bodies...); },
                set_motion);
        } else {
            kinematics_.template sweep<positions>(c.scan, loads, set_motion);
        }
        if (!group_.has_tips()) return;
        set_ends();
        space_.for_each(tips(), [t = jointed_tips(), gravity = given_.gravity,
                                 out = tip_bias_.view()] CATENA_LAMBDA(std::int64_t i) {
            t.set_acceleration_bias(i, gravity, out);
        });
    }
    /// Variant of update() that leaves the motion within runs to the solver.
    void follow_revolutes() {
        leaves_motions_ = has_rotations_ = true;
        JointChains c = chains();
        c.scan.motion.orients_first_alone = !needs_orientations_;
        bool const relative = std::exchange(relative_, false);
        if constexpr (has_lanes)
            if (solver_->has_runs_side_by_side()) return follow_by_lanes(c);
        follow_by_runs(c, relative);
    }
    /// Computes the joints' relative motions.
    void set_relative() {
        space_.for_each(group_.size, [c = chains()] CATENA_LAMBDA(std::int64_t k) {
            c.template set_relative<false>(k);
        });
    }
    /// Computes the rotations of revolute joints for the solver, if another scan has overwritten
    /// them.
    void find_rotations() {
        if (leaves_motions_ && !has_rotations_) set_relative();
        has_rotations_ = leaves_motions_;
    }
    /// Scan with one item per run. `relative`: the relative motions are already known.
    void follow_by_runs(JointChains const& c, bool relative) {
        RevoluteScan const scan{c, joint_by_joint(), refinement_.has_value()};
        if (scan.joint_by_joint && !relative) set_relative();
        kinematics_.sweep_runs(scan, shown_joint_loads(),
                               [scan] CATENA_LAMBDA(dca::Run const& run) { scan.begin(run); });
    }
    /// Scan with runs side by side in vector lanes.
    void follow_by_lanes(JointChains const& c) {
        RevoluteScan const scan{c, false, refinement_.has_value()};
        // First bodies of chains may have any joint. Their handles stay as set at the start,
        // because no meeting frame moves here.
        space_.over(lanes_->chains_begin(),
                    [c](std::int64_t k) { c.template set_relative<false>(k); });
        lanes_->follow_revolutes(space_, c);
        kinematics_.sweep_with(scan, lanes_->tree(), shown_joint_loads());
        lanes_->begin_runs(space_, c.scan);
        space_.over(lanes_->chains_begin(),
                    [c](std::int64_t k) { c.template set_motion<false>(k, false); });
        space_.over(lanes_->other_runs(), [scan](dca::Run const& run) { scan.begin(run); });
    }
    /// Message with the joint loads of this rank's first body, to the inboard neighbour.
    BodyExchange<4> shown_joint_loads() {
        return given_.joint_loads ? from_outboard(group_, joint_load_.view())
                                  : BodyExchange<4>::none();
    }
    /// Applies one stage to all bodies, and sets relative motions unless the next update does so.
    template <bool positions>
    void accumulate(WeightedStage const& stage) {
        JointSteps const s = steps();
        each_body<positions>(
            [&](JointLoops const& loops, auto... bodies) { loops.accumulate(s, stage, bodies...); },
            [s, stage] CATENA_LAMBDA(std::int64_t k) {
                s.template accumulate<positions>(k, stage);
            });
        relative_ = !s.chains.left.motions;
    }
    template <bool positions>
    void embedded_stage(EmbeddedStage const&);
    template <bool positions>
    void drift_saved(double h) {
        JointSteps const s = steps();
        space_.for_each(group_.size, [s, h, time = time_ + h] CATENA_LAMBDA(std::int64_t k) {
            s.template drift_saved<positions>(k, h, time);
        });
        relative_ = !s.chains.left.motions;
    }
    void kick_mean(double h) {
        space_.for_each(group_.size,
                        [s = steps(), h] CATENA_LAMBDA(std::int64_t k) { s.kick_mean(k, h); });
        relative_ = false;
    }
    template <bool positions>
    void drift(double h) {
        space_.for_each(group_.size,
                        [s = steps(), h, time = time_ + h] CATENA_LAMBDA(std::int64_t k) {
                            s.template drift<positions>(k, h, time);
                        });
        relative_ = true;
    }
    void kick(double h, bool by_saved) {
        space_.for_each(group_.size, [s = steps(), h, by_saved] CATENA_LAMBDA(std::int64_t k) {
            s.kick(k, h, by_saved);
        });
        relative_ = false;
    }
    /// Mixes velocities with normal noise, whose covariance is the inverse of the mass matrix at
    /// the current coordinates, including the parts of springs and dampers. `step` keys the noise.
    void thermalise(Thermostat const&, std::uint64_t step);
    void set_rates(RatesView const& out) {
        JointChains const c = chains();
        each_body<false>(
            [&](JointLoops const& loops, auto... bodies) { loops.set_rates(c, out, bodies...); },
            [c, out] CATENA_LAMBDA(std::int64_t k) { c.set_rates(k, out); });
    }
    /// Computes the motion alone, positions included.
    void move() {
        relative_ = has_rotations_ = false;
        has_orientations_ = true;
        kinematics_.evaluate(state_.view(), true, motion_.view());
        if (group_.has_tips()) set_ends();
    }
    /// Sets the ends of jointed tips from the motion, and where the two bodies meet. Rings on two
    /// ranks exchange their ends.
    void set_ends();
    /// One Newton step of close_tips(): the solver with openings instead of velocity terms.
    void correct(bool velocities);
    /// Adds `found` to `to` for entries [0, count).
    void add(std::int64_t count, DirectionsView const& found, DirectionsView const& to);
    /// Sends the acceleration of the last body's outboard end to the outboard neighbour.
    void exchange_ends() { exchange_ends(chains()); }
    void exchange_ends(JointChains const&);

  private:
    /// Configuration for the solver.
    ConfigurationView configuration() {
        MotionView const m = motion_.view();
        return {{},   m.joint_turn, {},
                m.r2, m.axes2,      has_implicit() ? compliance_.view() : View<6>{}};
    }
    bool has_implicit() const { return !group_.implicit_joint.empty(); }
    /// Allocates the arrays that only thermostats need.
    void need_for_noise() {
        if (has_noise_) return;
        has_noise_ = true;
        noise_force_ = FieldOf<3>(group_.size);
        if (!group_.has_tips()) zero_ = FieldOf<3>(group_.size);
    }
    /// Loads for the solver; views without origin are left to it.
    LoadsView loads() {
        LoadsView all{torque_.view(), has_forces_ ? force_.view() : View<3>{}, motion_.omega.view(),
                      bias_.view(), of_tips(group_, tip_bias_)};
        if (!leaves_loads_) return all;
        if (leaves_torques()) all.torque = {};
        all.gyroscopic = leaves_torques();
        View<3> const qd = state_.qd.view();
        all.revolute_rate = {qd.origin, qd.pitch, qd.size};
        if (leaves_motions_) all.revolutes = loads_of_revolutes();
        return all;
    }
    /// Loads from which the solver computes torques within runs itself.
    RevoluteLoads loads_of_revolutes() {
        RevoluteLoads all{true, kinematics_.rotations(), {}, {}, {}, {}, {}};
        View<4> const joint = joint_load_.view();
        if (given_.joint_loads) all.joint_torque = {joint.origin, joint.pitch, joint.size};
        if (given_.wrenches) {
            BodyLoadsView const given = loads_.view();
            all.torque = given.wrench_torque;
            all.force = given.wrench_force;
            all.orientation = motion_.orientation.view();
        }
        return all;
    }
    /// True if the gyroscopic torque is the only torque on bodies, on any rank, so that the solver
    /// can compute it.
    bool leaves_torques() const {
        return leaves_loads_ && !given_.joint_loads && !given_.act_on_bodies() &&
               !group_.carried_in_scene;
    }
    /// True if ranks may call follow_revolutes(), that is, if no load depends on positions. All
    /// ranks agree, although some of them may not do so.
    bool may_follow_revolutes() const { return leaves_loads_ && !needs_positions_; }
    /// True if this rank leaves the motion within runs to the solver. If the solver has runs side
    /// by side, this needs lanes with the same runs.
    bool follows_revolutes() const {
        if constexpr (has_lanes)
            if (space_.simd() != SimdLevel::off && !rounds_as_vectors()) return false;
        return eliminates_revolute_joints_ && group_.drives.empty() && !has_implicit() &&
               (lanes_ || !solver_->has_runs_side_by_side());
    }
    /// True if joints' relative motions, which the preceding step may leave undone, are computed in
    /// a loop before those of runs.
    bool joint_by_joint() const {
        return space_.has_threads_to_spare(std::ssize(group_.schedule.runs));
    }
    /// Output arrays of a full solution.
    AccelerationsView all() {
        return {alpha_.view(), acceleration_.view(), joint_force_.view(),
                of_tips(group_, tip_force_)};
    }
    /// Output arrays of the next solution. Joint forces, which no step needs, are included only if
    /// the solution will be refined. `revolutes`: accelerations of revolute joints replace those of
    /// bodies where they suffice.
    AccelerationsView found(bool revolutes) {
        has_all_ = refinement_.has_value();
        has_revolutes_ = revolutes && !has_all_;
        if (has_all_) return all();
        return {alpha_.view(),
                acceleration_.view(),
                {},
                {},
                has_revolutes_ ? revolute_acceleration_.view() : View<2>{}};
    }
    /// Completes the last solution: orientations, loads, accelerations and joint forces.
    void find_all();
    /// Codes of RevolutesInRuns for all bodies.
    static std::vector<std::uint8_t> revolutes_in_runs(ChainGroup const& group) {
        std::vector<std::uint8_t> in_run(static_cast<std::size_t>(group.size), 0);
        for (dca::Run const& run : group.schedule.runs)
            for (std::int64_t k = run.body; run.count > 1 && k < run.body + run.count; ++k)
                if (group.is_first[static_cast<std::size_t>(k)] == 0)
                    in_run[static_cast<std::size_t>(k)] =
                        k == run.body ? RevolutesInRuns::first : RevolutesInRuns::within;
        return in_run;
    }
    std::int64_t pieces() const { return std::ssize(group_.pieces); }
    std::int64_t tips() const { return std::ssize(tip_); }
    JointedTips jointed_tips() {
        return {tips_.data(),   reach_,           group_.directions,
                motion_.view(), last_end_.view(), other_end_.view()};
    }
    RatesView saved() { return {saved_qdd_.view(), saved_base_acceleration_.view()}; }
    /// Views of all arrays for loops over bodies.
    JointChains chains() {
        JointChains c;
        c.scan = kinematics_.scan(state_.view(), motion_.view());
        if (has_implicit())
            c.implicit = {of_stiffness_,      of_damping_,      implicit_list_.data(),
                          compliance_.view(), yielding_.view(), start_.view().qd};
        c.given = loads_.view();
        c.time = time_;
        c.directions = group_.directions;
        c.has_wrenches = has_wrenches_;
        c.has_forces = has_forces_;
        c.mass = mass_.view();
        c.inertia = inertia_.view();
        c.fixed_r2 = r2_.view();
        c.fixed_axes2 = axes2_.view();
        c.beads = beads_.view();
        c.joint_load = joint_load_.view();
        c.torque = torque_.view();
        c.force = force_.view();
        c.alpha = alpha_.view();
        c.acceleration = acceleration_.view();
        c.bias = bias_.view();
        c.outboard_end = outboard_end_.view();
        c.in_run = {in_run_list_.data()};
        c.left = {leaves_torques(), leaves_loads_, leaves_motions_ && !joint_by_joint()};
        if (has_revolutes_) c.revolute_acceleration = revolute_acceleration_.view();
        return c;
    }
    /// Views with zero velocities and gravity, so that rates contain the last solution only.
    JointSteps at_rest() {
        JointSteps still = steps();
        still.chains.scan.state.qd = zero_.view();
        still.chains.scan.motion.omega = zero_.view();
        still.chains.given.gravity = Vec3::zero();
        return still;
    }
    /// Views for steps of an embedded pair.
    EmbeddedSteps embedded() { return {steps(), pair_->kept.view(), pair_->kept_base.view()}; }
    JointSteps steps() { return {chains(), start_.view(), sum_.view(), saved()}; }
    /// Calls use() with the last solution, completed and copied to the host.
    template <class Use>
    auto with_solution(Use const& use);

    ChainGroup const& group_;
    Space space_;
    Communicator const& communicator_;
    std::unique_ptr<ChainSolver> solver_;
    BodyLoads given_;
    double of_stiffness_, of_damping_;
    List<std::uint8_t> implicit_list_;
    std::vector<LocalPiece> pieces_list_;
    List<LocalPiece> pieces_in_scene_;
    /// Jointed tips on the host; tips_ is their copy in the Space.
    std::vector<JointedTip> tip_;
    double reach_;
    bool has_wrenches_, has_forces_, needs_positions_, needs_orientations_,
        eliminates_revolute_joints_;
    /// Codes of RevolutesInRuns by body.
    std::vector<std::uint8_t> in_run_;
    List<std::uint8_t> in_run_list_;
    /// Orientations of all bodies are known, not only those of first bodies.
    bool has_orientations_ = true;
    /// Rotations of revolute joints are known joint by joint (RevoluteLoads).
    bool has_rotations_ = false;
    /// Some loads of the last updated configuration are left to the solver.
    bool leaves_loads_ = false;
    /// Angular velocities within runs are left to the solver as well.
    bool leaves_motions_ = false;
    /// Matrices of the last updated configuration are assembled.
    bool has_matrices_ = false;
    /// The last solution includes all accelerations and joint forces.
    bool has_all_ = true;
    /// The last solution includes revolute_acceleration_.
    bool has_revolutes_ = false;
    bool has_noise_ = false;
    /// The relative motions of the joints are known at the current state.
    bool relative_ = false;
    /// Time at the start of the current step.
    double start_time_ = 0;
    JointKinematics<Space> kinematics_;
    BodyLoadsIn<Space> loads_;
    List<JointedTip> tips_;
    CarriedBeadsIn<Space> beads_;
    Fixed<1> mass_;
    Fixed<6> inertia_;
    Fixed<3> r2_;
    Fixed<6> axes2_;
    /// State, state at the step's start, and weighted sum of its rates (accumulate).
    JointCoordinates<Space> state_, start_, sum_;
    MotionFields<Space> motion_;
    FieldOf<4> joint_load_;
    FieldOf<6> compliance_;
    FieldOf<3> yielding_, noise_force_;
    FieldOf<2> revolute_acceleration_;
    FieldOf<3> torque_, force_, alpha_, acceleration_, qdd_, saved_qdd_, base_acceleration_,
        saved_base_acceleration_;
    FieldOf<4> outboard_end_;
    FieldOf<3> zero_;
    FieldOf<13> last_end_, other_end_;  // Motions of tips' two sides.
    typename Space::Directions bias_, joint_force_, tip_bias_, tip_force_;
    std::optional<EmbeddedRates<Space>> pair_;
    std::optional<JointRefinement<Space>> refinement_;
    std::optional<JointLanes> lanes_;
};

}  // namespace catena

#include "dynamics/joint/joint_dynamics_embedded.hpp"
#include "dynamics/joint/joint_dynamics_operators.hpp"
#include "dynamics/joint/joint_dynamics_refinement.hpp"
