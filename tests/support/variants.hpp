// A test of every backend and kind of handles.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "error.hpp"
#include "integrate/chain_system.hpp"
#include "math/executor.hpp"
#include "tests/support/gpu.hpp"

namespace catena::test {

struct Variant {
    Backend backend;
    Handles handles;
};
inline std::string name_of_variant(testing::TestParamInfo<Variant> const& info) {
    std::string name = std::string(name_of(info.param.backend)) + "_" + name_of(info.param.handles);
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

class WithVariant : public testing::TestWithParam<Variant> {
  protected:
    /// Skipped where this build or this machine has no such backend.
    void SetUp() override {
        if (uses_gpu(GetParam().backend)) need_gpu();
        if (GetParam().backend != Backend::openmp) return;
        try {
            openmp_executor(2);
        } catch (InputError const& error) {
            ASSERT_NE(std::string(error.what()).find("built without OpenMP"), std::string::npos);
            GTEST_SKIP() << "NOT RUN: this build is without OpenMP";
        }
    }
    Scene with_backend(Scene scene) const {
        scene.solver.backend = GetParam().backend;
        scene.solver.handles = GetParam().handles;
        return scene;
    }
    std::unique_ptr<Communicator> communicator_ = serial_communicator();
};

}  // namespace catena::test
