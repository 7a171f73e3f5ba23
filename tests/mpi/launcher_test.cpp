#include "mpi/launcher.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "mpi/communicator.hpp"

namespace catena {
namespace {

/// Runs each case as if nothing had started the process; its own variables are its own business
/// (one process a case).
class LauncherTest : public ::testing::Test {
  protected:
    void SetUp() override {
        for (char const* name :
             {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", "PMI_RANK", "PMI_SIZE", "PMIX_RANK",
              "MV2_COMM_WORLD_RANK", "MV2_COMM_WORLD_SIZE", "SLURM_STEP_NUM_TASKS", "SLURM_NTASKS"})
            unsetenv(name);
    }
    static void set(char const* name, char const* value) { setenv(name, value, 1); }
};

TEST_F(LauncherTest, NothingStartedThisProcess) {
    EXPECT_FALSE(launch_environment().found);
    EXPECT_EQ(launch_environment().size, 1);
    auto const communicator = world_communicator(nullptr, nullptr);
    EXPECT_EQ(communicator->size(), 1);
    EXPECT_EQ(communicator->rank(), 0);
}

TEST_F(LauncherTest, OpenMpi) {
    set("OMPI_COMM_WORLD_RANK", "2");
    set("OMPI_COMM_WORLD_SIZE", "4");
    Launch const launch = launch_environment();
    EXPECT_TRUE(launch.found);
    EXPECT_EQ(launch.rank, 2);
    EXPECT_EQ(launch.size, 4);
    EXPECT_EQ(launch.evidence, "OMPI_COMM_WORLD_SIZE=4");
}

TEST_F(LauncherTest, ProcessManagerOfMpich) {
    set("PMI_RANK", "0");
    set("PMI_SIZE", "3");
    EXPECT_EQ(launch_environment().size, 3);
}

TEST_F(LauncherTest, PmixNamesNoSize) {
    set("PMIX_RANK", "1");
    EXPECT_EQ(launch_environment().size, 2);
    EXPECT_EQ(launch_environment().evidence, "PMIX_RANK=1");
    set("SLURM_STEP_NUM_TASKS", "6");
    EXPECT_EQ(launch_environment().size, 6);
}

TEST_F(LauncherTest, BatchScriptOfSlurmIsNoLauncher) {
    set("SLURM_NTASKS", "8");
    EXPECT_FALSE(launch_environment().found);
}

TEST_F(LauncherTest, ValuesThatAreNoNumbersDoNotCount) {
    set("PMI_RANK", "x1");
    EXPECT_FALSE(launch_environment().found);
}

}  // namespace
}  // namespace catena
