#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "error.hpp"
#include "mpi/communicator.hpp"

namespace catena {
namespace {

TEST(NoMpi, SeveralProcessesAreRefused) {
    setenv("OMPI_COMM_WORLD_RANK", "1", 1);
    setenv("OMPI_COMM_WORLD_SIZE", "2", 1);
    try {
        world_communicator(nullptr, nullptr);
        FAIL() << "two processes without MPI were accepted";
    } catch (InputError const& error) {
        EXPECT_EQ(std::string(error.what())
                      .rfind("built without MPI (started with OMPI_COMM_WORLD_SIZE=2): ", 0),
                  0u)
            << error.what();
    }
}

TEST(NoMpi, OneProcessIsSerial) {
    setenv("OMPI_COMM_WORLD_RANK", "0", 1);
    setenv("OMPI_COMM_WORLD_SIZE", "1", 1);
    EXPECT_EQ(world_communicator(nullptr, nullptr)->size(), 1);
    EXPECT_EQ(message_passing_library(), "none");
}

}  // namespace
}  // namespace catena
