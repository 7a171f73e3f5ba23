#include <gtest/gtest.h>

#include <optional>

#include "cuda/space/memory.hpp"
#include "cuda/space/memory_estimator.hpp"
#include "plan/family.hpp"

namespace catena::test {
namespace {

cuda::DeviceMemory needed(plan::Family const& family, std::int64_t bodies, Backend backend) {
    Scene scene = plan::sample(family, bodies);
    scene.solver.backend = backend;
    auto const alone = serial_communicator();
    auto const groups =
        make_groups(scene, family.axes, family.handles, scene.solver.pairwise(), *alone);
    return cuda::memory_needed(*groups.front(), scene, backend, *alone);
}

TEST(GpuMemory, GrowsWithBodiesAndDirections) {
    for (Backend const backend : {Backend::cuda, Backend::cuda_levels})
        for (plan::Family const& family : plan::all_families()) {
            SCOPED_TRACE(family.name());
            double const small = static_cast<double>(needed(family, 2000, backend).sum());
            double const large = static_cast<double>(needed(family, 20000, backend).sum());
            EXPECT_LE(large / small, 10.5);
            EXPECT_GE(large / small, 9);  // axes of joints that have none, and the like, are those
                                          // of all bodies: a tile of either
            // What the solver keeps of the joints alone: a factor, two gains and three vectors of
            // its directions.
            int const k = family.handles == Handles::full
                              ? (family.joint == scene::RandomJoint::link ? 3 : 6)
                              : 1;
            EXPECT_GT(small, 2000.0 * 8 * k * (k + 1) / 2);
        }
}

/// By hand, of one number for each of 1000 bodies: with two halo bodies 1001 places after the
/// first, whole tiles of 512 and one line before.
TEST(GpuMemory, TransientIsTheWidestField) {
    std::int64_t const columns = 32 + 1024;
    EXPECT_EQ(needed({scene::RandomJoint::revolute}, 1000, Backend::cuda).transient,
              6 * columns * 8);  // axes, inertias
    EXPECT_EQ(needed({scene::RandomJoint::link, false, Axes::world}, 1000, Backend::cuda).transient,
              3 * columns * 8);
}

/// Solver and dynamics of a group hold one model, which goes with the last of them.
TEST(GpuMemory, ModelOfAGroupIsCountedOnce) {
    plan::Family const family{scene::RandomJoint::revolute};
    Scene const scene = plan::sample(family, 1000);
    auto const alone = serial_communicator();
    auto const groups =
        make_groups(scene, family.axes, family.handles, scene.solver.pairwise(), *alone);
    cuda::MemoryEstimator const space, copy = space, other;
    cuda::Count const count;
    std::optional first = space.model(*groups.front());
    std::int64_t const bytes = count.sum().bytes;
    EXPECT_GE(bytes, 1000 * (2 * 3 + 2 * 6 + 2 * (1 + 6)) * 8);
    std::optional second = copy.model(*groups.front());
    EXPECT_EQ(count.sum().bytes, bytes);
    std::optional const third = other.model(*groups.front());
    EXPECT_EQ(count.sum().bytes, 2 * bytes);
    first.reset();
    second.reset();
    std::optional const again = space.model(*groups.front());
    EXPECT_EQ(count.sum().bytes, 3 * bytes);
}

TEST(GpuMemory, TooLittleIsSaidInGibibytes) {
    std::int64_t const gib = std::int64_t{1} << 30;
    EXPECT_EQ(cuda::too_little_memory(gib, gib), "");
    EXPECT_EQ(cuda::too_little_memory(5 * gib / 2, gib),
              "2.5 GiB of GPU memory are needed and 1 GiB are free");
}

}  // namespace
}  // namespace catena::test
