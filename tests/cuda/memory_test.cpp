// What is counted beforehand is what the GPU then has less.
#include <gtest/gtest.h>

#include "cuda/space/memory.hpp"
#include "integrate/chain_system.hpp"
#include "plan/family.hpp"
#include "reader/load_scene.hpp"
#include "tests/support/gpu.hpp"

namespace catena::test {
namespace {

std::vector<plan::Family> families() {
    std::vector<plan::Family> all = plan::all_families();
    all.push_back({scene::RandomJoint::revolute, false, Axes::joint, Handles::articulated});
    return all;
}

class GpuMemoryTaken : public ::testing::Test {
  protected:
    void SetUp() override { need_gpu(); }
    static void expect_taken(Scene const& scene, Axes axes, Communicator const& alone) {
        {
            ChainSystem(scene, axes, alone).evaluate();
        }  // what kernels and streams take is there from now on
        std::int64_t const before = cuda::free_memory(alone);
        ChainSystem system(scene, axes, alone);
        system.evaluate();
        system.wait();
        cuda::DeviceMemory counted;
        for (auto const& group : system.groups())
            counted += cuda::memory_needed(*group, scene, scene.solver.backend, alone);
        std::int64_t const taken = before - cuda::free_memory(alone);
        // The driver gives memory in pages of 2 MiB, which small allocations share; what passed
        // through may stay with the stream. Block ranges and items on their way are counted by
        // their bounds.
        std::int64_t const pages = std::int64_t{counted.allocations} << 21;
        EXPECT_LE(taken, counted.sum() + pages);
        EXPECT_GE(taken, counted.bytes - counted.bytes / 20 - pages);
    }
};

TEST_F(GpuMemoryTaken, IsWhatWasCounted) {
    auto const alone = serial_communicator();
    ASSERT_EQ(cuda::choose_device(*alone), "");
    for (Backend const backend : {Backend::cuda, Backend::cuda_levels})
        for (plan::Family const& family : families()) {
            SCOPED_TRACE(family.name() + ", " + name_of(backend));
            Scene scene = plan::sample(family, 300000);
            scene.solver.backend = backend;
            expect_taken(scene, family.axes, *alone);
        }
}

TEST_F(GpuMemoryTaken, IsWhatWasCountedOfAlikeBodies) {
    auto const alone = serial_communicator();
    ASSERT_EQ(cuda::choose_device(*alone), "");
    std::int64_t bytes[2] = {};
    for (char const* const mass : {"2", "{uniform: [1, 2]}"}) {
        Scene scene = parse_scene(
            std::string(
                "chains: [{base: fixed, generator: {coil: {bodies: 300000, length: 1, mass: ") +
                mass + "}}}]",
            "rods.yaml");
        scene.solver.backend = Backend::cuda;
        expect_taken(scene, Axes::joint, *alone);
        ChainSystem const system(scene, Axes::joint, *alone);
        bytes[mass[0] == '{'] =
            cuda::memory_needed(*system.groups().front(), scene, scene.solver.backend, *alone)
                .bytes;
    }
    EXPECT_GE(
        bytes[1] - bytes[0],
        300000 * (1 + 6) * std::int64_t{sizeof(double)});  // inverse masses and inertias at least
}

}  // namespace
}  // namespace catena::test
