// A relaxed start has the same bits in every run, on any number of ranks and threads.
#include "start/start_relaxation.hpp"

#include <gtest/gtest.h>

#include "force/openmm_force.hpp"
#include "integrate/scene_beads.hpp"
#include "reader/load_scene.hpp"
#include "tests/mpi/world.hpp"

namespace catena::test {
namespace {

/// Chains of enough beads that several threads of OpenMM share them.
Scene melt() {
    return parse_scene(
        "relax: true\nbox: {periodic: [8, 8, 8]}\nchains: [{name: a, count: 4, sequence: "
        "MDVFMKGLSKAKEGVVAAAEKTKQGVAEAAGKTKEGVLYVGSKTKEGVVHGVATVAEKTK, model: calvados2, "
        "conformation: self_avoiding, crosslinks: [[12, 38, 0.55]]}]\n"
        "forces: {openmm: {builder: calvados2, ionic_strength: 0.15}}\n"
        "dynamics: {integrator: g-baoab, step: 0.01, temperature: 300, friction: 0.01}\n",
        "test");
}

std::vector<Vec3> relaxed(int threads, Communicator const& communicator) {
    Scene scene = melt();
    scene.forces.openmm->threads = threads;
    return bead_positions_of(relax_start(scene, communicator).scene);
}

void expect_same(std::vector<Vec3> const& found, std::vector<Vec3> const& expected,
                 std::string const& what) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k)
        for (int i = 0; i < 3; ++i)
            ASSERT_EQ(found[k][i], expected[k][i]) << what << ", bead " << k;
}

TEST(StartRelaxation, HasTheSameBitsInEveryRun) {
    if (openmm_platforms().empty()) GTEST_SKIP() << "NOT RUN: built without OpenMM";
    auto const alone = serial_communicator();
    std::vector<Vec3> const expected = relaxed(0, *alone);
    EXPECT_NE(bead_positions_of(melt())[0][0], expected[0][0]) << "nothing was moved";
    expect_same(relaxed(0, testing::world()), expected, "again");
    expect_same(relaxed(2, testing::world()), expected, "two threads");
    expect_same(relaxed(4, testing::world()), expected, "four threads");
}

}  // namespace
}  // namespace catena::test
