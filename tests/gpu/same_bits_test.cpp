// What the GPU computes has the bits of the same tree on the host: one operation for one, each rounded alike.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cuda/solver.hpp"
#include "dca/tree.hpp"
#include "integrate/chain_system.hpp"
#include "tests/support/random_chain.hpp"

namespace catena::test {
namespace {

class Gpu : public ::testing::Test {
  protected:
    void SetUp() override {
        if (!cuda::why_not().empty()) GTEST_SKIP() << "NOT RUN: " << cuda::why_not();
    }
    struct Found {
        ChainSystem::Accelerations a;
        double residual;
    };
    Found solve(Scene scene, Backend backend, Axes axes) const {
        scene.solver.backend = backend;
        ChainSystem system(scene, axes, *communicator_);
        system.evaluate();
        EXPECT_LE(system.residual(), system.residual_bound());
        return {system.accelerations(), system.residual()};
    }
    void expect_same(Scene const& scene, Axes axes = Axes::joint) const {
        Found const host = solve(scene, Backend::segments, axes), device = solve(scene, Backend::cuda, axes);
        auto const same = [](auto const& x, auto const& y) {
            return x.size() == y.size() && (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0);
        };
        EXPECT_TRUE(same(host.a.joint_acceleration, device.a.joint_acceleration));
        EXPECT_TRUE(same(host.a.acceleration, device.a.acceleration));
        EXPECT_TRUE(same(host.a.alpha, device.a.alpha));
        EXPECT_TRUE(same(host.a.joint_force, device.a.joint_force));
        EXPECT_TRUE(same(device.a.joint_force, solve(scene, Backend::cuda, axes).a.joint_force)) << "a second time";
    }
    static Scene scene_of(std::string const& generator, Handles handles) {
        Scene scene = parse_scene("chains: [" + generator + "]\nforces: {gravity: [1, 2, -9.81]}", "scene.yaml");
        scene.solver.handles = handles;
        return scene;
    }
    std::unique_ptr<Communicator> communicator_ = serial_communicator();
};

TEST_F(Gpu, EveryKindAndSize) {
    for (char const* const joint : {"link", "planar", "spherical", "universal", "revolute", "prismatic", "helical", "weld", "mixed"})
        for (int const bodies : {1, 2, 3, 31, 32, 33, 255, 256, 257, 2047, 2048, 2049})
            for (Handles const handles : {Handles::projected, Handles::full})
                for (char const* const base : {"free", "fixed"}) {
                    SCOPED_TRACE(std::string(joint) + " " + std::to_string(bodies) + " " + base + " " + name_of(handles));
                    expect_same(scene_of(std::string("{base: ") + base + ", generator: {random: {bodies: " + std::to_string(bodies) +
                                             ", joint: " + joint + ", seed: 1}}}",
                                         handles));
                    if (HasFailure()) return;
                }
}

TEST_F(Gpu, AMillionAndOne) {
    for (char const* const joint : {"link", "spherical", "revolute"})
        expect_same(scene_of(std::string("{base: fixed, generator: {random: {bodies: 1000001, joint: ") + joint + ", seed: 1}}}",
                             Handles::projected));
}

TEST_F(Gpu, ManyChainsAndTips) {
    std::string const of = "generator: {random: {joint: ", tip = ", seed: 3}}, tip: {joint: {type: spherical}}}";
    expect_same(
        scene_of("{name: a, count: 50, generator: {random: {joint: link, bodies: 70, rigid: 0.3, seed: 2}}}, "
                 "{name: b, base: fixed, " +
                     of + "spherical, bodies: 40" + tip + ", {name: c, base: fixed, " + of + "mixed, bodies: 50" + tip +
                     ", {name: d, base: fixed, tip: {joint: {type: link, anchor: [1, 2, 3]}}, " + of + "link, bodies: 33, seed: 4}}}",
                 Handles::projected));
}

TEST_F(Gpu, AbsoluteCoordinates) {
    for (Handles const handles : {Handles::projected, Handles::full})
        for (char const* const base : {"free", "fixed"})
            expect_same(
                scene_of(std::string("{base: ") + base + ", generator: {random: {bodies: 300, joint: spherical, seed: 1}}}", handles),
                Axes::world);
}

}  // namespace
}  // namespace catena::test
