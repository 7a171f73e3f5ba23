// OpenMM's forces on beads that bodies carry: mapped to wrenches as the oracle maps them, whatever
// the coordinates and the ranks.
#include <gtest/gtest.h>

#include <array>

#include "integrate/chain_system.hpp"
#include "oracle/oracle.hpp"
#include "tests/mpi/world.hpp"
#include "tests/support/random_chain.hpp"

namespace catena::test {
namespace {

char const* const residues[] = {"LYS", "GLU", "PHE", "SER"};

void name_residues(std::vector<std::string>& names) {
    for (std::size_t i = 0; i < names.size(); ++i) names[i] = residues[i % std::size(residues)];
}

/// Two or three beads on every other body.
CarriedBeads beads_on(std::size_t bodies, std::uint64_t seed) {
    Random random(seed);
    CarriedBeads carried;
    carried.offset = {0};
    for (std::size_t k = 0; k < bodies; ++k) {
        for (std::size_t i = 0; k % 2 == 0 && i < 2 + k % 3; ++i) {
            carried.position.push_back(random.vector(0.3));
            carried.mass.push_back(100);
            carried.residue.emplace_back("GLY");
        }
        carried.offset.push_back(static_cast<std::int64_t>(carried.size()));
    }
    name_residues(carried.residue);
    return carried;
}

/// Beads, bodies with beads, linked bodies with and without, a body without: side by side, near
/// enough to feel each other.
Scene mixed_scene() {
    Scene scene;
    scene.chains.push_back(random_bead_chain(1, 12, Base::free));
    scene.chains.push_back(random_chain(
        2, {.bodies = 9, .joints = RandomJoints::spherical, .base = Base::free, .loaded = false}));
    scene.chains.push_back(random_linked_chain(3, 14, Base::fixed));
    scene.chains.push_back(
        random_chain(4, {.bodies = 3, .joints = RandomJoints::spherical, .base = Base::fixed}));
    char const* const names[] = {"beads", "bodies", "linked", "bare"};
    for (std::size_t i = 0; i < scene.chains.size(); ++i) scene.chains[i].name = names[i];
    scene.chains[1].bodies.carried = beads_on(9, 5);
    name_residues(scene.chains[0].beads.residue);
    name_residues(scene.chains[2].linked.carried.residue);
    scene.forces.gravity = {{0.5, -1, 2}};
    scene.forces.openmm.emplace();
    scene.forces.openmm->builder = "calvados2";
    scene.forces.openmm->platform = "Reference";
    return scene;
}

double difference(std::vector<Vec3> const& found,
                  std::vector<Vector<long double, 3>> const& expected, std::size_t first) {
    long double worst = 0, largest = 0;
    for (std::size_t k = 0; k < expected.size(); ++k) {
        Vec3 const f = found[first + k];
        worst = std::max(worst, norm(Vector<long double, 3>{{f[0], f[1], f[2]}} - expected[k]));
        largest = std::max(largest, norm(expected[k]));
    }
    return static_cast<double>(worst / largest);
}

TEST(CarriedBeads, ForcesOnThemAreWrenchesOfTheirBodies) {
    Communicator const& world = catena::testing::world();
    Scene const scene = mixed_scene();
    auto const serial = serial_communicator();
    for (Axes const axes : {Axes::joint, Axes::world}) {
        ChainSystem system(scene, axes, world);
        system.evaluate();
        ChainSystem::Accelerations const a = system.accelerations();
        EXPECT_LE(system.residual(), system.residual_bound());
        if (world.rank() != 0) continue;
        ChainSystem alone(scene, axes, *serial);
        alone.evaluate();
        std::vector<Vec3> const expected_force = alone.accelerations().bead_force;
        ASSERT_EQ(a.bead_force.size(), expected_force.size());
        std::size_t body = 0, bead = 0;
        double largest = 0;
        for (Vec3 const& f : expected_force) largest = std::max(largest, norm(f));
        for (std::size_t i = 0; i < expected_force.size();
             ++i)  // sums of the same doubles in another order
            EXPECT_LE(norm(a.bead_force[i] - expected_force[i]), 1e-12 * largest) << i;
        for (ChainSpec const& chain : scene.chains) {
            oracle::Loads loads{scene.forces.gravity, {}};
            loads.bead_forces.assign(a.bead_force.begin() + bead,
                                     a.bead_force.begin() + bead + chain.bead_count());
            auto const exact = oracle::aba<long double>(chain, loads);
            // Forces of 1e6 and more from overlaps: conditions of these short chains are some
            // hundreds.
            EXPECT_LE(difference(a.acceleration, exact.com_acceleration, body), 1e-11)
                << chain.name;
            if (!chain.is_beads()) {
                EXPECT_LE(difference(a.alpha, exact.alpha, body), 1e-11) << chain.name;
            }
            body += chain.size();
            bead += chain.bead_count();
        }
        EXPECT_EQ(bead, expected_force.size());
    }
}

}  // namespace
}  // namespace catena::test
