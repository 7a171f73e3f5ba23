// Constant forces on beads and bodies: against the oracles, motion, energy and refusals.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "error.hpp"
#include "measure/integration.hpp"
#include "measure/oracle_accelerations.hpp"
#include "measure/solution.hpp"
#include "mpi/communicator.hpp"
#include "observe/verdict.hpp"
#include "reader/load_scene.hpp"
#include "terms/force_terms.hpp"

namespace catena::test {
namespace {

std::string const beads =
    "chains: [{name: a, bodies: [{mass: 2, position: [0, 0, 0], force: [1, -2, 0.5]}, {mass: 1, "
    "position: [1, 0.2, 0], joint: {type: link}}, {mass: 3, position: [1.5, 1, 0.3], joint: {type: "
    "link}, force: [0, 4, -1]}]}]\n";
std::string const branched =
    "chains: [{name: a, bodies: [{mass: 2, position: [0, 0, 0]}, {mass: 1, position: [1, 0.2, 0], "
    "joint: {type: link}, force: [3, 0, 1]}, {mass: 3, position: [1.5, 1, 0.3], joint: {type: "
    "link}}, {mass: 1, position: [1.5, -1, 0.1], joint: {type: link}, parent: 2, force: [0, 4, "
    "-1]}]}]\n";
std::string const linked =
    "chains: [{name: a, bodies: [{mass: 2, inertia: [1, 2, 2.5], com: [0.1, 0, 0.2], position: [0, "
    "0, 0], force: [1, -2, 0.5]}, {mass: 1, position: [1, 0.2, 0], joint: {type: link}, force: [0, "
    "1, 1]}]}]\n";

std::string bodies(std::string const& second) {
    return "chains: [{name: a, base: fixed, bodies: [{mass: 2, inertia: [1, 2, 2.5], com: [0.1, 0, "
           "-0.5], joint: {type: spherical, qd: [0.3, 0.1, -0.2]}, force: [1, -2, 0.5]}, {mass: "
           "1.5, inertia: [1, 1, 1], com: [0, 0.2, -0.4], joint: {type: " +
           second + ", translation: [0, 0, -1]}, force: [0, 4, -1]}]}]\n";
}

Solution solve(Scene const& scene, Communicator const& communicator) {
    ChainSystem system(scene, Axes::joint, communicator);
    system.evaluate();
    return solution_of(system);
}

/// Largest difference from the oracle relative to the largest acceleration.
double error(std::string const& text) {
    auto const communicator = serial_communicator();
    Scene const scene = parse_scene(text, "s.yaml");
    std::vector<double> const found = solve(scene, *communicator).acceleration,
                              exact = oracle_accelerations<double>(scene, {});
    double worst = found.size() == exact.size() ? 0 : HUGE_VAL, largest = 0;
    for (std::size_t i = 0; i < exact.size() && i < found.size(); ++i) {
        worst = std::max(worst, std::abs(found[i] - exact[i]));
        largest = std::max(largest, std::abs(exact[i]));
    }
    return worst / largest;
}

TEST(ConstantForce, AccelerationsAreTheOracles) {
    for (std::string const& text : {beads, branched, linked, bodies("revolute, axis: [0, 1, 0]"),
                                    bodies("spherical"), bodies("prismatic, axis: [1, 0, 0]")})
        EXPECT_LE(error(text), 1e-13) << text;
}

/// Both are one load to the dynamics, so that no bit differs.
TEST(ConstantForce, ActsAsAWrenchWithoutTorqueDoes) {
    auto const communicator = serial_communicator();
    std::string text = bodies("revolute, axis: [0, 1, 0]"), other = text;
    for (std::string const key : {"force: [1, -2, 0.5]", "force: [0, 4, -1]"}) {
        other.replace(other.find(key), key.size(), "wrench: {" + key + "}");
    }
    Solution const a = solve(parse_scene(text, "s.yaml"), *communicator),
                   b = solve(parse_scene(other, "s.yaml"), *communicator);
    EXPECT_EQ(a.acceleration, b.acceleration);
}

/// A free bead falls along the force: x = F t^2 / 2 m, and its energy becomes kinetic.
TEST(ConstantForce, PullsAFreeBead) {
    auto const communicator = serial_communicator();
    Scene const scene = parse_scene(
        "chains: [{name: a, bodies: [{mass: 2, position: [1, 0, 0], force: [3, 0, -1]}]}]\n",
        "s.yaml");
    Trajectory run(scene, *communicator, {Integrator::rattle, 0.01, 0});
    double const before = run.energy().total;
    EXPECT_DOUBLE_EQ(before, -3);
    run.run(100);
    Vec3 const x = run.snapshot().position[0];
    EXPECT_NEAR(x[0], 1 + 0.75, 1e-12);
    EXPECT_NEAR(x[2], -0.25, 1e-12);
    EXPECT_NEAR(run.energy().total, before, 1e-12);
    EXPECT_NEAR(run.energy().kinetic, 0.5 * 2 * (1.5 * 1.5 + 0.5 * 0.5), 1e-12);
}

/// In every kind of dynamics, energy with that of the forces is kept, and it is not without.
TEST(ConstantForce, KeepsItsEnergyInAColumn) {
    auto const communicator = serial_communicator();
    for (auto const& [text, integrator] :
         {std::pair{beads, Integrator::rattle}, std::pair{branched, Integrator::rattle},
          std::pair{linked, Integrator::rattle}, std::pair{bodies("spherical"), Integrator::rattle},
          std::pair{bodies("revolute, axis: [0, 1, 0]"), Integrator::rk4}}) {
        Scene scene = parse_scene(text, "s.yaml");
        Trajectory run(scene, *communicator, {integrator, 1e-4, 0});
        Trajectory::Energy const before = run.energy();
        run.run(1000);
        Trajectory::Energy const after = run.energy();
        EXPECT_NEAR(after.total, before.total, 1e-5) << text;
        EXPECT_GT(std::abs(after.kinetic - before.kinetic), 1e-3) << text;
        scene.dynamics.integrator = integrator;
        EXPECT_TRUE(EnergyWatch::conserves_energy(scene));
        ASSERT_EQ(terms::energy_columns(scene).size(), 3u);
        EXPECT_STREQ(terms::energy_columns(scene)[2].name, "constant_force");
    }
}

/// tests/cuda compares the bits.
TEST(ConstantForce, RunsOnGpus) {
    for (std::string const& text : {beads, branched, linked, bodies("spherical")})
        EXPECT_EQ(terms::why_host_alone(parse_scene(text, "s.yaml")), "") << text;
}

/// The forces of a bead that is not pulled, and of a scene without pulls, are as without the term.
TEST(ConstantForce, LeavesOtherBeadsAlone) {
    auto const communicator = serial_communicator();
    std::string const pull = ", force: [1, -2, 0.5]";
    std::string zero = beads, gravity = "forces: {gravity: [0.3, -1, 0.1]}\n";
    zero.replace(zero.find(pull), pull.size(), ", force: [0, 0, 0]");
    auto const forces = [&](std::string const& text) {
        Scene const scene = parse_scene(text, "s.yaml");
        ChainSystem system(scene, Axes::world, *communicator);
        system.evaluate();
        View<3> const force = system.absolute().at(0)->bead_forces();
        std::vector<Vec3> all;
        for (std::int64_t k = 0; k < force.size; ++k) all.push_back(force.load(k));
        return all;
    };
    std::vector<Vec3> const all = forces(beads + gravity), one = forces(zero + gravity);
    ASSERT_EQ(all.size(), 3u);
    Vec3 const g{{0.3, -1, 0.1}};
    EXPECT_EQ(norm(all[0] - (2.0 * g + (Vec3{{1, -2, 0.5}}))), 0);
    EXPECT_EQ(norm(all[1] - g), 0);
    EXPECT_EQ(norm(all[2] - (3.0 * g + (Vec3{{0, 4, -1}}))), 0);
    EXPECT_EQ(norm(one[0] - 2.0 * g), 0);
    EXPECT_EQ(norm(one[2] - all[2]), 0);
}

TEST(ConstantForce, WantsThreeNumbers) {
    for (char const* const bad : {"5", "[1, 2]", "{x: 1}", "[1, 2, .inf]"}) {
        std::string text = beads;
        std::string const key = "force: [1, -2, 0.5]";
        text.replace(text.find(key), key.size(), std::string("force: ") + bad);
        try {
            parse_scene(text, "s.yaml");
            FAIL() << bad;
        } catch (InputError const& refused) {
            EXPECT_NE(std::string(refused.what()).find("chains[0].bodies[0].force"),
                      std::string::npos)
                << refused.what();
        }
    }
}

}  // namespace
}  // namespace catena::test
