// What `solve` and `report` take for a thermal start is what `run` draws: the same velocities,
// though in other coordinates.
#include "start/start_velocities.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "integrate/chain_system.hpp"
#include "integrate/stepper.hpp"
#include "observe/observables.hpp"
#include "oracle/oracle.hpp"
#include "reader/load_scene.hpp"
#include "tests/mpi/world.hpp"

namespace catena::test {
namespace {

Scene scene_of(std::string const& joint, std::string const& base) {
    return parse_scene(
        "chains: [{name: a, base: " + base +
            ", velocities: thermal, generator: {random: {bodies: 200, joint: " + joint +
            ", loads: false}}}]\n" +
            "dynamics: {integrator: rattle, step: 0.001, temperature: 300, seed: 4}\n",
        "test");
}

/// Velocities of beads and centres of mass, W, as a run starts with them; on rank 0.
std::vector<double> of_a_run(Scene const& scene) {
    ChainSystem system(scene, Axes::world, testing::world());
    make_stepper(system, scene.dynamics);
    return system.state()["velocity"];
}

void expect_the_runs_velocities(std::string const& joint, std::string const& base) {
    Scene const thermal = scene_of(joint, base);
    Scene const drawn = with_start_velocities(thermal, testing::world());
    EXPECT_EQ(drawn.chains[0].velocities, StartVelocities::given);
    EXPECT_EQ(drawn.hash, thermal.hash);
    std::vector<double> const expected = of_a_run(thermal);
    auto const motion = oracle::kinematics<double>(drawn.chains[0], {});
    double const temperature =
        2 * motion.kinetic_energy /
        (thermal.boltzmann() * static_cast<double>(degrees_of_freedom(thermal)));
    EXPECT_NEAR(temperature / 300, 1,
                4 * std::sqrt(2.0 / static_cast<double>(degrees_of_freedom(
                                        thermal))));  // 4 standard errors of chi^2 / dof
    if (testing::world().rank() != 0) return;
    double largest = 0, difference = 0;
    for (std::size_t k = 0; k < 200; ++k)
        for (int i = 0; i < 3; ++i) {
            double const found =
                joint == "link" ? drawn.chains[0].beads.velocity[k][i] : motion.com_velocity[k][i];
            largest = std::max(largest, std::abs(expected[3 * k + static_cast<std::size_t>(i)]));
            difference = std::max(difference,
                                  std::abs(found - expected[3 * k + static_cast<std::size_t>(i)]));
        }
    EXPECT_LE(difference, 1e-12 * largest)
        << joint << ' ' << base;  // 200 bodies' relative velocities summed up
}

TEST(StartVelocities, AreThoseOfARun) {
    for (std::string const base : {"free", "fixed"})
        for (std::string const joint : {"link", "spherical"})
            expect_the_runs_velocities(joint, base);
}

TEST(StartVelocities, GivenOnesStay) {
    Scene const scene = parse_scene(
        "units: si\nchains: [{base: fixed, generator: {random: {bodies: 5, joint: revolute}}}]",
        "test");
    Scene const same = with_start_velocities(scene, testing::world());
    for (std::size_t k = 0; k < 5; ++k)
        EXPECT_EQ(same.chains[0].bodies.qd[k][0], scene.chains[0].bodies.qd[k][0]);
}

}  // namespace
}  // namespace catena::test
