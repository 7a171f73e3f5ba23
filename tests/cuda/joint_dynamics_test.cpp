// Chains of bodies in joint coordinates whose state stays on the GPU: whole steps leave the bits of
// the host's.
#include <gtest/gtest.h>

#include <string>

#include "cuda/dynamics.hpp"
#include "integrate/joint_program.hpp"
#include "reader/load_scene.hpp"
#include "tests/support/gpu.hpp"
#include "tests/support/random_chain.hpp"

namespace catena::test {
namespace {

class GpuJoints : public ::testing::Test {
  protected:
    void SetUp() override { need_gpu(); }
    /// State after some steps, and what carries to the next.
    std::map<std::string, std::vector<double>> after_steps(Scene scene, Backend backend,
                                                           Integrator integrator, int steps) const {
        scene.solver.backend = backend;
        ChainSystem system(scene, Axes::joint, *communicator_);
        EXPECT_EQ(system.backend(), backend);
        double constexpr h = 0.0005;
        DynamicsSpec const dynamics{
            .given = true, .integrator = integrator, .step = h, .tolerance = 1e-9};
        auto const stepper = make_joint_integrator(system, dynamics);
        system.close_tips();
        for (int i = 0; i < steps; ++i) {
            for (JointDynamics* const group : system.joint()) group->set_time(i * h);
            stepper->step(h);
            system.close_tips();
        }
        CheckpointParts const parts(system);
        OwnState own = parts.own_state();
        for (JointDynamics* const group : system.joint())
            parts.add_rates(group->group(), group->rates(RatesOf::saved), own);
        auto arrays = parts.gathered(own);
        for (JointDynamics* const group : system.joint())
            arrays["closure"].push_back(group->closure_error());
        system.evaluate();
        arrays["residual"] = {system.residual()};
        EXPECT_LE(arrays["residual"][0], system.residual_bound());
        for (EnergyTerm const& term : system.potential_energy())
            arrays["energy"].push_back(term.value);
        for (Vec3 const& x : system.snapshot().position)
            arrays["position"].insert(arrays["position"].end(), x.data, x.data + 3);
        return arrays;
    }
    void expect_same(Scene const& scene, int steps = 100) const {
        for (IntegratorTraits const& row : integrators) {
            if (!row.joint_coordinates || !row.on_gpu) continue;
            Integrator const integrator = row.kind;
            auto const device = after_steps(scene, Backend::cuda, integrator, steps),
                       host = after_steps(scene, Backend::segments, integrator, steps);
            for (auto const& [name, values] : host) {
                EXPECT_EQ(device.at(name), values) << name << ", " << name_of(integrator);
                for (double const v : values) ASSERT_TRUE(std::isfinite(v)) << name;
            }
        }
    }
    /// Wrenches, joint torques, springs, dampers, drag, prescribed motions, and every joint at the
    /// tip.
    void expect_same_with_loads_drives_and_tips(int steps) const {
        using enum JointType;
        std::optional<JointType> const tips[] = {std::nullopt, spherical,   revolute,
                                                 universal,    weld,        prismatic,
                                                 helical,      cylindrical, planar3};
        std::uint64_t seed = 100;
        for (RandomJoints const joints :
             {RandomJoints::spherical, RandomJoints::universal, RandomJoints::planar,
              RandomJoints::any, RandomJoints::all})
            for (std::optional<JointType> const tip : tips) {
                if (tip && joints == RandomJoints::planar)
                    continue;  // these hold a tip a second time
                SCOPED_TRACE("seed " + std::to_string(++seed));
                expect_same(scene_of({random_chain(seed, {.bodies = 40,
                                                          .joints = joints,
                                                          .base = Base::fixed,
                                                          .springs = true,
                                                          .drag = true,
                                                          .driven = 0.2,
                                                          .tip = tip})}),
                            steps);
                if (HasFailure()) return;
            }
    }
    static Scene scene_of(std::vector<ChainSpec> const& chains) {
        Scene scene;
        scene.chains = chains;
        scene.forces.gravity = {{1, 2, -9.81}};
        return scene;
    }
    std::unique_ptr<Communicator> communicator_ = serial_communicator();
};

TEST_F(GpuJoints, EveryJointAndBase) {
    for (char const* const joint : {"planar", "spherical", "universal", "revolute", "prismatic",
                                    "helical", "weld", "mixed", "cylindrical", "planar3"})
        for (char const* const base : {"free", "fixed"}) {
            std::string chains;
            for (int const bodies : {1, 17, 300})
                chains += (chains.empty() ? "" : ", ") + ("{name: a" + std::to_string(bodies)) +
                          ", base: " + base +
                          ", generator: {random: {bodies: " + std::to_string(bodies) +
                          ", joint: " + joint + ", seed: 1}}}";
            SCOPED_TRACE(chains);
            expect_same(parse_scene("chains: [" + chains + "]\nforces: {gravity: [1, 2, -9.81]}",
                                    "scene.yaml"));
            if (HasFailure()) return;
        }
}

TEST_F(GpuJoints, AVeryLongPendulum) {
    expect_same(
        parse_scene("units: si\nchains: [{name: p, base: fixed, generator: {pendulum: {links: "
                    "5000}}}]\nforces: {gravity: [0, 0, -9.81]}",
                    "scene.yaml"));
}

/// So many runs that a GPU finds what moves joint by joint while it goes along them.
TEST_F(GpuJoints, AVeryLongChainOnRevolutes) {
    expect_same(parse_scene("units: si\nchains: [{name: h, base: free, generator: {random: "
                            "{bodies: 300001, joint: revolute, seed: 2}}}]\n"
                            "forces: {gravity: [1, 2, -9.81]}",
                            "scene.yaml"),
                2);
}
/// What revolute joints and the ground's axes do along runs is the solver's to find, but where
/// solutions are refined.
TEST_F(GpuJoints, LoadsOnRevolutes) {
    for (int const refine : {0, 1})
        for (Base const base : {Base::fixed, Base::free}) {
            SCOPED_TRACE(std::string(base == Base::free ? "free" : "fixed") + ", refined " +
                         std::to_string(refine));
            std::vector<ChainSpec> chains;
            for (std::size_t const bodies : {300U, 34U, 18U, 3U}) {
                chains.push_back(random_chain(bodies, {.bodies = bodies,
                                                       .joints = RandomJoints::revolute,
                                                       .base = base,
                                                       .springs = true}));
                chains.back().name = std::to_string(bodies);
            }
            Scene scene = scene_of(chains);
            scene.solver.refine = refine;
            expect_same(scene, 10);
            if (HasFailure()) return;
        }
}
/// So many that four lanes go along each run, and that springs are read joint by joint.
TEST_F(GpuJoints, LoadsOnManyRevolutes) {
    expect_same(scene_of({random_chain(1, {.bodies = 40001,
                                           .joints = RandomJoints::revolute,
                                           .base = Base::free,
                                           .springs = true})}),
                2);
}
TEST_F(GpuJoints, LoadsDrivesAndTips) { expect_same_with_loads_drives_and_tips(100); }
/// For checkers, under which launches take long.
TEST_F(GpuJoints, LoadsDrivesAndTipsInARow) { expect_same_with_loads_drives_and_tips(2); }

/// Closed on themselves by every joint; planar ones are held more than once.
TEST_F(GpuJoints, Rings) {
    using enum JointType;
    std::uint64_t seed = 200;
    for (RandomJoints const joints : {RandomJoints::spherical, RandomJoints::universal,
                                      RandomJoints::planar, RandomJoints::any, RandomJoints::all})
        for (JointType const closing :
             {spherical, revolute, universal, weld, prismatic, helical, cylindrical, planar3}) {
            SCOPED_TRACE("seed " + std::to_string(++seed));
            expect_same(scene_of({random_chain(seed, {.bodies = 40,
                                                      .joints = joints,
                                                      .base = Base::free,
                                                      .springs = true,
                                                      .tip = closing,
                                                      .ring = true})}));
            if (HasFailure()) return;
        }
}

/// A plasmid's worth of rods, solved once.
TEST_F(GpuJoints, ALongRing) {
    Scene scene = parse_scene(
        "units: si\nchains: [{base: free, generator: {polygon: {bodies: 1e5, joint: spherical, "
        "spin: [1e-6, 2e-6, 1e-6]}}, tip: {ring: "
        "{type: "
        "spherical, translation: [1, 0, 0]}}}]\nforces: {gravity: [0, 0, -9.81]}",
        "scene.yaml");
    std::vector<Vec3> found[2];
    for (Backend const backend : {Backend::cuda, Backend::segments}) {
        scene.solver.backend = backend;
        ChainSystem system(scene, Axes::joint, *communicator_);
        system.close_tips();
        system.evaluate();
        EXPECT_LE(system.residual(), system.residual_bound());
        found[backend == Backend::cuda] = system.accelerations().acceleration;
    }
    for (std::size_t k = 0; k < found[0].size(); ++k)
        for (int i = 0; i < 3; ++i) ASSERT_EQ(found[0][k][i], found[1][k][i]) << k;
}

/// Forces on carried beads, as OpenMM's come, one evaluation after the other.
TEST_F(GpuJoints, CarriedBeads) {
    ASSERT_EQ(cuda::choose_device(*communicator_), "");
    Random random(11);
    ChainSpec chain =
        random_chain(5, {.bodies = 60, .joints = RandomJoints::mixed, .base = Base::free});
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
    Scene const scene = scene_of({chain});
    auto const groups = make_groups(scene, Axes::joint, Handles::projected, false, *communicator_);
    auto const executor = serial_executor();
    auto const host = make_joint_dynamics(*groups[0], scene, *executor, *communicator_,
                                          make_tree_solver(*groups[0], *executor, *communicator_));
    auto const device = cuda::make_joint_dynamics(*groups[0], scene, *executor, *communicator_);
    for (int step = 0; step < 10; ++step)
        for (int stage = 0; stage < 4; ++stage) {
            for (JointDynamics* const d : {host.get(), device.get()}) {
                d->update_configuration();
                View<3> const force = d->bead_forces();
                ConstView<3> const position = d->bead_positions();
                ASSERT_EQ(force.size, 60);
                for (std::int64_t k = 0; k < force.size; ++k)
                    force.store(k, plus_scaled(force.load(k), -0.5, position.load(k)));
                d->take_bead_forces();
                d->assemble_matrices();
                d->solve();
                d->apply(program_of(Integrator::rk4, false)
                             .step[static_cast<std::size_t>(2 * stage + 1)],
                         0.001);
            }
            JointState const a = host->state(), b = device->state();
            for (std::int64_t k = 0; k < groups[0]->size; ++k)
                for (int i = 0; i < 4; ++i)
                    ASSERT_EQ(a.q[k][i], b.q[k][i]) << step << " " << stage << " " << k;
        }
}

}  // namespace
}  // namespace catena::test
