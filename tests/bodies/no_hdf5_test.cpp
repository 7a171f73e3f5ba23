// A build without HDF5 says so.
#include "tests/reader/refusal.hpp"

namespace catena::test {
namespace {

TEST(NoHdf5, is_named_with_its_remedy) {
    EXPECT_EQ(refusal_of("chains: [{base: fixed, bodies: {hdf5: chain.h5}}]"),
              "built without HDF5 (bodies chain.h5): install HDF5 (libhdf5-dev) and build again, "
              "or write the bodies as a list");
}

}  // namespace
}  // namespace catena::test
