// Dynamics of chains of point beads on links in absolute coordinates, in any Space, which holds the
// state. Ground axes (W); nm, ps, amu, kJ/mol, unless the scene has `units: si`.
#pragma once

#include <utility>

#include "dca/solvers/tree_solver.hpp"
#include "dynamics/absolute_dynamics.hpp"
#include "dynamics/bead_force_array.hpp"
#include "dynamics/beads_in.hpp"
#include "dynamics/closing.hpp"

namespace catena {

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

/// Dynamics of bead chains; DeviceBeads serves OpenMM on the same GPU, ClosingDrifts the closing of
/// links.
/// `Fields` is BranchedFields for branched and cross-linked chains.
template <class Space, class Fields = BeadFields>
class BeadDynamics final : public AbsoluteDynamics, public DeviceBeads, public ClosingDrifts {
    using Beads = BeadsIn<Space, Fields>;
    using Chains = typename Beads::Chains;

  public:
    /// `solver` must read and write views of the same Space.
    BeadDynamics(ChainGroup const& group, Scene const& scene, Space const& space,
                 Communicator const& communicator, std::unique_ptr<ChainSolver> solver)
        : beads_(group, scene, space, communicator, std::move(solver)), forces_(beads_, scene) {}

    void update_configuration() override { parts().update_configuration(); }
    void assemble_matrices() override { beads_.assemble(); }
    void set_simple_forces() override { forces_.set_simple(); }
    /// Adds a term to the forces. Host only.
    void use(std::unique_ptr<BeadTerm> term) { forces_.terms.push_back(std::move(term)); }
    View<3> bead_forces() override { return forces_.show(); }
    ConstView<3> bead_positions() override {
        return beads_.space.pull(beads_.store.position, position_mirror_);
    }
    void take_bead_forces() override { forces_.take_back(); }

    // DeviceBeads: data exchange with OpenMM on the same GPU. On the host on_device() is null.
    DeviceBeads* on_device() override { return stream() ? this : nullptr; }
    std::int64_t count() const override { return beads_.group.size; }
    void* stream() const override {
        if constexpr (requires { beads_.space.stream(); }) return beads_.space.stream();
        return nullptr;
    }
    void put_positions(DeviceParticles const& particles) override {
        if (put_at_step_ == particles.order) return;
        beads_.each_bead([particles, x = ConstView<3>(beads_.store.position.view())] CATENA_LAMBDA(
                             std::int64_t k) { particles.put(k, x.load(k)); });
    }
    void show(ShownBeads const& shown) override {
        beads_.each_bead([shown, x = ConstView<3>(beads_.store.position.view())] CATENA_LAMBDA(
                             std::int64_t k) { shown.show(k, x.load(k)); });
    }
    void add_forces(DeviceParticles const& particles) override {
        if (forces_.pending) forces_.pending->particles = particles;
    }
    ConstView<3> host_positions() override { return bead_positions(); }

    void kick(double h) override {
        settle_forces();
        parts().kick(h);
    }
    void observe(double h) override {
        settle_forces();
        parts().project(h, beads_.store.observed.view());
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
        beads_.draw_velocities(kt, seed, of_chain);
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
        beads_.from_inboard();
        return beads_.communicator.max(own_error());
    }
    std::string trouble() override {
        DeferredError found;
        found.hold([&] { check(); });
        return found.text();
    }
    /// Precondition: update_configuration() has brought the neighbours' positions.
    double own_error() override { return beads_.largest_error(); }
    double own_error_beyond(double tolerance) override {
        if constexpr (Space::answers_at_once)
            if (beads_.closed_within(tolerance)) return 0;
        return own_error();
    }

    std::vector<StateArray> state() const override {
        check();
        return {to_array<3>("position", beads_.space.read(beads_.store.position).view(),
                            beads_.space.on_host()),
                to_array<3>("velocity", beads_.space.read(beads_.store.velocity).view(),
                            beads_.space.on_host())};
    }
    void set_state(std::vector<StateArray> const& arrays) override {
        put_at_step_ = never;
        beads_.trouble.forget();
        beads_.space.edit(beads_.store.position, [&](View<3> view) {
            from_array<3>(array_named(arrays, "position"), view, beads_.space.on_host());
        });
        beads_.space.edit(beads_.store.velocity, [&](View<3> view) {
            from_array<3>(array_named(arrays, "velocity"), view, beads_.space.on_host());
        });
    }
    ObservedMotion observed() override {
        check();
        return {.position = beads_.space.pull(beads_.store.position, observed_position_mirror_),
                .velocity = beads_.space.pull(beads_.store.observed, observed_mirror_)};
    }

    void evaluate() override {
        beads_.trouble.check();
        settle_forces();
        beads_.from_inboard(beads_.store.observed.view());
        Chains const c = beads_.chains();
        beads_.each_bead([c] CATENA_LAMBDA(std::int64_t k) { c.set_swing(k); });
        beads_.each_tip([c] CATENA_LAMBDA(std::int64_t i) { c.set_tip_swing(i); });
        beads_.each_crosslink([c] CATENA_LAMBDA(std::int64_t k) { c.set_swing(k); });
        BeadStore<Space>& now = beads_.store;
        beads_.solver->solve(
            {{}, now.force.view(), {}, now.bias.view(), of_tips(group(), now.tip_bias)},
            {{}, now.change.view(), now.joint_force.view(), of_tips(group(), now.tip_force)});
    }
    void evaluate_at_once() override {
        if (beads_.group.ends.has_tips() || !beads_.solver->at_once())
            return AbsoluteDynamics::evaluate_at_once();
        settle_forces();
        BeadStore<Space>& now = beads_.store;
        exchange_from_inboard(beads_.communicator, group(), now.observed.view(), beads_.space);
        exchange_from_outboard(beads_.communicator, group(), now.observed.view(), beads_.space);
        beads_.solver->assemble_and_solve(where(), what(),
                                          {{}, now.change.view(), now.joint_force.view(), {}});
    }
    std::vector<double> time_at_once(int chained, int repeat) override {
        settle_forces();
        return beads_.solver->time_evaluations(
            where(), what(), {{}, beads_.store.change.view(), {}, {}}, chained, repeat);
    }
    BodyResults results() const override {
        check();
        return with_solution([](BeadSolution const& s) { return s.results(); });
    }
    double residual() override {
        check();
        exchange_from_inboard(beads_.communicator, beads_.group, beads_.store.observed.view(),
                              beads_.space);
        auto const& observed = beads_.space.read(beads_.store.observed);
        return with_solution([&](BeadSolution const& s) {
            return s.residual(beads_.communicator, observed.view(), beads_.constants.tips());
        });
    }
    PotentialEnergy potential() override { return forces_.potential(); }
    ChainGroup const& group() const override { return beads_.group; }
    ChainSolver& solver() const override { return *beads_.solver; }

    void settle_forces() override { forces_.settle(); }

  private:
    static constexpr std::int64_t never = -1;
    void check() const { beads_.check(); }
    /// The parts of a step, executed loop by loop.
    BeadStep<Beads&, Fields> parts() { return {beads_.chains(), beads_}; }
    /// Takes a step in one launch if the solver is a TreeSolver with this leaf that supports it.
    /// Returns true if it did.
    template <class Leaf>
    bool carry(ConstrainedStep const& step) {
        if constexpr (Space::template has_blocks<Leaf::K> && !Fields::has_crosslinks) {
            auto* const solver = dynamic_cast<dca::TreeSolver<Leaf, Space>*>(beads_.solver.get());
            if (solver == nullptr || !solver->carries()) return false;
            beads_.held([&] {
                solver->carry(beads_.store.directions(), step.matrix_sweeps(), step.bias_sweeps(),
                              [&](dca::TreeSweeps<Leaf> const& sweeps) {
                                  return StepOfChains<Leaf>{sweeps, beads_.chains(), step,
                                                            forces_.pending.has_value(),
                                                            forces_.pending.value_or(BeadForces{})};
                              });
            });
            put_at_step_ = forces_.pending && forces_.pending->particles.bead
                               ? forces_.pending->particles.order
                               : never;
            return true;
        }
        return false;
    }
    /// Configuration for assemble_and_solve() by positions; the solver computes the directions.
    ConfigurationView where() const {
        ConfigurationView at;
        at.direction = beads_.store.direction.view();
        at.position = beads_.store.position.view();
        beads_.constants.show(at);
        return at;
    }
    /// Loads for assemble_and_solve() with velocities; the solver computes the biases.
    LoadsView what() const {
        LoadsView loads;
        loads.force = beads_.store.force.view();
        loads.velocity = beads_.store.observed.view();
        return loads;
    }
    /// Calls use() with the results of the last evaluation, copied to the host.
    template <class Use>
    auto with_solution(Use const& use) const {
        auto const &force = beads_.space.read(beads_.store.force),
                   &acceleration = beads_.space.read(beads_.store.change),
                   &direction = beads_.space.read(beads_.store.direction),
                   &tip_direction = beads_.space.read(beads_.store.tip_direction);
        auto const &joint_force = beads_.space.read(beads_.store.joint_force),
                   &tip_force = beads_.space.read(beads_.store.tip_force);
        return use(BeadSolution{beads_.group, force.view(), acceleration.view(), direction.view(),
                                tip_direction.view(), joint_force.view(), tip_force.view()});
    }

    Beads beads_;
    BeadForceArray<Space, Fields> forces_;
    typename Space::template Mirror<3> position_mirror_, observed_position_mirror_,
        observed_mirror_;
    /// DeviceParticles::order of the OpenMM particles to which the last step already wrote the
    /// positions.
    std::int64_t put_at_step_ = never;
};

}  // namespace catena
