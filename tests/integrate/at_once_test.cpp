// Matrices and biases in one sweep: as good a solution as by one sweep after the other, and the same one.
#include <gtest/gtest.h>

#include "integrate/chain_system.hpp"
#include "tests/mpi/world.hpp"
#include "tests/support/same_bits.hpp"

namespace catena::test {
namespace {

struct Case {
    char const* name;
    char const* chains;
};
Case const cases[] = {
    {"free_beads", "{velocities: thermal, generator: {freely_jointed: {beads: 333, length: 0.38}}}"},
    {"short_runs", "{velocities: thermal, generator: {freely_jointed: {beads: 17, length: 0.38}}}"},
    {"one_bead", "{velocities: thermal, generator: {freely_jointed: {beads: 1, length: 0.38}}}"},
    {"hanging_beads", "{base: fixed, velocities: thermal, generator: {random: {bodies: 200, joint: link, seed: 2}}}"},
    {"held_beads",
     "{base: fixed, velocities: thermal, tip: {joint: {type: link, anchor: [2, 3, 1]}}, generator: {freely_jointed: {beads: 70, length: "
     "0.38}}}"},
    {"many_beads",
     "{count: 5, velocities: thermal, generator: {freely_jointed: {beads: 23, length: 0.38}}}, {velocities: thermal, generator: "
     "{freely_jointed: {beads: 129, length: 0.38}}}"},
    {"free_bodies", "{base: free, velocities: thermal, generator: {random: {bodies: 301, joint: spherical, seed: 1}}}"},
    {"hanging_bodies", "{base: fixed, velocities: thermal, generator: {random: {bodies: 50, joint: spherical, seed: 4}}}"},
    {"held_bodies",
     "{base: free, velocities: thermal, tip: {joint: {type: spherical}}, generator: {random: {bodies: 40, joint: spherical, seed: 3}}}"},
    {"bodies_on_links", "{velocities: thermal, generator: {random: {bodies: 60, joint: link, rigid: 0.5, seed: 8}}}"},
};

class AtOnce : public ::testing::TestWithParam<Case> {
  protected:
    static Scene scene(Backend backend) {
        Scene s =
            parse_scene(std::string("chains: [") + GetParam().chains +
                            "]\nforces: {gravity: [1, 2, -9.81]}\ndynamics: {integrator: rattle, step: 0.002, temperature: 300, seed: 5}",
                        "scene.yaml");
        s.solver.backend = backend;
        return s;
    }
};

void move(ChainSystem& system) {
    system.evaluate();
    for (AbsoluteDynamics* const group : system.absolute())
        group->draw_velocities(2.5, 7, std::vector<bool>(system.scene().chains.size(), true));
}

double largest(std::vector<Vec3> const& a) {
    double most = 0;
    for (Vec3 const& v : a) most = std::max(most, norm(v));
    return most;
}

/// Ranks may not matter to a bit; how the sweeps are put together matters in the last ones, which a chain of n bodies lets grow like n.
TEST_P(AtOnce, IsTheSolution) {
    for (Backend const backend : {Backend::serial, Backend::segments}) {
        Scene const s = scene(backend);
        ChainSystem system(s, Axes::world, testing::world());
        move(system);
        system.evaluate();
        ChainSystem::Accelerations const apart = system.accelerations();
        system.evaluate(false);
        EXPECT_LE(system.residual(), system.residual_bound());
        ChainSystem::Accelerations const at_once = system.accelerations();
        double const tolerance = 64 * static_cast<double>(s.bodies()) * 0x1p-53;
        ASSERT_EQ(apart.acceleration.size(), at_once.acceleration.size());
        for (std::size_t k = 0; k < apart.acceleration.size(); ++k)
            EXPECT_LE(norm(apart.acceleration[k] - at_once.acceleration[k]), tolerance * largest(apart.acceleration)) << "body " << k;
        if (testing::world().rank() > 0) continue;
        auto const one_rank = serial_communicator();
        ChainSystem alone(s, Axes::world, *one_rank);
        move(alone);
        alone.evaluate();
        alone.evaluate(false);
        EXPECT_TRUE(same_bits(alone.accelerations().acceleration, at_once.acceleration));
        EXPECT_TRUE(same_bits(alone.accelerations().joint_force, at_once.joint_force));
    }
}

/// In joint coordinates: by the residual, and the same on one rank and on all.
TEST(AtOnceInJoints, IsASolution) {
    for (char const* const joint : {"planar", "spherical", "universal", "revolute", "helical", "mixed", "weld"})
        for (int const bodies : {1, 5, 16, 70, 333})
            for (char const* const tip : {"", ", tip: {joint: {type: spherical}}"}) {
                if (*tip && (bodies < 5 || joint == std::string("planar") || joint == std::string("weld"))) continue;
                SCOPED_TRACE(std::string(joint) + " " + std::to_string(bodies) + tip);
                Scene s = parse_scene(std::string("chains: [{base: fixed, generator: {random: {seed: 3, joint: ") + joint +
                                          ", bodies: " + std::to_string(bodies) + "}}" + tip + "}]\nforces: {gravity: [1, 2, -9.81]}",
                                      "scene.yaml");
                s.solver.backend = Backend::segments;
                ChainSystem system(s, Axes::joint, testing::world());
                system.evaluate(false);
                EXPECT_LE(system.residual(), system.residual_bound());
                ChainSystem::Accelerations const at_once = system.accelerations();
                if (testing::world().rank() > 0) continue;
                auto const one_rank = serial_communicator();
                ChainSystem alone(s, Axes::joint, *one_rank);
                alone.evaluate(false);
                EXPECT_TRUE(same_bits(alone.accelerations().joint_acceleration, at_once.joint_acceleration));
                EXPECT_TRUE(same_bits(alone.accelerations().joint_force, at_once.joint_force));
            }
}

/// A drift that goes on by single sweeps is the drift with as many of them.
TEST_P(AtOnce, DriftsGoOnByASweep) {
    constexpr double h = 0.002;
    for (Backend const backend : {Backend::serial, Backend::segments}) {
        Scene const s = scene(backend);
        ChainSystem system(s, Axes::world, catena::testing::world());
        move(system);
        for (AbsoluteDynamics* const group : system.absolute()) group->update_configuration();
        system.forces_and_matrices(nullptr);
        for (AbsoluteDynamics* const group : system.absolute()) {
            auto const begin = [&](int sweeps) {
                group->kick(h);
                group->drift(h, sweeps);
            };
            auto const start = group->state();
            begin(3);
            double const error = group->constraint_error();
            auto const expected = group->state();
            group->set_state(start);
            group->update_configuration();
            begin(1);
            for (int further = 0; further < 2; ++further) {
                group->constraint_error();
                if (!group->close_further(h)) {
                    EXPECT_FALSE(group->group().beads);
                    break;
                }
            }
            if (!group->group().beads) continue;
            EXPECT_EQ(group->constraint_error(), error);
            auto const found = group->state();
            ASSERT_EQ(found.size(), expected.size());
            for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].values, expected[i].values) << found[i].name;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Chains, AtOnce, ::testing::ValuesIn(cases), [](auto const& each) { return each.param.name; });

}  // namespace
}  // namespace catena::test
