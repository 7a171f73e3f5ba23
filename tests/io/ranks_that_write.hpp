// Ranks of a test that write a file together.
#pragma once

#include <gtest/gtest.h>

#include <span>
#include <string>

#include "io/writers.hpp"
#include "tests/mpi/world.hpp"

namespace catena::test {

/// Rank 0's word on all ranks.
inline std::string of_root(std::string text) {
    text.resize(300, ' ');
    catena::testing::world().broadcast(std::as_writable_bytes(std::span(text)));
    return text.substr(0, text.find(' '));
}

inline bool can_write_together() {
    Communicator const& world = catena::testing::world();
    return world.size() > 1 &&
           world.sum(hdf5::why_not_by_all(world).empty() ? 1 : 0) == world.size();
}

#define NEEDS_PARALLEL_HDF5    \
    if (!can_write_together()) \
    GTEST_SKIP() << "NOT RUN: one rank, or " << hdf5::why_not_by_all(catena::testing::world())

}  // namespace catena::test
