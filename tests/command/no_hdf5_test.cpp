#include "tests/command/program.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

TEST(NoHdf5, SaysSo) {
    TemporaryFolder const folder;
    expect_refused(catena({"solve", input("arm.yaml"), "--accelerations", "a.h5"}, folder.path()),
                   2, "built without HDF5 (--accelerations a.h5)");
    expect_refused(catena({"run", input("arm.yaml"), "--steps", "1", "--quiet"}, folder.path()), 2,
                   "built without HDF5");
    expect_refused(catena({"analyse", "run"}, folder.path()), 2, "built without HDF5");
    expect_refused(catena({"convert", "run", "a.dcd"}, folder.path()), 2, "built without HDF5");
    EXPECT_NE(catena({"--version"}).out.find("HDF5    none"), std::string::npos);
}

}  // namespace
}  // namespace catena::test
