#include "force/path.hpp"

#include "tests/force/beads.hpp"

namespace catena::testing {
namespace {

/// The path after trials with these seconds.
PathChoice tried(double inline_seconds, double host_seconds) {
    auto const serial = serial_communicator();
    PathChoice choice("auto", true, no_gpu_asked_for, "scene.yaml");
    for (int i = 0; i < 2 * PathChoice::trials; ++i) {
        choice.settle(*serial);
        EXPECT_EQ(choice.runs_on_worker(), i >= PathChoice::trials);
        bool const first = i % PathChoice::trials == 0;  // builds something: must not count
        choice.note(first ? 1.0 : choice.runs_on_worker() ? host_seconds : inline_seconds);
    }
    choice.settle(*serial);
    return choice;
}

TEST(Path, TheFasterOneIsTaken) {
    EXPECT_TRUE(tried(2e-3, 1e-3).runs_on_worker());
    EXPECT_EQ(tried(2e-3, 1e-3).text(),
              "host (a worker thread), the faster one: from begin to end 1 ms on the worker, 2 ms "
              "inline");
    EXPECT_FALSE(tried(1e-3, 2e-3).runs_on_worker());
    EXPECT_EQ(tried(1e-3, 2e-3).text(),
              "inline (the calling thread), the faster one: from begin to end 2 ms on the worker, "
              "1 ms inline");
    PathChoice choice = tried(1e-3, 2e-3);
    for (int i = 0; i < 20; ++i) choice.note(100);
    EXPECT_FALSE(choice.runs_on_worker());
}

TEST(Path, WhatTheSceneSaysIsTaken) {
    EXPECT_TRUE(PathChoice("host", true, "", "s").runs_on_worker());
    EXPECT_FALSE(PathChoice("inline", true, "", "s").runs_on_worker());
    EXPECT_TRUE(PathChoice("auto", false, "no GPU", "s")
                    .runs_on_worker());  // a GPU: the caller's core is free meanwhile
}

TEST(Path, AGpuIsTakenWhereItCanBe) {
    for (char const* const asked : {"auto", "device"}) {
        PathChoice const choice(asked, true, "", "s");
        EXPECT_TRUE(choice.on_device());
        EXPECT_FALSE(choice.runs_on_worker());
        EXPECT_EQ(choice.name(), "device");
        EXPECT_EQ(choice.text(), "device (positions and forces stay on the GPU)");
    }
    for (char const* const asked : {"host", "inline"})
        EXPECT_EQ(PathChoice(asked, true, "", "s").name(), asked);
    EXPECT_EQ(PathChoice("auto", false, "several ranks", "s").text(),
              "host (a worker thread); not device: several ranks");
    EXPECT_EQ(PathChoice("auto", false, no_gpu_asked_for, "s").text(), "host (a worker thread)");
    EXPECT_EQ(PathChoice("host", false, "several ranks", "s").text(), "host (a worker thread)");
}

TEST(Path, Messages) {
    EXPECT_EQ(complaint([] { PathChoice("device", true, "there is none", "s.yaml"); }),
              "positions and forces cannot stay on a GPU: there is none (s.yaml: "
              "forces.openmm.path): use auto, or chains of beads and of rigid domains, "
              "--backend cuda and forces.openmm.platform: CUDA on a machine with a GPU");
    EXPECT_EQ(complaint([] { PathChoice("remote", true, "", "s.yaml"); }),
              "`remote` is not a path of OpenMM's forces (s.yaml: forces.openmm.path): use auto, "
              "device, host or inline");
}

}  // namespace
}  // namespace catena::testing
