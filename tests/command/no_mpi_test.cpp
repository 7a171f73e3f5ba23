#include "tests/command/program.hpp"

namespace catena::test {
namespace {

TEST(NoMpi, SeveralProcessesAreRefusedByTheFirstOfThem) {
    Words const check{program(), "check", input("arm.yaml")};
    expect_refused(run_program(check, "", {"OMPI_COMM_WORLD_SIZE=2", "OMPI_COMM_WORLD_RANK=0"}), 2,
                   "built without MPI");
    Ended const second =
        run_program(check, "", {"OMPI_COMM_WORLD_SIZE=2", "OMPI_COMM_WORLD_RANK=1"});
    EXPECT_EQ(second.status, 2);
    EXPECT_EQ(second.out + second.err, "");
}

}  // namespace
}  // namespace catena::test
