// Accelerations and joint forces do not depend on the number of ranks and threads, bit for bit: each rank count is compared with
// one rank of the same backend, threads with `segments`, whose tree they share.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "report/solution.hpp"
#include "report/solver_errors.hpp"
#include "tests/mpi/world.hpp"

namespace catena::test {
namespace {

Scene scene_of(std::string const& chains) { return parse_scene("units: si\nforces: {gravity: [0, 0, -9.81]}\nchains:\n" + chains, "test"); }

std::string random_chain(std::string const& joint, int bodies, bool fixed) {
    return "  - {base: " + std::string(fixed ? "fixed" : "free") + ", generator: {random: {bodies: " + std::to_string(bodies) +
           ", joint: " + joint + ", seed: 5}}}\n";
}

Solution solve(Scene scene, Backend backend, Handles handles, int threads, Communicator const& communicator) {
    scene.solver.backend = backend;
    scene.solver.handles = handles;
    scene.solver.threads = threads;
    ChainSystem system(scene, Axes::joint, communicator);
    system.evaluate();
    return solution_of(system);
}

bool same_bits(std::vector<double> const& a, std::vector<double> const& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

/// Threads are there, and are not more than usual machines' cores: waiting for each other then takes long.
bool threads_fit() { return cpu_backends().size() > 2 && testing::world().size() == 1; }

void expect_same_bits(Scene const& scene, std::string const& what, bool with_threads) {
    Communicator const& world = testing::world();
    auto const alone = serial_communicator();
    for (Handles const handles : {Handles::projected, Handles::full})
        for (Backend const backend : {Backend::serial, Backend::segments}) {
            Solution const expected = solve(scene, backend, handles, 1, *alone);
            auto const expect = [&](Backend other, int threads) {
                Solution const found = solve(scene, other, handles, threads, world);
                if (world.rank() != 0) return;
                std::string const name =
                    what + ", " + name_of(other) + ", " + name_of(handles) + ", " + std::to_string(threads) + " threads";
                EXPECT_TRUE(same_bits(found.acceleration, expected.acceleration)) << name;
                EXPECT_TRUE(same_bits(found.joint_force, expected.joint_force)) << name;
            };
            expect(backend, 1);
            if (backend != Backend::segments || !with_threads) continue;
            expect(Backend::openmp, 1);
            expect(Backend::openmp, 2);
        }
}

TEST(SameBits, OneChain) {
    for (char const* const joint : {"link", "spherical", "revolute"})
        for (int const bodies : {1, 2, 3, 255, 256, 257, 10000})
            expect_same_bits(scene_of(random_chain(joint, bodies, bodies % 2 == 1)), std::string(joint) + " " + std::to_string(bodies),
                             threads_fit());
}

TEST(SameBits, SeveralChainsOfDifferentKinds) {
    expect_same_bits(scene_of(random_chain("link", 70, true) + random_chain("revolute", 9, false) + random_chain("link", 300, false) +
                              random_chain("spherical", 130, true) + random_chain("revolute", 1, true)),
                     "several chains", threads_fit() || (cpu_backends().size() > 2 && testing::world().size() == 2));
}

// Every rank packs the box by itself. Velocities made of the positions let accelerations tell places apart.
TEST(SameBits, PackedChains) {
    Scene scene =
        parse_scene("box: {periodic: [6, 6, 6]}\nchains: [{count: 40, sequence: GGGGGGGGGGGGGGGGGGGG, model: calvados2}]", "test");
    for (ChainSpec& chain : scene.chains)
        for (std::size_t k = 0; k < chain.beads.size(); ++k) {
            Vec3 const& at = chain.beads.position[k];
            chain.beads.velocity[k] = {{at[1], at[2], at[0]}};
        }
    EXPECT_GT(std::abs(solve(scene, Backend::segments, Handles::projected, 1, *serial_communicator()).acceleration[0]), 0);
    expect_same_bits(scene, "packed chains", threads_fit());
}

// The comparison itself: another state has other bits.
TEST(SameBits, AnotherChainHasOthers) {
    auto const alone = serial_communicator();
    Solution const a = solve(scene_of(random_chain("link", 257, true)), Backend::segments, Handles::projected, 1, *alone);
    Solution const b = solve(scene_of(random_chain("link", 257, false)), Backend::segments, Handles::projected, 1, *alone);
    EXPECT_EQ(a.acceleration.size(), b.acceleration.size());
    EXPECT_FALSE(same_bits(a.acceleration, b.acceleration));
}

}  // namespace
}  // namespace catena::test
