// OpenMM's forces on beads that stay on the GPUs of several ranks, which may share one, are those of the whole System.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "integrate/chain_system.hpp"
#include "integrate/share.hpp"
#include "integrate/stepper.hpp"
#include "mpi/first_rank.hpp"
#include "tests/gpu/openmm_scene.hpp"
#include "tests/mpi/world.hpp"
#include "tests/support/gpu.hpp"

namespace catena::test {
namespace {

struct Case {
    char const* name;
    char const* chains;
    char const* rest;
    double edge = 20;            // nm, the longest
    bool ghosts_change = false;  // there are beads that a rank does not feel
    int piece = 1;               // the shortest: numbers of ghosts are multiples of it
};

/// What one way of computing found, and where it stood then.
struct Found {
    std::int64_t step = 0;
    Checkpoint checkpoint;       // with the state, on every rank
    std::vector<Vec3> own, all;  // forces on this rank's beads, gravity among them; OpenMM's on all, on rank 0
    std::vector<EnergyTerm> energies;
    GhostTraffic traffic;
    std::int64_t contexts = 0;
    DevicePath::PairLists lists;
};

class OpenMmOnGpus : public ::testing::TestWithParam<Case> {
  protected:
    void SetUp() override {
        need_gpu(world_);
        if (IsSkipped() || HasFatalFailure()) return;
        if (world_.max(cuda::why_no_device_path().empty() ? 0 : 1) == 0) return;
        if (std::getenv("CATENA_NEEDS_GPU") != nullptr) FAIL() << "NOT RUN, though CATENA_NEEDS_GPU is set: " << cuda::why_no_device_path();
        GTEST_SKIP() << "NOT RUN: " << cuda::why_no_device_path();
    }
    void TearDown() override {
        given_way_.empty() ? ::unsetenv("CATENA_GPU_EXCHANGE") : ::setenv("CATENA_GPU_EXCHANGE", given_way_.c_str(), 1);
    }
    std::string given_way_ = std::getenv("CATENA_GPU_EXCHANGE") ? std::getenv("CATENA_GPU_EXCHANGE") : "";
    static Scene scene_with(std::string const& precision, bool on_device, char const* split = "ghosts") {
        Scene scene = parse_scene(openmm_scene(GetParam().chains, GetParam().rest), "scene.yaml");
        scene.solver.backend = Backend::cuda;
        scene.forces.openmm->precision = precision;
        scene.forces.openmm->path = on_device ? "device" : "host";
        scene.forces.openmm->audit = on_device && std::string(split) == "ghosts";
        if (on_device) scene.forces.openmm->split = split;
        scene.forces.openmm->replicate = !on_device;  // the oracle
        return scene;
    }
    /// At step `last`, from the scene's start or from where another stood.
    Found found(Scene const& scene, std::int64_t last, Found const* start = nullptr) {
        ChainSystem system(scene, Axes::world, world_);
        EXPECT_EQ(system.openmm()->path(), scene.forces.openmm->path);
        auto stepper = make_stepper(system, scene.dynamics);
        Found f;
        f.step = start ? start->step : 0;
        if (start) {
            system.set_state(start->checkpoint.arrays);
            stepper->restore(start->checkpoint);
        }
        for (;; ++f.step) {
            if (f.step == 100) system.openmm()->renew_ghosts();
            stepper->prepare(nullptr);
            if (f.step == last) break;
            stepper->step(f.step, nullptr);
        }
        for (AbsoluteDynamics* group : system.absolute()) {
            View<3> const forces = group->bead_forces();
            for (std::int64_t k = 0; k < forces.size; ++k) f.own.push_back(forces.load(k));
        }
        f.energies = system.potential_energy();
        f.all = system.bead_forces();
        stepper->save(f.checkpoint);
        f.checkpoint.arrays = system.state();
        share(world_, f.checkpoint);
        f.traffic = system.openmm()->traffic();
        f.contexts = system.openmm()->contexts();
        if (DevicePath const* const path = system.openmm()->device_path()) f.lists = path->pair_lists();
        return f;
    }
    static std::int64_t scene_beads(Scene const& scene) {
        std::int64_t beads = 0;
        for (auto const& chain : scene.chains) beads += static_cast<std::int64_t>(chain.bead_count());
        return beads;
    }
    double largest(std::vector<Vec3> const& of_rank) const {
        double value = 0;
        for (Vec3 const& v : of_rank) value = std::max(value, norm(v));
        return world_.max(value);
    }
    static double difference(std::vector<Vec3> const& a, std::vector<Vec3> const& b) {
        EXPECT_EQ(a.size(), b.size());
        double value = 0;
        for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) value = larger(value, norm(a[k] - b[k]));
        return value;
    }
    void expect_close(Found const& a, Found const& b, double tolerance) const {
        double const size = largest(b.own);
        EXPECT_GT(size, 1);
        EXPECT_LE(difference(a.own, b.own), tolerance * size + rounding);
        EXPECT_LE(difference(a.all, b.all), tolerance * size + rounding);
        ASSERT_EQ(a.energies.size(), b.energies.size());
        for (std::size_t i = 0; i < a.energies.size(); ++i) {
            EXPECT_EQ(a.energies[i].name, b.energies[i].name);
            EXPECT_TRUE(std::isfinite(a.energies[i].value));
            EXPECT_NEAR(a.energies[i].value, b.energies[i].value, tolerance * (1 + std::abs(b.energies[i].value)));
        }
    }
    /// When somebody asks for them, wherever beads are.
    void expect_lists_made_anew(char const* split) {
        Scene const scene = scene_with("double", true, split);
        ChainSystem system(scene, Axes::world, world_);
        system.evaluate();
        std::vector<Vec3> const before = system.bead_forces();
        for (int i = 0; i < 5; ++i) {
            system.openmm()->renew_ghosts();
            system.evaluate();
        }
        EXPECT_EQ(system.openmm()->traffic().rebuilds, 6);
        EXPECT_LE(difference(system.bead_forces(), before), rounding);
    }
    /// Of a run with a bead at no finite place.
    void expect_the_end_on_every_rank(char const* split) {
        Scene const scene = scene_with("mixed", true, split);
        ChainSystem system(scene, Axes::world, world_);
        system.evaluate();
        Checkpoint c;
        c.arrays = system.state();
        share(world_, c);
        c.arrays["position"][3 * 10 + 1] = NAN;
        system.set_state(c.arrays);
        EXPECT_THROW(system.evaluate(), SharedError);
    }
    /// OpenMM's pair forces take positions x from some origin and out of some cell, which differ, with a rounding of eps x of their
    /// precision: 1e-6 nm at 20 nm in single and mixed. Overlaps of 0.05 nm make forces change by all of themselves: 2e-5 of the largest.
    static double tolerance(std::string const& precision) {
        double const eps = precision == "double" ? 0x1p-53 : 0x1p-24, overlap = 0.05, at_least = 1e-12;
        return std::max(at_least, eps * GetParam().edge / overlap);
    }
    /// OpenMM adds up forces in units of 2^-32 kJ/mol/nm, and what it rounds to them depends on the order of its particles.
    static constexpr double rounding = 16.0 / 4294967296.0;
    Communicator const& world_ = catena::testing::world();
};

/// From GPU to GPU where that can be, or through pinned memory and messages: the same positions. Before the others: memory of another GPU
/// that one Context of a process has opened need not open for the next.
TEST_P(OpenMmOnGpus, GhostsComeEitherWay) {
    Scene const scene = scene_with("double", true);
    ::unsetenv("CATENA_GPU_EXCHANGE");
    Found const either = found(scene, 40);
    ::setenv("CATENA_GPU_EXCHANGE", "host", 1);
    Found const by_host = found(scene, 40);
    EXPECT_FALSE(by_host.traffic.direct);
    EXPECT_EQ(either.traffic.bytes > 0, by_host.traffic.bytes > 0);
    double constexpr after_steps = 1e-8;  // rounding, grown by the chains' own chaos
    expect_close(either, by_host, after_steps);
    if (world_.max(either.traffic.direct ? 0 : 1) > 0)
        GTEST_SKIP() << "NOT RUN: from GPU to GPU: ranks share one, or these do not reach each other's memory";
}

TEST_P(OpenMmOnGpus, ForcesAndEnergiesAreThoseOfTheWholeSystem) {
    for (char const* const precision : {"double", "mixed", "single"})
        expect_close(found(scene_with(precision, true), 0), found(scene_with(precision, false), 0), tolerance(precision));
}

/// Lists, the order of particles and the cells are those of earlier steps.
TEST_P(OpenMmOnGpus, AfterManySteps) {
    for (char const* const precision : {"double", "mixed"}) {
        Found const device = found(scene_with(precision, true), 400);
        EXPECT_GT(device.traffic.rebuilds, 1);
        EXPECT_LT(device.traffic.rebuilds, 100);
        EXPECT_EQ(device.traffic.updates, 401);
        EXPECT_LE(device.contexts, 3);
        if (GetParam().ghosts_change) {
            EXPECT_LT(device.traffic.ghosts, device.all.empty() ? INT64_MAX : std::ssize(device.all) - std::ssize(device.own));
        }
        if (GetParam().piece > 1) {
            EXPECT_GT(device.traffic.ghosts, 0);
            EXPECT_EQ(device.traffic.ghosts % GetParam().piece, 0) << device.traffic.ghosts << ": not in pieces";
        }
        expect_close(device, found(scene_with(precision, false), 400, &device), tolerance(precision));
        expect_close(device, found(scene_with(precision, true), 400, &device), tolerance(precision));
    }
}

TEST_P(OpenMmOnGpus, WithoutOverlap) {
    Scene apart = scene_with("double", true);
    apart.forces.openmm->overlap = false;
    Found const without = found(apart, 20);
    expect_close(without, found(scene_with("double", false), 20, &without), tolerance("double"));
}

TEST_P(OpenMmOnGpus, ListsAreMadeAnewWhenAsked) { expect_lists_made_anew("ghosts"); }

TEST_P(OpenMmOnGpus, ABeadAtNoFinitePlaceEndsTheRunOnEveryRank) { expect_the_end_on_every_rank("ghosts"); }

/// Every rank has every bead, and computes some of the pairs.
class PairsOnGpus : public OpenMmOnGpus {};

TEST_P(PairsOnGpus, ForcesComeEitherWay) {
    Scene const scene = scene_with("double", true, "pairs");
    ::unsetenv("CATENA_GPU_EXCHANGE");
    Found const either = found(scene, 40);
    ::setenv("CATENA_GPU_EXCHANGE", "host", 1);
    Found const by_host = found(scene, 40);
    EXPECT_FALSE(by_host.traffic.direct);
    EXPECT_EQ(by_host.traffic.ghosts, scene_beads(scene) - std::ssize(by_host.own));
    EXPECT_EQ(either.traffic.messages, by_host.traffic.messages);
    double constexpr after_steps = 1e-8;  // rounding, grown by the chains' own chaos
    expect_close(either, by_host, after_steps);
    if (world_.max(either.traffic.direct ? 0 : 1) > 0)
        GTEST_SKIP() << "NOT RUN: from GPU to GPU: ranks share one, or these do not reach each other's memory";
}

TEST_P(PairsOnGpus, ForcesAndEnergiesAreThoseOfTheWholeSystem) {
    for (char const* const precision : {"double", "mixed", "single"})
        expect_close(found(scene_with(precision, true, "pairs"), 0), found(scene_with(precision, false), 0), tolerance(precision));
}

/// Shares, the order of particles and the cells are those of earlier steps.
TEST_P(PairsOnGpus, AfterManySteps) {
    for (char const* const precision : {"double", "mixed"}) {
        Found const device = found(scene_with(precision, true, "pairs"), 400);
        EXPECT_EQ(device.traffic.rebuilds, 2);
        EXPECT_EQ(device.traffic.updates, 401);
        EXPECT_EQ(device.contexts, 1);
        if (std::ssize(device.own) * world_.size() > 2100) {      // OpenMM has lists
            EXPECT_GT(device.lists.kept, 2 * device.lists.made);  // fewer where nothing falls
            EXPECT_GT(device.lists.made, 6);
            EXPECT_EQ(device.lists.made + device.lists.kept, 400);  // the first evaluation finds out whether there are any
        }
        expect_close(device, found(scene_with(precision, false), 400, &device), tolerance(precision));
        expect_close(device, found(scene_with(precision, true, "pairs"), 400, &device), tolerance(precision));
    }
}

/// An order lasts 400 lists of pairs, or 8,000 evaluations.
TEST_P(PairsOnGpus, AfterAnotherOrder) {
    if (scene_beads(scene_with("double", true)) < 2100) return;  // OpenMM has no list of their pairs
    Found const device = found(scene_with("double", true, "pairs"), 1700);
    expect_close(device, found(scene_with("double", false), 1700, &device), tolerance("double"));
    EXPECT_GT(device.lists.made, 420);  // what falls moves fast
}

TEST_P(PairsOnGpus, ListsAreMadeAnewWhenAsked) { expect_lists_made_anew("pairs"); }

TEST_P(PairsOnGpus, WithoutOverlapAndAudited) {
    Scene apart = scene_with("double", true, "pairs");
    apart.forces.openmm->overlap = false;
    apart.forces.openmm->audit = true;
    Found const without = found(apart, 200);
    expect_close(without, found(scene_with("double", false), 200, &without), tolerance("double"));
}

TEST_P(PairsOnGpus, ABeadAtNoFinitePlaceEndsTheRunOnEveryRank) { expect_the_end_on_every_rank("pairs"); }

INSTANTIATE_TEST_SUITE_P(
    Scenes, PairsOnGpus,
    ::testing::Values(Case{"periodic",
                           "{name: a, count: 5, sequence: SEQ, model: calvados2, conformation: self_avoiding, velocities: "
                           "thermal}, {name: b, sequence: KDEKDE, model: calvados2, velocities: thermal}",
                           "box: {periodic: [16, 17, 18]}"},
                      Case{"long_box",
                           "{name: a, count: 120, sequence: MKDEGFYRSAKDWLNQHITVCP, model: calvados2, conformation: self_avoiding, "
                           "velocities: thermal}",
                           "box: {periodic: [90, 13, 12]}", 90},
                      // Half an edge is a cutoff and half of a block of 32 beads: what has moved must not be taken from another cell.
                      Case{"narrow",
                           "{name: a, count: 110, sequence: MKDEGFYRSAKDWLNQHITVCP, model: calvados2, conformation: self_avoiding, "
                           "velocities: thermal}",
                           "box: {periodic: [11.2, 11, 42]}", 42},
                      Case{"open", "{name: a, sequence: SEQSEQ, model: calvados2, conformation: self_avoiding, velocities: thermal}", ""}),
    [](auto const& scene) { return scene.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Scenes, OpenMmOnGpus,
    ::testing::Values(Case{"periodic",
                           "{name: a, count: 5, sequence: SEQ, model: calvados2, conformation: self_avoiding, velocities: "
                           "thermal}, {name: b, sequence: KDEKDE, model: calvados2, velocities: thermal}",
                           "box: {periodic: [16, 17, 18]}"},
                      Case{"long_box",
                           "{name: a, count: 40, sequence: MKDEGFYRSAKDWLNQHITVCP, model: calvados2, conformation: self_avoiding, "
                           "velocities: thermal}",
                           "box: {periodic: [90, 13, 12]}", 90, true},
                      // Of 32, 32 and 16 beads; so many chains are dealt whole to three ranks.
                      Case{"in_pieces",
                           "{name: a, count: 48, sequence: SEQMDVFMKGLS, model: calvados2, conformation: self_avoiding, velocities: "
                           "thermal}",
                           "box: {periodic: [110, 14, 13]}", 110, true, 16},
                      Case{"open", "{name: a, sequence: SEQSEQ, model: calvados2, conformation: self_avoiding, velocities: thermal}", ""},
                      Case{"held",
                           "{name: a, base: fixed, sequence: SEQ, model: calvados2, conformation: self_avoiding, velocities: "
                           "thermal}",
                           "box: {periodic: [40, 40, 40]}"}),
    [](auto const& scene) { return scene.param.name; });

/// A rank that has none takes part in what all do.
class RanksWithoutBeads : public OpenMmOnGpus {};
TEST_P(RanksWithoutBeads, TakePart) {
    Found const device = found(scene_with("double", true), 30);
    expect_close(device, found(scene_with("double", false), 30, &device), tolerance("double"));
}
INSTANTIATE_TEST_SUITE_P(Scenes, RanksWithoutBeads,
                         ::testing::Values(Case{"pair", "{name: a, sequence: KE, model: calvados2, velocities: thermal}",
                                                "box: {periodic: [20, 20, 20]}"}),
                         [](auto const& scene) { return scene.param.name; });

}  // namespace
}  // namespace catena::test
