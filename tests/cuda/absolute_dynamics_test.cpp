// Chains in absolute coordinates whose state stays on the GPU: each operation of a step, and whole
// runs, leave the bits of the host's.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cuda/dynamics.hpp"
#include "integrate/stepper.hpp"
#include "reader/load_scene.hpp"
#include "tests/support/gpu.hpp"
#include "tests/support/pulled.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/same_bits.hpp"

namespace catena::test {
namespace {

struct AbsoluteScene {
    char const* name;
    Scene (*make)();
    Handles handles = Handles::projected;
};
auto const name_of_scene = [](auto const& scene) { return scene.param.name; };

/// Chains of 1, 17 and 300 bodies.
std::string sizes_of(std::string const& generator, char const* base) {
    std::string chains;
    for (int const bodies : {1, 17, 300})
        chains += (chains.empty() ? "" : ", ") + ("{name: a" + std::to_string(bodies)) +
                  ", base: " + base + ", generator: {random: {bodies: " + std::to_string(bodies) +
                  ", seed: 1, " + generator + "}}}";
    return "chains: [" + chains + "]\nforces: {gravity: [1, 2, -9.81]}";
}
Scene scene_from(std::string const& yaml) { return parse_scene(yaml, "scene.yaml"); }
Scene scene_of(std::vector<ChainSpec> const& chains) {
    Scene scene;
    scene.chains = chains;
    for (std::size_t i = 0; i < chains.size(); ++i)
        scene.chains[i].name = std::string(1, static_cast<char>('a' + i));
    scene.forces.gravity = {{1, 2, -9.81}};
    return scene;
}
/// Bodies on spherical joints with springs, torques and wrenches; every third one carries nothing,
/// the others one or two beads.
Scene carrying_bodies() {
    Random random(11);
    ChainSpec chain = random_chain(
        5, {.bodies = 60, .joints = RandomJoints::spherical, .base = Base::free, .springs = true});
    chain.bodies.damping.clear();
    chain.bodies.carried.offset = {0};
    for (std::size_t k = 0; k < chain.size(); ++k) {
        for (std::size_t i = 0; i < k % 3; ++i) {
            chain.bodies.carried.position.push_back(random.vector(0.3));
            chain.bodies.carried.mass.push_back(1);
            chain.bodies.carried.residue.emplace_back("UNK");
        }
        chain.bodies.carried.offset.push_back(
            static_cast<std::int64_t>(chain.bodies.carried.size()));
    }
    return scene_of({chain});
}
Scene free_beads() {
    return scene_from(
        "chains: [{name: a, count: 3, base: free, velocities: thermal, generator: {freely_jointed: "
        "{beads: 100, length: 0.38}}}]\n"
        "dynamics: {integrator: rattle, step: 0.001, temperature: 300}");
}
Scene ring_of_beads() { return scene_of({closed(random_bead_chain(3, 150, Base::free))}); }
Scene ring_of_domains() { return scene_of({closed(random_linked_chain(4, 60, Base::free))}); }
Scene ring_of_bodies() {
    return scene_of({random_chain(5, {.bodies = 50,
                                      .joints = RandomJoints::spherical,
                                      .base = Base::free,
                                      .tip = JointType::spherical,
                                      .ring = true})});
}
/// More chains than a GPU has multiprocessors, several in a block of threads, with parts of every
/// length.
Scene many_beads() {
    std::string chains;
    for (int const beads : {1, 2, 16, 17, 33, 140})
        chains += (chains.empty() ? "" : ", ") +
                  ("{count: 400, base: free, generator: {freely_jointed: {length: 0.38, beads: " +
                   std::to_string(beads) + "}}}");
    return scene_from("chains: [" + chains + "]\nforces: {gravity: [1, 2, -9.81]}");
}
/// As long as one block takes, and one bead longer.
Scene beads_of_a_block(int beads) {
    return scene_from("chains: [{base: fixed, generator: {random: {joint: link, seed: 4, bodies: " +
                      std::to_string(beads) +
                      "}}}, {base: free, generator: {random: {joint: link, seed: 5, bodies: "
                      "50}}}]\nforces: {gravity: [1, 2, -9.81]}");
}
Scene longest_beads() { return beads_of_a_block(1024); }
Scene longer_beads() { return beads_of_a_block(1025); }
Scene held_beads() {
    return scene_from(
        "chains: [{name: a, base: fixed, tip: {joint: {type: link, anchor: [1, 2, 3]}}, generator: "
        "{random: {bodies: 60, joint: link, "
        "seed: "
        "4}}}]");
}
Scene branched_beads() {
    return scene_from(
        "chains: [{name: s, count: 3, generator: {star: {arms: 7, arm_length: 20, length: 0.4}}}, "
        "{name: d, base: fixed, generator: {dendrimer: {generations: 5, spacer: 2, length: 0.4}}}, "
        "{name: t, generator: {random_tree: {beads: 3000, seed: 3, length: 0.4}}}]\nforces: "
        "{gravity: [1, 2, -9.81]}");
}
Scene brush_of_beads() {
    return scene_from(
        "chains: [{name: b, generator: {brush: {backbone: 2000, side_length: 5, length: 0.4}}}]");
}
/// By teams, by blocks, over several blocks, on the ground, and on paths.
Scene pulled_beads() { return pulled(many_beads()); }
Scene pulled_longest() { return pulled(longest_beads()); }
Scene pulled_longer() { return pulled(longer_beads()); }
Scene pulled_branched() { return pulled(branched_beads()); }
Scene hanging_beads() { return scene_from(sizes_of("joint: link", "fixed")); }
Scene free_bodies() { return scene_from(sizes_of("joint: spherical", "free")); }
Scene hanging_bodies() { return scene_from(sizes_of("joint: spherical", "fixed")); }
Scene held_bodies() {
    return scene_of({random_chain(7, {.bodies = 40,
                                      .joints = RandomJoints::spherical,
                                      .base = Base::fixed,
                                      .tip = JointType::spherical}),
                     random_chain(8, {.bodies = 9,
                                      .joints = RandomJoints::spherical,
                                      .base = Base::free,
                                      .tip = JointType::spherical})});
}
/// Rigid domains, which carry beads, among point beads.
Scene free_domains() {
    return scene_of(
        {random_linked_chain(3, 70, Base::free), random_linked_chain(4, 33, Base::free)});
}
Scene hanging_domains() { return scene_from(sizes_of("joint: link, rigid: 0.4", "fixed")); }
Scene held_domains() {
    return scene_of({random_linked_chain(5, 40, Base::fixed, Tip::jointed),
                     random_linked_chain(6, 20, Base::free, Tip::jointed)});
}

class GpuAbsolute : public ::testing::TestWithParam<AbsoluteScene> {
  protected:
    void SetUp() override {
        need_gpu();
        if (IsSkipped() || HasFatalFailure()) return;
        ASSERT_EQ(cuda::choose_device(*communicator_), "");
        scene_ = GetParam().make();
        groups_ = make_groups(scene_, Axes::world, GetParam().handles, false, *communicator_);
        ASSERT_EQ(groups_.size(), 1);
        bool const beads = groups_[0]->beads;
        auto solver = make_tree_solver(*groups_[0], *executor_, *communicator_);
        host_ = beads ? make_bead_dynamics(*groups_[0], scene_, *executor_, *communicator_,
                                           std::move(solver))
                      : make_rigid_dynamics(*groups_[0], scene_, *executor_, *communicator_,
                                            std::move(solver));
        auto const make = groups_[0]->is_branched() ? cuda::make_branched_dynamics
                          : beads                   ? cuda::make_bead_dynamics
                                                    : cuda::make_rigid_dynamics;
        device_ = make(*groups_[0], scene_, *executor_, *communicator_);
    }
    std::vector<StateArray> observed(AbsoluteDynamics& dynamics) const {
        ObservedMotion const motion = dynamics.observed();
        std::vector<StateArray> arrays{to_array<3>("position", motion.position, *executor_),
                                       to_array<3>("velocity", motion.velocity, *executor_)};
        if (groups_[0]->beads) return arrays;
        arrays.push_back(to_array<4>("orientation", motion.orientation, *executor_));
        arrays.push_back(to_array<3>("omega", motion.omega, *executor_));
        return arrays;
    }
    template <class Operation>
    void both(char const* name, Operation const& operation) {
        operation(*host_);
        operation(*device_);
        for (auto const& [host, device] :
             {std::pair{host_->state(), device_->state()}, {observed(*host_), observed(*device_)}})
            for (std::size_t i = 0; i < host.size(); ++i) {
                EXPECT_TRUE(same_bits(host[i].values, device[i].values))
                    << name << ": " << host[i].name;
                for (double const v : host[i].values)
                    ASSERT_TRUE(std::isfinite(v)) << name << ": " << host[i].name;
            }
        EXPECT_EQ(host_->constraint_error(), device_->constraint_error()) << name;
    }
    std::unique_ptr<Communicator> communicator_ = serial_communicator();
    std::unique_ptr<Executor> executor_ = serial_executor();
    Scene scene_;
    std::vector<std::unique_ptr<ChainGroup>> groups_;
    std::unique_ptr<AbsoluteDynamics> host_, device_;
};

TEST_P(GpuAbsolute, EachOperationLeavesTheBitsOfTheHost) {
    both("start", [](AbsoluteDynamics&) {});
    for (std::uint64_t step = 0; step < 3; ++step) {
        both("configuration", [](AbsoluteDynamics& d) { d.update_configuration(); });
        both("matrices and forces", [](AbsoluteDynamics& d) {
            d.assemble_matrices();
            d.set_simple_forces();
        });
        if (step == 0)
            both("drawn velocities", [](AbsoluteDynamics& d) {
                d.draw_velocities(2.5, 7, std::vector<bool>(d.group().chains.size(), true));
            });
        both("forces from outside", [](AbsoluteDynamics& d) {
            ConstView<3> const position = d.bead_positions();
            View<3> const force = d.bead_forces();
            for (std::int64_t k = 0; k < force.size; ++k)
                force.store(k, plus_scaled(force.load(k), -0.5, position.load(k)));
            d.take_bead_forces();
        });
        both("kick", [](AbsoluteDynamics& d) { d.kick(0.0005); });
        both("thermostat", [&](AbsoluteDynamics& d) {
            d.thermalise(thermostat_of(0.9, 2.5, 3), step);
            d.kick(0.0);
        });
        both("observation", [](AbsoluteDynamics& d) { d.observe(0.0002); });
        both("drift", [](AbsoluteDynamics& d) { d.drift(0.001, 0); });
        both("drift and closing", [](AbsoluteDynamics& d) { d.drift(0.001, 1); });
        both("drift, closed", [](AbsoluteDynamics& d) { d.drift(0.001, 4); });
    }
    ConstrainedStep step;
    step.kick = step.drift = 0.001;
    step.sweeps = 4;
    step.thermostat = thermostat_of(0.9, 2.5, 3);
    for (; step.number < 4; ++step.number) {
        step.langevin = step.number % 2 == 0;
        both("matrices", [](AbsoluteDynamics& d) {
            d.update_configuration();
            d.assemble_matrices();
        });
        both("whole step", [&](AbsoluteDynamics& d) { d.step(step); });
    }
    both("evaluation", [](AbsoluteDynamics& d) { d.evaluate(); });
    EXPECT_EQ(host_->residual(), device_->residual());
    EXPECT_EQ(host_->potential(), device_->potential());
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, GpuAbsolute,
    ::testing::Values(
        AbsoluteScene{"hanging_beads", hanging_beads},
        AbsoluteScene{"hanging_beads_full", hanging_beads, Handles::full},
        AbsoluteScene{"free_beads", free_beads}, AbsoluteScene{"held_beads", held_beads},
        AbsoluteScene{"branched_beads", branched_beads},
        AbsoluteScene{"brush_of_beads", brush_of_beads}, AbsoluteScene{"many_beads", many_beads},
        AbsoluteScene{"longest_beads", longest_beads}, AbsoluteScene{"longer_beads", longer_beads},
        AbsoluteScene{"pulled_beads", pulled_beads},
        AbsoluteScene{"pulled_longest", pulled_longest},
        AbsoluteScene{"pulled_longest_full", pulled_longest, Handles::full},
        AbsoluteScene{"pulled_longer", pulled_longer},
        AbsoluteScene{"pulled_branched", pulled_branched},
        AbsoluteScene{"free_bodies", free_bodies},
        AbsoluteScene{"hanging_bodies_full", hanging_bodies, Handles::full},
        AbsoluteScene{"held_bodies", held_bodies},
        AbsoluteScene{"carrying_bodies", carrying_bodies},
        AbsoluteScene{"free_domains", free_domains},
        AbsoluteScene{"hanging_domains_full", hanging_domains, Handles::full},
        AbsoluteScene{"held_domains", held_domains}, AbsoluteScene{"ring_of_beads", ring_of_beads},
        AbsoluteScene{"ring_of_domains", ring_of_domains},
        AbsoluteScene{"ring_of_bodies_full", ring_of_bodies, Handles::full}),
    name_of_scene);

class GpuConstrained : public ::testing::TestWithParam<AbsoluteScene> {
  protected:
    void SetUp() override { need_gpu(); }
    /// State, what is observed, and joint forces after some steps.
    std::map<std::string, std::vector<double>> after_steps(Backend backend,
                                                           Integrator integrator) const {
        Scene scene = GetParam().make();
        scene.solver.backend = backend;
        scene.solver.handles = GetParam().handles;
        DynamicsSpec dynamics;
        dynamics.integrator = integrator;
        dynamics.step = 0.0005;
        dynamics.temperature = 300;
        dynamics.friction = integrator == Integrator::g_baoab ? 1 : 0;
        dynamics.seed = 5;
        ChainSystem system(scene, Axes::world, *communicator_);
        EXPECT_EQ(system.backend(), backend);
        auto const stepper = make_stepper(system, dynamics);
        int constexpr steps = 100;
        for (int i = 0; i < steps; ++i) {
            stepper->prepare(nullptr);
            stepper->step(i, nullptr);
        }
        stepper->prepare(nullptr);
        stepper->observe({.joint_forces = true});
        auto arrays = system.state();
        arrays["errors"] = {stepper->constraint_error(), system.residual()};
        EXPECT_LE(arrays["errors"][0], dynamics.constraint_tolerance);
        EXPECT_LE(arrays["errors"][1], system.residual_bound());
        arrays["sweeps"] = {stepper->describe()["sweeps_a_drift"].get<double>()};
        for (EnergyTerm const& term : system.potential_energy())
            arrays["energy"].push_back(term.value);
        ChainSystem::Accelerations const a = system.accelerations();
        auto const add = [&arrays](char const* name, auto const& values) {
            for (auto const& v : values)
                arrays[name].insert(arrays[name].end(), std::begin(v.data), std::end(v.data));
        };
        add("observed velocity", system.snapshot().velocity);
        add("acceleration", a.acceleration);
        add("alpha", a.alpha);
        add("joint force", a.joint_force);
        for (TipForce const& tip : a.tip_force) add("tip force", std::vector{tip.wrench});
        return arrays;
    }
    std::unique_ptr<Communicator> communicator_ = serial_communicator();
};

TEST_P(GpuConstrained, AHundredStepsLeaveTheBitsOfTheHost) {
    for (Integrator const integrator : {Integrator::rattle, Integrator::g_baoab}) {
        auto const host = after_steps(Backend::segments, integrator),
                   device = after_steps(Backend::cuda, integrator);
        ASSERT_EQ(device.size(), host.size());
        for (auto const& [name, values] : host) {
            EXPECT_TRUE(same_bits(device.at(name), values)) << name << ", " << name_of(integrator);
            for (double const v : values) ASSERT_TRUE(std::isfinite(v)) << name;
        }
        EXPECT_EQ(after_steps(Backend::cuda, integrator), device)
            << "a second time, " << name_of(integrator);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, GpuConstrained,
    ::testing::Values(
        AbsoluteScene{"free_beads", free_beads}, AbsoluteScene{"branched_beads", branched_beads},
        AbsoluteScene{"brush_of_beads", brush_of_beads}, AbsoluteScene{"many_beads", many_beads},
        AbsoluteScene{"longest_beads", longest_beads}, AbsoluteScene{"pulled_beads", pulled_beads},
        AbsoluteScene{"pulled_longest", pulled_longest},
        AbsoluteScene{"pulled_longer", pulled_longer},
        AbsoluteScene{"pulled_branched", pulled_branched},
        AbsoluteScene{"free_bodies", free_bodies}, AbsoluteScene{"hanging_bodies", hanging_bodies},
        AbsoluteScene{"hanging_bodies_full", hanging_bodies, Handles::full},
        AbsoluteScene{"held_bodies", held_bodies},
        AbsoluteScene{"carrying_bodies", carrying_bodies},
        AbsoluteScene{"free_domains", free_domains},
        AbsoluteScene{"hanging_domains", hanging_domains},
        AbsoluteScene{"held_domains", held_domains},
        AbsoluteScene{"held_domains_full", held_domains, Handles::full},
        AbsoluteScene{"ring_of_beads", ring_of_beads},
        AbsoluteScene{"ring_of_domains", ring_of_domains},
        AbsoluteScene{"ring_of_bodies", ring_of_bodies}),
    name_of_scene);

}  // namespace
}  // namespace catena::test
