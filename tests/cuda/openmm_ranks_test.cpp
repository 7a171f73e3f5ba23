// OpenMM's forces on beads that stay on the GPUs of several ranks, which may share one, are those
// of the whole System.
#include "tests/cuda/openmm_ranks.hpp"

namespace catena::test {
namespace {

/// From GPU to GPU where that can be, or through pinned memory and messages: the same positions.
/// Before the others: memory of another GPU that one Context of a process has opened need not open
/// for the next.
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
        GTEST_SKIP() << "NOT RUN: from GPU to GPU: ranks share one, or these do not reach each "
                        "other's memory";
}

TEST_P(OpenMmOnGpus, ForcesAndEnergiesAreThoseOfTheWholeSystem) {
    for (char const* const precision : {"double", "mixed", "single"})
        expect_close(found(scene_with(precision, true), 0), found(scene_with(precision, false), 0),
                     tolerance(precision));
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
            EXPECT_LT(device.traffic.ghosts, device.all.empty()
                                                 ? INT64_MAX
                                                 : std::ssize(device.all) - std::ssize(device.own));
        }
        if (GetParam().piece > 1) {
            EXPECT_GT(device.traffic.ghosts, 0);
            EXPECT_EQ(device.traffic.ghosts % GetParam().piece, 0)
                << device.traffic.ghosts << ": not in pieces";
        }
        expect_close(device, found(scene_with(precision, false), 400, &device),
                     tolerance(precision));
        expect_close(device, found(scene_with(precision, true), 400, &device),
                     tolerance(precision));
    }
}

TEST_P(OpenMmOnGpus, WithoutOverlap) {
    Scene apart = scene_with("double", true);
    apart.forces.openmm->overlap = false;
    Found const without = found(apart, 20);
    expect_close(without, found(scene_with("double", false), 20, &without), tolerance("double"));
}

/// Ghosts are in one Context, whatever layers the scene asks for.
TEST_P(OpenMmOnGpus, OneListServesAllForces) {
    Scene scene = scene_with("double", true);
    scene.forces.openmm->layers = "all";
    ChainSystem system(scene, Axes::world, world_);
    bool said = false;
    for (std::string const& line : system.openmm()->description()) {
        said = said || line.ends_with("; one list of pairs serves all forces");
        EXPECT_EQ(line.find("in a Context of its own"), std::string::npos) << line;
    }
    EXPECT_EQ(world_.max(said ? 1 : 0), world_.size() > 1 ? 1 : 0);
}

TEST_P(OpenMmOnGpus, ListsAreMadeAnewWhenAsked) { expect_lists_made_anew("ghosts"); }

TEST_P(OpenMmOnGpus, ABeadAtNoFinitePlaceEndsTheRunOnEveryRank) {
    expect_the_end_on_every_rank("ghosts");
}

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
        GTEST_SKIP() << "NOT RUN: from GPU to GPU: ranks share one, or these do not reach each "
                        "other's memory";
}

TEST_P(PairsOnGpus, ForcesAndEnergiesAreThoseOfTheWholeSystem) {
    for (char const* const precision : {"double", "mixed", "single"})
        expect_close(found(scene_with(precision, true, "pairs"), 0),
                     found(scene_with(precision, false), 0), tolerance(precision));
}

/// Shares, the order of particles and the cells are those of earlier steps.
TEST_P(PairsOnGpus, AfterManySteps) {
    for (char const* const precision : {"double", "mixed"}) {
        Found const device = found(scene_with(precision, true, "pairs"), 400);
        EXPECT_EQ(device.traffic.rebuilds, 2);
        EXPECT_EQ(device.traffic.updates, 401);
        EXPECT_EQ(device.contexts, GetParam().layers ? 2 : 1);
        if (std::ssize(device.own) * world_.size() > 2100) {  // OpenMM has lists
            // Fewer where nothing falls; lists of layers do not last as long.
            EXPECT_GT(device.lists.kept, (GetParam().layers ? 1 : 2) * device.lists.made);
            EXPECT_GT(device.lists.made, 6);
            EXPECT_EQ(device.lists.made + device.lists.kept,
                      400);  // the first evaluation finds out whether there are any
        }
        expect_close(device, found(scene_with(precision, false), 400, &device),
                     tolerance(precision));
        expect_close(device, found(scene_with(precision, true, "pairs"), 400, &device),
                     tolerance(precision));
    }
}

/// An order lasts until a bead may have moved 80 nm, or 8,000 evaluations.
TEST_P(PairsOnGpus, AfterAnotherOrder) {
    if (scene_beads(scene_with("double", true)) < 2100)
        return;  // OpenMM has no list of their pairs
    Found const device = found(scene_with("double", true, "pairs"), 1700);
    expect_close(device, found(scene_with("double", false), 1700, &device), tolerance("double"));
    EXPECT_GT(device.lists.made, 420);  // what falls moves fast
}

/// Where each rank finds its share's, from what its forces came from.
TEST_P(PairsOnGpus, ARunDoesNotDependOnEnergiesAskedFor) {
    Scene const scene = scene_with("double", true, "pairs");
    Found const asked = found(scene, 60, nullptr, true), not_asked = found(scene, 60);
    EXPECT_EQ(asked.checkpoint.arrays, not_asked.checkpoint.arrays);
    EXPECT_EQ(asked.lists.kept, not_asked.lists.kept);
}

TEST_P(PairsOnGpus, ListsAreMadeAnewWhenAsked) { expect_lists_made_anew("pairs"); }

TEST_P(PairsOnGpus, WithoutOverlapAndAudited) {
    Scene apart = scene_with("double", true, "pairs");
    apart.forces.openmm->overlap = false;
    apart.forces.openmm->audit = true;
    Found const without = found(apart, 200);
    expect_close(without, found(scene_with("double", false), 200, &without), tolerance("double"));
}

TEST_P(PairsOnGpus, ABeadAtNoFinitePlaceEndsTheRunOnEveryRank) {
    expect_the_end_on_every_rank("pairs");
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, PairsOnGpus,
    ::testing::Values(
        Case{"periodic",
             "{name: a, count: 5, sequence: SEQ, model: calvados2, conformation: self_avoiding, "
             "velocities: "
             "thermal}, {name: b, sequence: KDEKDE, model: calvados2, velocities: thermal}",
             "box: {periodic: [16, 17, 18]}"},
        Case{"long_box",
             "{name: a, count: 120, sequence: MKDEGFYRSAKDWLNQHITVCP, model: calvados2, "
             "conformation: self_avoiding, "
             "velocities: thermal}",
             "box: {periodic: [90, 13, 12]}", 90},
        // Half an edge is a cutoff and half of a block of 32 beads: what has moved must not be
        // taken from another cell.
        Case{"narrow",
             "{name: a, count: 110, sequence: MKDEGFYRSAKDWLNQHITVCP, model: calvados2, "
             "conformation: self_avoiding, "
             "velocities: thermal}",
             "box: {periodic: [11.2, 11, 42]}", 42},
        // So many that OpenMM has lists in both Contexts.
        Case{"in_layers",
             "{name: a, count: 120, sequence: GKEKSDESKEKSDEKRSKEDKG, model: calvados2, "
             "conformation: self_avoiding, velocities: thermal}",
             "box: {periodic: [90, 13, 12]}", 90, false, 1, true},
        Case{"open",
             "{name: a, sequence: SEQSEQ, model: calvados2, conformation: self_avoiding, "
             "velocities: thermal}",
             ""}),
    [](auto const& scene) { return scene.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Scenes, OpenMmOnGpus,
    ::testing::Values(
        Case{"periodic",
             "{name: a, count: 5, sequence: SEQ, model: calvados2, conformation: self_avoiding, "
             "velocities: "
             "thermal}, {name: b, sequence: KDEKDE, model: calvados2, velocities: thermal}",
             "box: {periodic: [16, 17, 18]}"},
        Case{"long_box",
             "{name: a, count: 40, sequence: MKDEGFYRSAKDWLNQHITVCP, model: calvados2, "
             "conformation: self_avoiding, "
             "velocities: thermal}",
             "box: {periodic: [90, 13, 12]}", 90, true},
        // Of 32, 32 and 16 beads; so many chains are dealt whole to three ranks.
        Case{"in_pieces",
             "{name: a, count: 48, sequence: SEQMDVFMKGLS, model: calvados2, conformation: "
             "self_avoiding, velocities: "
             "thermal}",
             "box: {periodic: [110, 14, 13]}", 110, true, 16},
        Case{"open",
             "{name: a, sequence: SEQSEQ, model: calvados2, conformation: self_avoiding, "
             "velocities: thermal}",
             ""},
        Case{"held",
             "{name: a, base: fixed, sequence: SEQ, model: calvados2, conformation: self_avoiding, "
             "velocities: "
             "thermal}",
             "box: {periodic: [40, 40, 40]}"}),
    [](auto const& scene) { return scene.param.name; });

/// A rank that has none takes part in what all do.
class RanksWithoutBeads : public OpenMmOnGpus {};
TEST_P(RanksWithoutBeads, TakePart) {
    Found const device = found(scene_with("double", true), 30);
    expect_close(device, found(scene_with("double", false), 30, &device), tolerance("double"));
}
INSTANTIATE_TEST_SUITE_P(
    Scenes, RanksWithoutBeads,
    ::testing::Values(Case{"pair", "{name: a, sequence: KE, model: calvados2, velocities: thermal}",
                           "box: {periodic: [20, 20, 20]}"}),
    [](auto const& scene) { return scene.param.name; });

}  // namespace
}  // namespace catena::test
