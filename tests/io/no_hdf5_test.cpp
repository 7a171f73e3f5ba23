#include <gtest/gtest.h>

#include "error.hpp"
#include "io/output.hpp"

namespace catena::test {
namespace {

TEST(WithoutHdf5, EveryUseSaysSo) {
    auto const line = [](auto&& action) {
        try {
            action();
        } catch (InputError const& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(line([] { make_trajectory("t.h5md", {}, false, false, {}); }),
              "built without HDF5 (trajectory t.h5md): install HDF5 (libhdf5-dev) and build again");
    EXPECT_TRUE(line([] {
                    write_checkpoint("c.h5", {});
                }).starts_with("built without HDF5 (checkpoint c.h5): "));
    EXPECT_TRUE(line([] {
                    CheckpointWriter(*std::unique_ptr<Communicator>(serial_communicator()), "c.h5",
                                     {}, {});
                }).starts_with("built without HDF5 (checkpoint c.h5): "));
    EXPECT_TRUE(line([] {
                    read_checkpoint("c.h5");
                }).starts_with("built without HDF5 (checkpoint c.h5): "));
    EXPECT_EQ(hdf5_version(), "none");
}

}  // namespace
}  // namespace catena::test
