// Dynamics of chains of rigid bodies in absolute coordinates, in any Space, which holds the state.
// Bodies are on spherical joints, or on links together with point beads. Frames and units:
// rigid_chains.hpp.
#pragma once

#include <cmath>
#include <stdexcept>

#include "dca/host_space.hpp"
#include "dynamics/absolute_dynamics.hpp"
#include "dynamics/closing.hpp"
#include "dynamics/rigid/rigid_chains.hpp"
#include "dynamics/rigid/rigid_solution.hpp"
#include "dynamics/rigid/rigid_start.hpp"

namespace catena {

/// State, arrays and operations of rigid chains; the per-body operations are in RigidChains.
/// DeviceBeads serves OpenMM on the same GPU.
template <class Space>
class RigidDynamics final : public AbsoluteDynamics, public DeviceBeads, public ClosingDrifts {
    template <int D>
    using FieldOf = typename Space::template FieldOf<D>;
    template <int D>
    using Fixed = typename Space::template Fixed<D>;
    template <class T>
    using List = typename Space::template List<T>;

  public:
    /// `solver` must read and write views of the same Space. `implicit_step` is the step length of
    /// implicit joint springs; 0 if there are none.
    RigidDynamics(ChainGroup const& group, Scene const& scene, Space const& space,
                  Communicator const& communicator, std::unique_ptr<ChainSolver> solver,
                  double implicit_step = 0)
        : group_(group),
          space_(space),
          communicator_(communicator),
          solver_(std::move(solver)),
          given_(make_body_loads(group, scene)),
          principal_(principal_frames(group)),
          piece_(local_pieces(group, scene)),
          reach_(group.linked ? 1.0 : reach_of_joints(group, communicator)),
          of_stiffness_(rotor_of_spring(scene.dynamics.integrator) * implicit_step * implicit_step),
          implicit_(group.implicit_joint),
          loads_(given_),
          beads_(group, space),
          pieces_(piece_),
          is_first_(group.is_first),
          is_last_(group.is_last),
          joint_(group.joint),
          jointed_tip_(group.jointed_tip),
          mass_(group.mass),
          inverse_mass_(group.inverse_mass),
          length_(group.length),
          inertia_(group.inertia),
          r1_(group.r1),
          r2_(group.r2),
          joint_frame_(group.joint_rotation),
          principal_axes_(principal_.axes),
          principal_moment_(principal_.moment),
          position_(group.size),
          velocity_(group.size),
          omega_(group.size),
          orientation_(group.size),
          observed_velocity_(group.size),
          observed_omega_(group.size),
          force_(group.size),
          torque_(group.size),
          momentum_(group.size),
          moment_(group.size),
          acceleration_(group.size),
          alpha_(group.size),
          inboard_end_(group.size),
          outboard_end_(group.size),
          joint_torque_(given_.joint_loads ? group.size : 0),
          rotor_(rotors()),
          spring_(rotors()),
          flown_(rotors()),
          compliance_(rotors()),
          direction_(group.linked ? group.size : 0),
          tip_direction_(group.linked && group.has_tips() ? group.size : 0),
          bias_(group.size + 1, group.directions),
          joint_force_(group.size + 1, group.directions),
          tip_bias_(group.has_tips() ? group.size : 0, group.directions),
          tip_force_(group.has_tips() ? group.size : 0, group.directions),
          tip_(start(scene)),
          tips_(tip_),
          rings_(group.rings),
          ring_ends_(group, space, communicator) {
        if (rotors() == 0) return;
        exchange_from_inboard(communicator_, group_, orientation_.view(), space_);
        take_rotors(omega_.view());
    }

    void update_configuration() override {
        if (given_.springs)
            exchange_from_inboard(communicator_, group_, orientation_.view(), space_);
        if (rotors() > 0)
            space_.for_each(group_.size, [c = chains()] CATENA_LAMBDA(std::int64_t k) {
                c.rotors.set_compliance(k);
            });
        if (!group_.linked) return;
        set_ends();
        space_.for_each(group_.size,
                        [c = chains()] CATENA_LAMBDA(std::int64_t k) { c.set_directions(k); });
        space_.for_each(std::ssize(group_.rings),
                        [c = chains(), ring = rings_.data()] CATENA_LAMBDA(std::int64_t i) {
                            c.set_first_direction(ring[i], i);
                        });
        exchange_from_outboard(communicator_, group_, direction_.view(), space_);
    }
    void assemble_matrices() override {
        held([&] { solver_->assemble_matrices(configuration()); });
    }
    void set_simple_forces() override {
        RigidChains const c = chains();
        if (given_.joint_loads) {
            space_.for_each(group_.size,
                            [c] CATENA_LAMBDA(std::int64_t k) { c.set_joint_torque(k); });
            exchange_from_outboard(communicator_, group_, joint_torque_.view(), space_);
        }
        space_.for_each(group_.size, [c] CATENA_LAMBDA(std::int64_t k) { c.set_forces(k); });
    }
    View<3> bead_forces() override { return beads_.bead_forces(); }
    ConstView<3> bead_positions() override {
        space_.for_each(count(), [c = chains()] CATENA_LAMBDA(std::int64_t i) { c.put_bead(i); });
        return beads_.bead_positions();
    }
    void take_bead_forces() override {
        beads_.take_bead_forces();
        if (beads_.any())
            space_.for_each(group_.size, [c = chains()] CATENA_LAMBDA(std::int64_t k) {
                c.take_bead_forces(k);
            });
    }

    // DeviceBeads: data exchange with OpenMM on the same GPU. On the host on_device() is null.
    DeviceBeads* on_device() override { return stream() ? this : nullptr; }
    std::int64_t count() const override { return group_.carried_beads(); }
    void* stream() const override {
        if constexpr (requires { space_.stream(); }) return space_.stream();
        return nullptr;
    }
    void put_positions(DeviceParticles const& particles) override {
        space_.for_each(count(), [c = chains(), particles] CATENA_LAMBDA(std::int64_t i) {
            particles.put(i, c.put_bead(i));
        });
    }
    void show(ShownBeads const& shown) override {
        space_.for_each(count(), [c = chains(), shown] CATENA_LAMBDA(std::int64_t i) {
            shown.show(i, c.put_bead(i));
        });
    }
    void add_forces(DeviceParticles const& particles) override {
        space_.for_each(count(), [c = chains(), particles] CATENA_LAMBDA(std::int64_t i) {
            c.add_bead_force(i, particles);
        });
    }
    ConstView<3> host_positions() override { return bead_positions(); }

    void kick(double h) override {
        project(h, velocity_.view(), omega_.view());
        if (rotors() > 0) take_rotors(omega_.view());
    }
    void observe(double h) override {
        project(h, observed_velocity_.view(), observed_omega_.view());
    }
    /// Drift with the constraint impulses in the momenta at its start, as RATTLE requires. The free
    /// rotor runs again in every sweep (src/dca/README.md, "Rigid bodies under RATTLE").
    void drift(double h, int sweeps) override {
        for (int sweep = 0; sweep < sweeps; ++sweep) {
            fly({h, sweep == 0, false});
            correct(h);
        }
        fly({h, sweeps == 0, true});
    }
    int drift_closing(double h, int sweeps, Closing const& closing) override {
        fly({h, true, false});
        auto const sweep = [&] {
            correct(h);
            fly({h, false, false});
        };
        for (int i = 0; i < sweeps; ++i) sweep();
        int const more =
            closing.close(sweeps, [&] { return communicator_.max(error_at_ends()); }, sweep);
        forget_correction();
        fly({h, false, true});
        return more;
    }
    void thermalise(Thermostat const& t, std::uint64_t step) override {
        add_noise({t, step, NoiseStage::thermostat, NoiseStage::thermostat_angular, true}, 0,
                  group_.size);
    }
    void draw_velocities(double kt, std::uint64_t seed,
                         std::vector<bool> const& of_chain) override {
        for (dca::Piece const& piece : group_.pieces)
            if (of_chain[piece.chain])
                add_noise({{0.0, std::sqrt(kt), seed}}, piece.local, piece.count);
        kick(0.0);
    }

    double constraint_error() override {
        check();
        return agreed_error();
    }
    double agreed_error() override { return communicator_.max(own_error()); }
    std::string trouble() override {
        DeferredError found;
        found.hold([&] { check(); });
        return found.text();
    }
    double own_error() override {
        set_ends();
        return error_at_ends();
    }
    double own_error_beyond(double /*tolerance*/) override { return own_error(); }

    std::vector<StateArray> state() const override {
        check();
        std::vector<StateArray> all{
            to_array<3>("position", space_.read(position_).view(), space_.on_host()),
            to_array<3>("velocity", space_.read(velocity_).view(), space_.on_host()),
            to_array<4>("orientation", space_.read(orientation_).view(), space_.on_host()),
            to_array<3>("omega", space_.read(omega_).view(), space_.on_host())};
        // Stored on ranks without implicit joints too.
        if (of_stiffness_ > 0)
            all.push_back(to_array<3>("rotor", space_.read(rotor_).view(), space_.on_host()));
        return all;
    }
    void set_state(std::vector<StateArray> const& arrays) override {
        trouble_.forget();
        space_.edit(position_, [&](View<3> view) {
            from_array<3>(array_named(arrays, "position"), view, space_.on_host());
        });
        space_.edit(velocity_, [&](View<3> view) {
            from_array<3>(array_named(arrays, "velocity"), view, space_.on_host());
        });
        space_.edit(orientation_, [&](View<4> view) {
            from_array<4>(array_named(arrays, "orientation"), view, space_.on_host());
        });
        space_.edit(omega_, [&](View<3> view) {
            from_array<3>(array_named(arrays, "omega"), view, space_.on_host());
        });
        if (rotors() > 0)
            space_.edit(rotor_, [&](View<3> view) {
                from_array<3>(array_named(arrays, "rotor"), view, space_.on_host());
            });
    }
    ObservedMotion observed() override {
        check();
        return {space_.pull(position_, position_mirror_),
                space_.pull(observed_velocity_, velocity_mirror_),
                space_.pull(orientation_, orientation_mirror_),
                space_.pull(observed_omega_, omega_mirror_)};
    }

    void evaluate() override {
        if (rotors() > 0)
            throw std::logic_error("forces of implicit joints are known within a step only");
        trouble_.check();
        set_loads();
        solver_->solve(loads(), found());
    }
    void evaluate_at_once() override {
        set_loads();
        solver_->assemble_and_solve(configuration(), loads_at_once(), found());
    }
    std::vector<double> time_at_once(int chained, int repeat) override {
        AccelerationsView out = found();
        out.joint_force = {};
        return solver_->time_evaluations(configuration(), loads_at_once(), out, chained, repeat);
    }
    BodyResults results() const override {
        check();
        return with_solution([](RigidSolution const& s) { return s.results(); });
    }
    double residual() override {
        check();
        return with_solution([&](RigidSolution const& s) { return s.residual(communicator_); });
    }
    PotentialEnergy potential() override {
        exchange_from_inboard(communicator_, group_, orientation_.view(), space_);
        return potential_of(group_, given_, space_.read(position_), space_.read(orientation_));
    }
    ChainGroup const& group() const override { return group_; }
    ChainSolver& solver() const override { return *solver_; }

    // Members below are public because nvcc accepts device lambdas in public members only.
    /// Constraint projection P (v + h M^-1 f): with momenta instead of forces, the solver returns
    /// velocities instead of accelerations.
    void project(double h, View<3> velocity, View<3> omega) {
        space_.for_each(group_.size,
                        [c = chains(), h] CATENA_LAMBDA(std::int64_t k) { c.set_momenta(k, h); });
        solver_->solve({moment_.view(),
                        momentum_.view(),
                        {},
                        rotors() > 0 ? bias_.view() : DirectionsView{},
                        {}},
                       {omega, velocity, {}, {}});
    }
    /// Free flight of all bodies from the drift's start. Unless it is the last one, the new handles
    /// are exchanged with neighbours.
    void fly(DriftSweep const& s) {
        space_.for_each(group_.size,
                        [c = chains(), s] CATENA_LAMBDA(std::int64_t k) { c.fly(k, s); });
        if (!s.last) show_ends();
    }
    /// Finds the corrections of velocities at the drift's start that close the joints at the end of
    /// the last fly().
    void correct(double h) {
        space_.for_each(group_.size, [c = chains(), scale = 1.0 / h] CATENA_LAMBDA(std::int64_t k) {
            c.set_openings(k, scale);
        });
        solver_->solve({{}, {}, {}, bias_.view(), of_tips(group_, tip_bias_)},
                       {alpha_.view(), acceleration_.view(), {}, {}});
        if (rotors() > 0) add_to_rotors();
    }
    /// Clears the corrections that the velocities already include.
    void forget_correction() {
        space_.for_each(group_.size, [a = acceleration_.view(),
                                      t = alpha_.view()] CATENA_LAMBDA(std::int64_t k) {
            a.store(k, Vec3::zero());
            t.store(k, Vec3::zero());
        });
    }
    /// Largest constraint error on this rank at the handles of the last fly() or set_ends().
    double error_at_ends() {
        return space_.largest(group_.size, [c = chains()] CATENA_LAMBDA(std::int64_t k) -> double {
            return c.error(k);
        });
    }
    /// Sets the rotors' rates to those of their joints.
    void take_rotors(View<3> omega) {
        exchange_from_inboard(communicator_, group_, omega, space_);
        space_.for_each(group_.size, [c = chains(), omega] CATENA_LAMBDA(std::int64_t k) {
            c.rotors.take(k, omega);
        });
    }
    /// Adds a sweep's corrections to the rotors' rates.
    void add_to_rotors() {
        exchange_from_inboard(communicator_, group_, alpha_.view(), space_);
        space_.for_each(group_.size, [c = chains()] CATENA_LAMBDA(std::int64_t k) {
            c.rotors.add(c.bias, k, c.alpha);
        });
    }
    /// Mixes the velocities of bodies [first, first + count) with noise.
    void add_noise(RigidNoise const& noise, std::int64_t first, std::int64_t count) {
        space_.for_each(count, [c = chains(), noise, first] CATENA_LAMBDA(std::int64_t i) {
            c.add_noise(first + i, noise);
        });
    }
    /// Computes all handles at the current poses and exchanges them.
    void set_ends() {
        space_.for_each(group_.size,
                        [c = chains()] CATENA_LAMBDA(std::int64_t k) { c.set_ends(k); });
        show_ends();
    }
    /// Exchanges the handles that neighbours need, within and across ranks.
    void show_ends() {
        exchange_from_inboard(communicator_, group_, outboard_end_.view(), space_);
        if (rotors() > 0) exchange_from_inboard(communicator_, group_, flown_.view(), space_);
        ring_ends_.take(inboard_end_.view(), outboard_end_.view());
    }
    /// Sets moments and velocity biases for an evaluation.
    void set_loads() {
        RigidChains const c = chains();
        space_.for_each(group_.size, [c] CATENA_LAMBDA(std::int64_t k) { c.set_moment(k); });
        if (group_.linked) show_ends();
        space_.for_each(group_.size, [c] CATENA_LAMBDA(std::int64_t k) { c.set_turnings(k); });
    }

  private:
    /// Runs `action`. On the host it keeps a pivot failure until the next check(); on a GPU the
    /// solver keeps it.
    template <class Action>
    void held(Action const& action) {
        if constexpr (Space::answers_at_once)
            trouble_.hold(action);
        else
            action();
    }
    /// Throws ComputationError if a pivot failure is pending on this rank.
    void check() const {
        solver_->check();
        trouble_.check();
    }
    /// Sets the state to the scene's start. Returns the attachments of tips there.
    std::vector<HeldTip> start(Scene const& scene) {
        RigidStart const at = place_bodies(group_, scene, communicator_);
        fill(space_, position_, at.position);
        fill(space_, velocity_, at.velocity);
        fill(space_, omega_, at.omega);
        fill(space_, orientation_, at.orientation);
        return held_tips(group_, [&](std::int64_t k) {
            return at.position[k] + to_matrix(as_quaternion(at.orientation[k])) * group_.r2[k];
        });
    }
    ConfigurationView configuration() const {
        if (!group_.linked)
            return {{}, orientation_.view(),
                    {}, {},
                    {}, rotors() > 0 ? ConstView<6>(compliance_.view()) : ConstView<6>{}};
        return {direction_.view(),
                orientation_.view(),
                group_.has_tips() ? ConstView<3>(tip_direction_.view()) : ConstView<3>{},
                {},
                {}};
    }
    /// Loads of an evaluation.
    LoadsView loads() {
        return {moment_.view(), force_.view(), observed_omega_.view(), bias_.view(),
                of_tips(group_, tip_bias_)};
    }
    /// Loads for assemble_and_solve(): the solver adds the gyroscopic torque and the centripetal
    /// terms.
    LoadsView loads_at_once() {
        LoadsView l = loads();
        if (group_.linked) return l;
        l.torque = torque_.view();
        l.gyroscopic = true;
        l.bias = {};
        return l;
    }
    /// Output arrays of an evaluation.
    AccelerationsView found() {
        return {alpha_.view(), acceleration_.view(), joint_force_.view(),
                of_tips(group_, tip_force_)};
    }
    /// Views of all arrays for loops over bodies.
    RigidChains chains() {
        RigidChains c;
        c.linked = group_.linked;
        c.reach = reach_;
        c.is_first = is_first_.data();
        c.is_last = is_last_.data();
        c.joint = joint_.data();
        c.jointed_tip = tip_.empty() ? nullptr : jointed_tip_.data();
        c.tip = tips_.data();
        c.ring_ends = ring_ends_.view();
        c.piece = pieces_.data();
        c.pieces = std::ssize(piece_);
        c.mass = mass_.view();
        c.inverse_mass = inverse_mass_.view();
        c.length = length_.view();
        c.inertia = inertia_.view();
        c.r1 = r1_.view();
        c.r2 = r2_.view();
        c.joint_frame = joint_frame_.view();
        c.principal_axes = principal_axes_.view();
        c.principal_moment = principal_moment_.view();
        c.given = loads_.view();
        if (rotors() > 0)
            c.rotors = {of_stiffness_,     implicit_.data(),    is_first_.data(),
                        c.given.stiffness, orientation_.view(), rotor_.view(),
                        spring_.view(),    flown_.view(),       compliance_.view()};
        c.beads = beads_.view();
        c.position = position_.view();
        c.velocity = velocity_.view();
        c.omega = omega_.view();
        c.orientation = orientation_.view();
        c.observed_velocity = observed_velocity_.view();
        c.observed_omega = observed_omega_.view();
        c.force = force_.view();
        c.torque = torque_.view();
        c.momentum = momentum_.view();
        c.moment = moment_.view();
        c.acceleration = acceleration_.view();
        c.alpha = alpha_.view();
        c.inboard_end = inboard_end_.view();
        c.outboard_end = outboard_end_.view();
        c.joint_torque = joint_torque_.view();
        c.direction = direction_.view();
        c.tip_direction = tip_direction_.view();
        c.bias = bias_.view();
        c.tip_bias = tip_bias_.view();
        return c;
    }
    /// Size of the rotors' arrays: one entry per body if any joint is implicit, else 0.
    std::int64_t rotors() const { return std::ssize(group_.implicit_joint); }
    /// Calls use() with the results of the last evaluation, copied to the host.
    template <class Use>
    auto with_solution(Use const& use) const {
        auto const& orientation = space_.read(orientation_);
        auto const &omega = space_.read(observed_omega_), &force = space_.read(force_),
                   &torque = space_.read(torque_), &moment = space_.read(moment_),
                   &alpha = space_.read(alpha_), &acceleration = space_.read(acceleration_),
                   &direction = space_.read(direction_),
                   &tip_direction = space_.read(tip_direction_);
        auto const &bias = space_.read(bias_), &joint_force = space_.read(joint_force_),
                   &tip_bias = space_.read(tip_bias_), &tip_force = space_.read(tip_force_);
        return use(RigidSolution{group_, orientation.view(), omega.view(), force.view(),
                                 torque.view(), moment.view(), alpha.view(), acceleration.view(),
                                 direction.view(), tip_direction.view(), bias.view(),
                                 joint_force.view(), tip_bias.view(), tip_force.view()});
    }

    ChainGroup const& group_;
    Space space_;
    Communicator const& communicator_;
    std::unique_ptr<ChainSolver> solver_;
    BodyLoads given_;
    PrincipalFrames principal_;
    std::vector<LocalPiece> piece_;
    double reach_, of_stiffness_;
    List<std::uint8_t> implicit_;
    BodyLoadsIn<Space> loads_;
    CarriedBeadsIn<Space> beads_;
    List<LocalPiece> pieces_;
    List<std::uint8_t> is_first_, is_last_;
    List<JointType> joint_;
    List<std::int32_t> jointed_tip_;
    Fixed<1> mass_, inverse_mass_, length_;
    Fixed<6> inertia_;
    Fixed<3> r1_, r2_;
    Fixed<4> joint_frame_, principal_axes_;
    Fixed<3> principal_moment_;
    FieldOf<3> position_, velocity_, omega_;
    FieldOf<4> orientation_;
    FieldOf<3> observed_velocity_, observed_omega_, force_, torque_, momentum_, moment_,
        acceleration_, alpha_, inboard_end_, outboard_end_, joint_torque_;
    FieldOf<3> rotor_, spring_;  // JointRotors::rate and JointRotors::torque.
    FieldOf<4> flown_;
    FieldOf<6> compliance_;
    FieldOf<3> direction_, tip_direction_;
    typename Space::Directions bias_, joint_force_, tip_bias_, tip_force_;
    std::vector<HeldTip> tip_;
    List<HeldTip> tips_;
    List<LocalRing> rings_;
    RingEnds<Space> ring_ends_;
    typename Space::template Mirror<3> position_mirror_, velocity_mirror_, omega_mirror_;
    typename Space::template Mirror<4> orientation_mirror_;
    DeferredError trouble_;
};

}  // namespace catena
