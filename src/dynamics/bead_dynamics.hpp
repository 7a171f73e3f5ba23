// Dynamics of chains of point beads on links in absolute coordinates, in any Space, which holds the
// state. Ground axes (W); nm, ps, amu, kJ/mol, unless the scene has `units: si`.
#pragma once

#include <cmath>
#include <type_traits>
#include <utility>

#include "dca/solvers/tree_solver.hpp"
#include "dynamics/absolute_dynamics.hpp"
#include "dynamics/bead_step.hpp"
#include "dynamics/bead_term.hpp"
#include "dynamics/closing.hpp"

namespace catena {

/// For each local bead, 1 if it has an inboard link, else 0.
std::vector<std::uint8_t> links_of(ChainGroup const&);
/// Fills the starting positions and velocities of the scene.
void place_beads(ChainGroup const&, Scene const&, View<3> position, View<3> velocity,
                 Executor const&);

/// Results of the last evaluate() of bead chains, on the host.
struct BeadSolution {
    ChainGroup const& group;
    ConstView<3> force, acceleration, direction, tip_direction;
    ConstDirectionsView joint_force, tip_force;
    /// Force of the outboard link of bead k on the next bead or on the ground; minus the force on
    /// bead k. Precondition: the chains are not branched.
    Vec3 outboard_force(std::int64_t k) const;
    /// Sum of the forces of a bead's outboard links on the beads outboard of it, and the sum of
    /// their sizes.
    struct Outboard {
        Vec3 force = Vec3::zero();
        double size = 0;
    };
    /// Returns the outboard forces of every bead.
    std::vector<Outboard> outboard_forces() const;
    BodyResults results() const;
    /// Largest local backward residual over all ranks. `velocity`: velocities of the evaluation,
    /// with halo. Collective.
    double residual(Communicator const&, ConstView<3> velocity, std::vector<HeldTip> const&) const;
};

/// 1 / (2 length) of each link; 0 without a link.
Field<1> halves_over(Field<1> const& length, Executor const&);

/// State, arrays and operations of bead chains; DeviceBeads serves OpenMM on the same GPU,
/// ClosingDrifts the closing of links.
/// `Fields` is BranchedFields for branched and cross-linked chains.
template <class Space, class Fields = BeadFields>
class BeadDynamics final : public AbsoluteDynamics, public DeviceBeads, public ClosingDrifts {
    using Field3 = typename Space::template FieldOf<3>;
    template <class T>
    using List = typename Space::template List<T>;
    using Chains = BeadChainsIn<Fields>;
    static constexpr bool is_branched = std::is_same_v<Fields, BranchedFields>;

  public:
    /// `solver` must read and write views of the same Space.
    BeadDynamics(ChainGroup const& group, Scene const& scene, Space const& space,
                 Communicator const& communicator, std::unique_ptr<ChainSolver> solver)
        : group_(group),
          space_(space),
          communicator_(communicator),
          solver_(std::move(solver)),
          given_(make_body_loads(group, scene)),
          links_(links_of(group)),
          halves_(halves_over(group.length, space.on_host())),
          piece_(local_pieces(group, scene)),
          tip_(held_tips(group,
                         [&](std::int64_t k) {
                             return scene.chains[group.scene_chain(k)].beads.position.back();
                         })),
          lists_{List<std::uint8_t>(group.is_first), List<std::uint8_t>(links_),
                 List<std::int64_t>(group.inboard)},
          pieces_(piece_),
          tips_(tip_),
          mass_(group.mass),
          inverse_mass_(group.inverse_mass),
          length_(group.length),
          half_over_length_(halves_),
          position_(group.size),
          velocity_(group.size),
          observed_(group.size),
          force_(group.size),
          momentum_(group.size),
          change_(group.size),
          direction_(group.link_entries()),
          tip_direction_(group.has_tips() ? group.size : 0),
          bias_(group.link_entries() + 1, group.directions),
          joint_force_(group.link_entries() + 1, group.directions),
          tip_bias_(group.has_tips() ? group.size : 0, group.directions),
          tip_force_(group.has_tips() ? group.size : 0, group.directions),
          ring_ends_(group, space, communicator) {
        space_.set(position_, [&](View<3> position) {
            space_.set(velocity_, [&](View<3> velocity) {
                place_beads(group, scene, position, velocity, space_.on_host());
            });
        });
    }

    void update_configuration() override { parts().update_configuration(); }
    void assemble_matrices() override {
        held([&] { solver_->assemble_matrices(directions()); });
    }
    void set_simple_forces() override {
        forces_ = {given_.gravity, {}};
        forces_are_ahead_ = true;
        if (terms_.empty()) return;
        settle_forces();
        for (auto const& term : terms_) term->add_forces(directions(), force_.view());
    }
    /// Adds a term to the forces. Host only.
    void use(std::unique_ptr<BeadTerm> term) { terms_.push_back(std::move(term)); }
    BodyLoads const& given() const { return given_; }
    View<3> bead_forces() override {
        settle_forces();
        forces_are_out_ = true;
        return space_.pull(force_, force_mirror_);
    }
    ConstView<3> bead_positions() override { return space_.pull(position_, position_mirror_); }
    void take_bead_forces() override {
        if (std::exchange(forces_are_out_, false)) space_.push(force_, force_mirror_);
    }

    // DeviceBeads: data exchange with OpenMM on the same GPU. On the host on_device() is null.
    DeviceBeads* on_device() override { return stream() ? this : nullptr; }
    std::int64_t count() const override { return group_.size; }
    void* stream() const override {
        if constexpr (requires { space_.stream(); }) return space_.stream();
        return nullptr;
    }
    void put_positions(DeviceParticles const& particles) override {
        if (put_at_step_ == particles.order) return;
        space_.for_each(group_.size, [particles, x = ConstView<3>(position_.view())] CATENA_LAMBDA(
                                         std::int64_t k) { particles.put(k, x.load(k)); });
    }
    void show(ShownBeads const& shown) override {
        space_.for_each(group_.size, [shown, x = ConstView<3>(position_.view())] CATENA_LAMBDA(
                                         std::int64_t k) { shown.show(k, x.load(k)); });
    }
    void add_forces(DeviceParticles const& particles) override { forces_.particles = particles; }
    ConstView<3> host_positions() override { return bead_positions(); }

    void kick(double h) override {
        settle_forces();
        parts().kick(h);
    }
    void observe(double h) override {
        settle_forces();
        parts().project(h, observed_.view());
    }
    void drift(double h, int sweeps) override {
        put_at_step_ = never;
        parts().drift(h, sweeps);
    }
    bool close_further(double h) override {
        parts().close(h);
        return true;
    }
    int drift_closing(double h, int sweeps, Closing const& closing) override {
        drift(h, sweeps);
        return closing.close(sweeps, [&] { return agreed_error(); }, [&] { parts().close(h); });
    }
    void thermalise(Thermostat const& thermostat, std::uint64_t step) override {
        parts().thermalise(thermostat, step);
    }
    /// Takes the whole step in one launch, block by block, if the solver can and it is faster.
    void step(ConstrainedStep const& step) override {
        if (!carry<dca::BeadLeaf<1>>(step) && !carry<dca::BeadLeaf<3>>(step))
            AbsoluteDynamics::step(step);
    }

    void draw_velocities(double kt, std::uint64_t seed,
                         std::vector<bool> const& of_chain) override {
        auto const drawn = [&](std::size_t i) {
            return of_chain[static_cast<std::size_t>(group_.pieces[i].chain)];
        };
        for (std::size_t i = 0, end = 0; i < group_.pieces.size();
             i = end) {  // One loop over neighbouring pieces.
            std::int64_t count = 0;
            for (end = i; end < group_.pieces.size() && drawn(end) == drawn(i); ++end)
                count += group_.pieces[end].count;
            if (drawn(i))
                space_.for_each(
                    count, [c = chains(), kt, seed, first = group_.pieces[i].local] CATENA_LAMBDA(
                               std::int64_t k) { c.draw_velocity(first + k, kt, seed); });
        }
        kick(0.0);
    }

    double constraint_error() override {
        // The next reader of the forces reports what is wrong with them.
        settle_forces();
        check();
        return agreed_error();
    }
    double agreed_error() override {
        settle_forces();
        exchange_from_inboard(communicator_, group_, position_.view(), space_);
        ring_ends_.take(position_.view(), position_.view());
        return communicator_.max(own_error());
    }
    std::string trouble() override {
        DeferredError found;
        found.hold([&] { check(); });
        return found.text();
    }
    /// Precondition: update_configuration() has brought the neighbours' positions.
    double own_error() override {
        Chains const c = chains();
        double const along = space_.largest(
            group_.size, [c] CATENA_LAMBDA(std::int64_t k) -> double { return c.error(k); });
        double const at_tips = space_.largest(
            tips(), [c] CATENA_LAMBDA(std::int64_t i) -> double { return c.tip_error(i); });
        double worst = larger(along, at_tips);
        for (std::int64_t i = 0; i < std::ssize(group_.crosslinks); ++i)
            worst = larger(worst, c.error(group_.first_crosslink() + i));
        return worst;
    }
    double own_error_beyond(double tolerance) override {
        if constexpr (Space::answers_at_once)
            if (closed_within(tolerance)) return 0;
        return own_error();
    }

    std::vector<StateArray> state() const override {
        check();
        return {to_array<3>("position", space_.read(position_).view(), space_.on_host()),
                to_array<3>("velocity", space_.read(velocity_).view(), space_.on_host())};
    }
    void set_state(std::vector<StateArray> const& arrays) override {
        put_at_step_ = never;
        trouble_.forget();
        space_.edit(position_, [&](View<3> view) {
            from_array<3>(array_named(arrays, "position"), view, space_.on_host());
        });
        space_.edit(velocity_, [&](View<3> view) {
            from_array<3>(array_named(arrays, "velocity"), view, space_.on_host());
        });
    }
    ObservedMotion observed() override {
        check();
        return {.position = space_.pull(position_, observed_position_mirror_),
                .velocity = space_.pull(observed_, observed_mirror_)};
    }

    void evaluate() override {
        trouble_.check();
        settle_forces();
        exchange_from_inboard(communicator_, group_, observed_.view(), space_);
        ring_ends_.take(observed_.view(), observed_.view());
        Chains const c = chains();
        space_.for_each(group_.size, [c] CATENA_LAMBDA(std::int64_t k) { c.set_swing(k); });
        space_.for_each(tips(), [c] CATENA_LAMBDA(std::int64_t i) { c.set_tip_swing(i); });
        Way{*this}.each_crosslink([c] CATENA_LAMBDA(std::int64_t k) { c.set_swing(k); });
        solver_->solve({{}, force_.view(), {}, bias_.view(), of_tips(group_, tip_bias_)},
                       {{}, change_.view(), joint_force_.view(), of_tips(group_, tip_force_)});
    }
    void evaluate_at_once() override {
        if (group_.has_tips() || !solver_->at_once()) return AbsoluteDynamics::evaluate_at_once();
        settle_forces();
        exchange_from_inboard(communicator_, group_, observed_.view(), space_);
        exchange_from_outboard(communicator_, group_, observed_.view(), space_);
        solver_->assemble_and_solve(where(), what(), {{}, change_.view(), joint_force_.view(), {}});
    }
    std::vector<double> time_at_once(int chained, int repeat) override {
        settle_forces();
        return solver_->time_evaluations(where(), what(), {{}, change_.view(), {}, {}}, chained,
                                         repeat);
    }
    BodyResults results() const override {
        check();
        return with_solution([](BeadSolution const& s) { return s.results(); });
    }
    double residual() override {
        check();
        exchange_from_inboard(communicator_, group_, observed_.view(), space_);
        auto const& observed = space_.read(observed_);
        return with_solution([&](BeadSolution const& s) {
            return s.residual(communicator_, observed.view(), tip_);
        });
    }
    PotentialEnergy potential() override {
        // OpenMM's energy computation overwrites its forces, so sum them first.
        settle_forces();
        auto const& position = space_.read(position_);
        PotentialEnergy energy = potential_of(given_, group_.size, [&](std::int64_t k) {
            return terms::PlacedBody{k, group_.mass.view().at(k, 0), position[k]};
        });
        for (auto const& term : terms_) term->set_energy(energy);
        return energy;
    }
    ChainGroup const& group() const override { return group_; }
    ChainSolver& solver() const override { return *solver_; }

    /// Execution policy of a step: one loop over all chains after the other (bead_step.hpp). Public
    /// because of nvcc.
    struct Way {
        BeadDynamics& d;
        template <class Action>
        void each_bead(Action const& action) const {
            d.space_.for_each(d.group_.size, action);
        }
        template <class Make, class Take>
        void each_bead(Make const& make, Take const& take) const {
            d.space_.for_each(d.group_.size,
                              [make, take] CATENA_LAMBDA(std::int64_t k) { take(k, make(k)); });
        }
        template <class Action>
        void each_link(Action const& action) const {
            d.space_.for_each(d.group_.size + (d.group_.neighbour_outboard >= 0 ? 1 : 0), action);
        }
        template <class Action>
        void each_tip(Action const& action) const {
            d.space_.for_each(d.tips(), action);
        }
        template <class Action>
        void each_crosslink(Action const& action) const {
            if constexpr (Fields::has_crosslinks) d.over_crosslinks(action);
        }
        void from_inboard() const {
            exchange_from_inboard(d.communicator_, d.group_, d.position_.view(), d.space_);
            d.ring_ends_.take(d.position_.view(), d.position_.view());
        }
        void from_outboard() const {
            exchange_from_outboard(d.communicator_, d.group_, d.position_.view(), d.space_);
        }
        void assemble() const { d.assemble_matrices(); }
        void project(View<3> momentum, View<3> out) const {
            d.solver_->solve({{}, momentum, {}, {}, {}}, {{}, out, {}, {}});
        }
        void close(DirectionsView bias, DirectionsView tip_bias, View<3> out) const {
            d.solver_->solve({{}, {}, {}, bias, tip_bias}, {{}, out, {}, {}});
        }
    };

    /// Sums the pending forces into the force array; every reader of that array calls it first.
    void settle_forces() override {
        if (std::exchange(forces_are_ahead_, false))
            space_.for_each(group_.size, [c = chains(), f = forces_] CATENA_LAMBDA(std::int64_t k) {
                c.take_forces(k, f);
            });
    }

    /// Calls action(link) for every cross-link. Public because of nvcc.
    template <class Action>
    void over_crosslinks(Action const& action) const {
        space_.for_each(std::ssize(group_.crosslinks),
                        [action, first = group_.first_crosslink()] CATENA_LAMBDA(std::int64_t i) {
                            action(first + i);
                        });
    }

  private:
    static constexpr std::int64_t never = -1;
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
    /// True if own_error() is known to be at most `tolerance`.
    bool closed_within(double tolerance) {
        Chains const c = chains();
        for (dca::Piece const& p : group_.pieces)
            if (!(c.error(p.local) <= tolerance) ||
                !c.closed_along(p.local + 1, p.local + p.count, tolerance))
                return false;
        for (std::int64_t i = 0; i < tips(); ++i)
            if (!(c.tip_error(i) <= tolerance)) return false;
        for (std::int64_t i = 0; i < std::ssize(group_.crosslinks); ++i)
            if (!(c.error(group_.first_crosslink() + i) <= tolerance)) return false;
        return true;
    }
    /// The parts of a step, executed loop by loop.
    BeadStep<Way, Fields> parts() { return {chains(), {*this}}; }
    /// Takes a step in one launch if the solver is a TreeSolver with this leaf that supports it.
    /// Returns true if it did.
    template <class Leaf>
    bool carry(ConstrainedStep const& step) {
        if constexpr (Space::template has_blocks<Leaf::K> && !is_branched) {
            auto* const solver = dynamic_cast<dca::TreeSolver<Leaf, Space>*>(solver_.get());
            if (solver == nullptr || !solver->carries()) return false;
            held([&] {
                solver->carry(directions(), step.matrix_sweeps(), step.bias_sweeps(),
                              [&](dca::TreeSweeps<Leaf> const& sweeps) {
                                  return StepOfChains<Leaf>{sweeps, chains(), step,
                                                            forces_are_ahead_, forces_};
                              });
            });
            put_at_step_ =
                forces_are_ahead_ && forces_.particles.bead ? forces_.particles.order : never;
            return true;
        }
        return false;
    }
    /// Configuration for the solver by link directions.
    ConfigurationView directions() {
        return {
            direction_.view(), {}, group_.has_tips() ? tip_direction_.view() : View<3>{}, {}, {}};
    }
    /// Configuration for assemble_and_solve() by positions; the solver computes the directions.
    ConfigurationView where() const {
        ConfigurationView at;
        at.direction = direction_.view();
        at.position = position_.view();
        at.piece = pieces_.data();
        at.pieces = std::ssize(piece_);
        return at;
    }
    /// Loads for assemble_and_solve() with velocities; the solver computes the biases.
    LoadsView what() const {
        LoadsView loads;
        loads.force = force_.view();
        loads.velocity = observed_.view();
        return loads;
    }
    std::int64_t tips() const { return std::ssize(tip_); }
    /// Views of all arrays for loops over beads.
    Chains chains() {
        Chains c;
        if constexpr (is_branched) {
            c.places.inboard_bead = lists_.inboard.data();
            c.places.crosslink = group_.crosslinks.data();
        }
        c.places.size = group_.size;
        c.places.is_first = lists_.is_first.data();
        c.places.has_link = lists_.has_link.data();
        c.mass = mass_.view();
        c.inverse_mass = inverse_mass_.view();
        c.length = length_.view();
        c.half_over_length = half_over_length_.view();
        c.places.piece = pieces_.data();
        c.places.pieces = std::ssize(piece_);
        c.tip = tips_.data();
        c.position = position_.view();
        c.velocity = velocity_.view();
        c.observed = observed_.view();
        c.force = force_.view();
        c.momentum = momentum_.view();
        c.change = change_.view();
        c.direction = direction_.view();
        c.tip_direction = tip_direction_.view();
        c.ring_ends = ring_ends_.view();
        c.bias = bias_.view();
        c.tip_bias = of_tips(group_, tip_bias_);
        return c;
    }
    /// Calls use() with the results of the last evaluation, copied to the host.
    template <class Use>
    auto with_solution(Use const& use) const {
        auto const &force = space_.read(force_), &acceleration = space_.read(change_),
                   &direction = space_.read(direction_),
                   &tip_direction = space_.read(tip_direction_);
        auto const &joint_force = space_.read(joint_force_), &tip_force = space_.read(tip_force_);
        return use(BeadSolution{group_, force.view(), acceleration.view(), direction.view(),
                                tip_direction.view(), joint_force.view(), tip_force.view()});
    }

    ChainGroup const& group_;
    Space space_;
    Communicator const& communicator_;
    std::unique_ptr<ChainSolver> solver_;
    BodyLoads given_;
    std::vector<std::uint8_t> links_;
    Field<1> halves_;
    std::vector<LocalPiece> piece_;
    std::vector<HeldTip> tip_;
    /// Lists of BeadPlaces and BranchedPlaces.
    struct Lists {
        List<std::uint8_t> is_first, has_link;
        List<std::int64_t> inboard;
    } lists_;
    typename Space::template List<LocalPiece> pieces_;
    typename Space::template List<HeldTip> tips_;
    typename Space::template Fixed<1> mass_, inverse_mass_, length_, half_over_length_;
    /// Arrays over beads; BeadChainsIn documents them.
    Field3 position_, velocity_, observed_, force_, momentum_, change_, direction_, tip_direction_;
    typename Space::Directions bias_, joint_force_, tip_bias_, tip_force_;
    RingEnds<Space> ring_ends_;
    typename Space::template Mirror<3> position_mirror_, force_mirror_, observed_position_mirror_,
        observed_mirror_;
    /// Forces that are not yet in force_, if forces_are_ahead_.
    BeadForces forces_;
    DeferredError trouble_;
    /// forces_are_out_: the host has a copy of the forces that it may have changed.
    bool forces_are_ahead_ = false, forces_are_out_ = false;
    /// DeviceParticles::order of the OpenMM particles to which the last step already wrote the
    /// positions.
    std::int64_t put_at_step_ = never;
    std::vector<std::unique_ptr<BeadTerm>> terms_;
};

}  // namespace catena
