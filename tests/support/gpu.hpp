// Whether tests of the GPU's backend run on this machine.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>

#include "cuda/device/gpu.hpp"

namespace catena::test {

/// To be called in SetUp. Where a rank has no GPU all skip the test; where CATENA_NEEDS_GPU is set,
/// it fails: nothing may pass by not running. Collective.
inline void need_gpu(Communicator const& communicator = *serial_communicator()) {
    if (communicator.max(cuda::why_not().empty() ? 0 : 1) == 0) return;
    if (std::getenv("CATENA_NEEDS_GPU") != nullptr)
        FAIL() << "NOT RUN, though CATENA_NEEDS_GPU is set: " << cuda::why_not();
    GTEST_SKIP() << "NOT RUN: " << cuda::why_not();
}

}  // namespace catena::test
