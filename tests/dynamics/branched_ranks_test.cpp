// Branched chains run on one rank only, and all ranks say so.
#include <gtest/gtest.h>

#include "error.hpp"
#include "integrate/chain_system.hpp"
#include "tests/dynamics/branched_chains.hpp"
#include "tests/mpi/world.hpp"

namespace catena::test {
namespace {

TEST(BranchedChains, AreRefusedOnSeveralRanks) {
    Communicator const& world = catena::testing::world();
    Scene scene;
    scene.chains = {random_bead_chain(1, 4, Base::free), grown(2, star_parents(3), Base::free)};
    std::string text;
    try {
        ChainSystem const system(scene, Axes::world, world);
    } catch (InputError const& e) {
        text = e.what();
    }
    EXPECT_EQ(text.find("branched chains run on one rank") != std::string::npos, world.size() > 1)
        << text;
}

}  // namespace
}  // namespace catena::test
