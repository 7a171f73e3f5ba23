// The GPU's sweeps, run on the host, leave the bits of the host's loops: whatever the blocks'
// sizes, on one rank and several.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "dca/leaf_choice.hpp"
#include "reader/load_scene.hpp"
#include "scene/freedom.hpp"
#include "tests/mpi/world.hpp"
#include "tests/support/compared_solver.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/stage_space.hpp"

namespace catena::test {
namespace {

std::unique_ptr<ChainSolver> make_stage_solver(ChainGroup const& group, Executor const& executor,
                                               Communicator const& communicator) {
    auto const make = [&](auto leaf) -> std::unique_ptr<ChainSolver> {
        return std::make_unique<dca::TreeSolver<typename decltype(leaf)::type, StageSpace>>(
            group, StageSpace(executor), communicator);
    };
    if (group.handles == Handles::articulated) return dca::with_articulated_leaf(group, make);
    return group.beads || group.linked || group.axes == Axes::world
               ? dca::with_absolute_leaf(group, make)
               : dca::with_joint_leaf(group, make);
}

dca::StageRecords records_of(ChainGroup const& group) {
    return group.handles == Handles::articulated
               ? dca::ArticulatedSweeps<dca::ArticulatedLeaf<false>>::in_stage
               : dca::stage_records(group.directions, group.handles == Handles::projected);
}

struct NamedGpu {
    std::string name;
    StagedGpu gpu;
};
char const *const h100 = "an H100", *const turns_groups =
                                        "whose one cluster turns what is above groups";
StagedGpu of_h100(dca::StageRecords const& records) {
    StagedGpu gpu{dca::stage_sizes(records, cuda_on_host::most_shared_bytes, 132)};
    gpu.short_chains = true;
    gpu.ranks_reach_each_other = true;
    return gpu;
}
std::vector<NamedGpu> gpus(dca::StageRecords const& records) {
    auto const with = [](std::int64_t threads, std::int64_t most, std::int64_t together,
                         bool runs_apart) {
        return NamedGpu{"of " + std::to_string(threads) + " threads and " + std::to_string(most) +
                            " items a block, " + std::to_string(together) + " blocks together" +
                            (runs_apart ? ", runs apart" : ""),
                        {{threads, most, together}, runs_apart}};
    };
    NamedGpu small = with(64, 4, 3, true);
    small.name += ", of little shared memory";
    small.gpu.shared_bytes = 40 << 10;  // less than any GPU has
    auto const among_ranks = [](NamedGpu each) {
        each.name += ", ranks together";
        each.gpu.ranks_reach_each_other = true;
        return each;
    };
    NamedGpu turning{turns_groups, of_h100(records)};
    turning.gpu.short_chains = false;
    turning.gpu.lanes_above_groups = true;
    turning.gpu.most_blocks_of_cluster = 2;  // so that a block has several warps
    return {small,
            turning,
            with(32, 2, 0, false),
            among_ranks(with(64, 4, 3, true)),
            among_ranks(with(128, 8, 8, false)),
            with(256, 16, 8, true),
            {"of too few threads", {{128, 32, 4}, false, 32}},
            {h100, of_h100(records)}};
}

class StageKernels : public ::testing::Test {
  protected:
    void SetUp() override { StageSpace::seen = {}; }
    void expect_same(Scene const& scene, Axes axes = Axes::joint) {
        bool const articulated =
            axes == Axes::joint &&
            std::all_of(scene.chains.begin(), scene.chains.end(), scene::takes_articulated_handles);
        std::vector<Handles> kinds{Handles::projected};
        if (alone()) kinds.push_back(Handles::full);
        if (articulated) kinds.push_back(Handles::articulated);
        for (Handles const handles : kinds)
            for (auto const& group : make_groups(scene, axes, handles, false, testing::world())) {
                std::vector<NamedSolver> solvers;
                for (NamedGpu const& each : gpus(records_of(*group))) {
                    if (only_ ? each.name != only_ : each.name == turns_groups) continue;
                    StageSpace::gpu = each.gpu;
                    StageSpace::ranks =
                        each.gpu.ranks_reach_each_other ? &testing::world() : nullptr;
                    solvers.push_back(
                        {each.name, make_stage_solver(*group, *executor_, testing::world())});
                }
                directions_.insert(group->directions);
                auto compared =
                    compared_solver(*group, make_tree_solver(*group, *executor_, testing::world()),
                                    std::move(solvers));
                evaluate_compared(*group, scene, *executor_, testing::world(), std::move(compared),
                                  true);
            }
    }
    static Scene scene_of(std::string const& chains) {
        return parse_scene("chains: [" + chains + "]\nforces: {gravity: [1, 2, -9.81]}",
                           "scene.yaml");
    }
    static Scene scene_of(std::vector<ChainSpec> const& chains) {
        Scene scene;
        for (ChainSpec const& chain : chains) {
            scene.chains.push_back(chain);
            scene.chains.back().name = "chain " + std::to_string(scene.chains.size());
        }
        scene.forces.gravity = {{1, 2, -9.81}};
        return scene;
    }
    /// Several ranks share chains, and what is above; the rest is said once.
    static bool alone() { return testing::world().size() == 1; }
    std::unique_ptr<Executor> executor_ = serial_executor(SimdLevel::off);
    char const* only_ = nullptr;  // of gpus(); else all but those for tests of their own
    std::set<int> directions_;
};

TEST_F(StageKernels, EveryKindAndSize) {
    for (char const* const joint :
         {"link", "planar", "spherical", "universal", "revolute", "prismatic", "helical",
          "cylindrical", "planar3", "weld", "mixed"})
        for (int const bodies :
             alone() ? std::vector<int>{1, 2, 16, 33, 257} : std::vector<int>{2, 257}) {
            SCOPED_TRACE(std::string(joint) + " " + std::to_string(bodies));
            expect_same(scene_of(std::string("{base: ") + (bodies % 2 ? "free" : "fixed") +
                                 ", generator: {random: {bodies: " + std::to_string(bodies) +
                                 ", joint: " + joint + ", seed: 1}}}"));
            if (HasFailure()) return;
        }
    EXPECT_EQ(directions_, (std::set<int>{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(StageSpace::seen.blocks_that_turn_shared.contains(0), !alone());
}
/// Ranks whose last stage but one has several blocks: what they speak of is with one above them.
TEST_F(StageKernels, UnitsOfSeveralBlocks) {
    if (alone()) return;
    only_ = h100;
    for (RandomJoints const joints :
         {RandomJoints::planar, RandomJoints::spherical, RandomJoints::revolute}) {
        StageSpace::seen = {};
        std::size_t const bodies = joints == RandomJoints::revolute ? 20000 : 6000;
        expect_same(
            scene_of({random_chain(4, {.bodies = bodies, .joints = joints, .base = Base::fixed})}));
        ASSERT_FALSE(StageSpace::seen.blocks_that_turn_shared.empty());
        EXPECT_GT(*StageSpace::seen.blocks_that_turn_shared.rbegin(), 1U);
    }
    expect_same(
        scene_of({random_bead_chain(3, 6000, Base::fixed), random_bead_chain(4, 70, Base::free)}));
}

TEST_F(StageKernels, ManyChainsAndTips) {
    std::string const of = "generator: {random: {joint: ",
                      tip = ", seed: 3}}, tip: {joint: {type: spherical}}}";
    expect_same(
        scene_of("{name: a, count: 9, generator: {random: {joint: link, bodies: 70, rigid: 0.3, "
                 "seed: 2}}}, {name: b, base: fixed, " +
                 of + "spherical, bodies: 40" + tip + ", {name: c, base: fixed, " + of +
                 "mixed, bodies: 130" + tip +
                 ", {name: d, base: fixed, tip: {joint: {type: link, anchor: [1, 2, 3]}}, " + of +
                 "link, bodies: 33, seed: 4}}}, " +
                 "{name: e, count: 40, generator: {freely_jointed: {beads: 3, length: 0.38}}}"));
}

TEST_F(StageKernels, LoadsDrivesTipsAndRings) {
    if (!alone()) return;
    using enum JointType;
    std::uint64_t seed = 0;
    for (RandomJoints const joints :
         {RandomJoints::revolute, RandomJoints::spherical, RandomJoints::any, RandomJoints::all})
        for (JointType const type : joints == RandomJoints::all
                                        ? std::vector{planar3}
                                        : std::vector{spherical, weld, helical})
            for (bool const ring : {false, true}) {
                SCOPED_TRACE("seed " + std::to_string(++seed));
                RandomChainOptions options{.bodies = 70,
                                           .joints = joints,
                                           .base = ring ? Base::free : Base::fixed,
                                           .springs = true,
                                           .drag = true,
                                           .driven = 0.2};
                options.tip = type;
                options.ring = ring;
                expect_same(scene_of({random_chain(seed, options)}));
                options.tip = std::nullopt;
                if (!ring)
                    expect_same(
                        scene_of({random_chain(seed, options), random_chain(seed + 100, options)}));
                if (HasFailure()) return;
            }
}

TEST_F(StageKernels, AbsoluteCoordinates) {
    for (char const* const base : {"free", "fixed"})
        for (char const* const tip : {"", ", tip: {joint: {type: spherical}}"})
            expect_same(scene_of(std::string("{base: ") + base +
                                 ", generator: {random: {bodies: 200, joint: spherical, seed: 1}}" +
                                 tip + "}"),
                        Axes::world);
}

TEST_F(StageKernels, LinksWithTipsAndRings) {
    for (Base const base : {Base::fixed, Base::free})
        for (Tip const tip : {Tip::free, Tip::jointed})
            expect_same(scene_of(
                {random_bead_chain(5, 300, base, tip), random_linked_chain(5, 300, base, tip)}));
    expect_same(scene_of({closed(random_bead_chain(6, 170, Base::free)),
                          random_bead_chain(7, 50, Base::fixed),
                          closed(random_linked_chain(8, 90, Base::free)),
                          closed(random_bead_chain(9, 5, Base::free))}));
}

/// Runs of a chain in so many blocks, which turn with one above them.
TEST_F(StageKernels, BlocksThatTurnTogether) {
    if (!alone()) return;
    StageSpace::seen = {};
    for (int blocks = 1; blocks <= 8; ++blocks)
        expect_same(scene_of(
            {random_bead_chain(3, static_cast<std::size_t>(128 * blocks - 5), Base::fixed)}));
    for (unsigned blocks = 2; blocks <= 8; ++blocks)
        EXPECT_TRUE(StageSpace::seen.blocks_that_turn.contains(blocks)) << blocks;
    EXPECT_GE(StageSpace::seen.most_stages, 6U);
    EXPECT_GT(StageSpace::seen.turns_alone, 0);
    EXPECT_GT(StageSpace::seen.runs_apart, 0);
    EXPECT_GT(StageSpace::seen.runs_in_stages, 0);
}

/// One launch by itself up to eight thousand bodies.
TEST_F(StageKernels, ShortChains) {
    if (!alone()) return;
    only_ = h100;
    for (std::size_t const bodies :
         {1, 4, 5, 16, 17, 127, 128, 129, 500, 1024, 2000, 4096, 4097, 8191, 8192, 8193})
        for (Base const base : {Base::fixed, Base::free}) {
            if (bodies > 2000 && (bodies % 2 == 0) == (base == Base::free)) continue;
            SCOPED_TRACE(std::to_string(bodies) + (base == Base::free ? " free" : " fixed"));
            auto const expect_short = [&](ChainSpec const& chain, Axes axes) {
                StageSpace::seen = {};
                expect_same(scene_of({chain}), axes);
                EXPECT_EQ(StageSpace::seen.blocks_of_short_chains.empty(), bodies > 8192);
            };
            expect_short(random_bead_chain(bodies, bodies, base), Axes::joint);
            if (bodies == 4096 || bodies == 4097 || bodies == 8191) continue;
            expect_short(
                random_chain(bodies,
                             {.bodies = bodies, .joints = RandomJoints::spherical, .base = base}),
                Axes::world);
            expect_short(
                random_chain(bodies,
                             {.bodies = bodies, .joints = RandomJoints::spherical, .base = base}),
                Axes::joint);
            if (base == Base::fixed)  // else the first body leaves the plane
                expect_short(
                    random_chain(bodies,
                                 {.bodies = bodies, .joints = RandomJoints::planar, .base = base}),
                    Axes::joint);
            if (HasFailure()) return;
        }
}

/// By a thread each or by a team; whose joints are not all revolute joints go the other way.
TEST_F(StageKernels, RunsOnRevolutes) {
    if (!alone()) return;
    for (std::size_t const bodies : {2, 17, 19, 45, 128, 511})
        for (Base const base : {Base::fixed, Base::free}) {
            SCOPED_TRACE(std::to_string(bodies) + (base == Base::free ? " free" : " fixed"));
            auto const chain = [&](RandomJoints joints, std::size_t n) {
                return random_chain(n, {.bodies = n, .joints = joints, .base = base});
            };
            expect_same(scene_of({chain(RandomJoints::revolute, bodies)}));
            if (bodies > 100 && base == Base::free) continue;
            expect_same(
                scene_of({chain(RandomJoints::revolute, bodies), chain(RandomJoints::universal, 20),
                          chain(RandomJoints::revolute, 64)}));
        }
    std::vector<ChainSpec> short_ones;  // with runs of every length side by side
    for (std::size_t bodies = 1; bodies <= 40; ++bodies)
        short_ones.push_back(random_chain(
            bodies,
            {.bodies = 7 * bodies % 41, .joints = RandomJoints::revolute, .base = Base::free}));
    expect_same(scene_of(short_ones));
    EXPECT_GT(StageSpace::seen.whole_runs_by_teams, 0);
    EXPECT_GT(StageSpace::seen.whole_runs_by_threads, 0);
}
/// More than a block of stages that lanes of a warp climb together has: the first one is narrow
/// then, and keeps its nodes for the way down.
TEST_F(StageKernels, ManyRunsOnRevolutes) {
    if (!alone()) return;
    only_ = h100;
    expect_same(scene_of({random_chain(
        5, {.bodies = 9000, .joints = RandomJoints::revolute, .base = Base::fixed})}));
    EXPECT_GT(StageSpace::seen.most_stages, 1U);
}

/// What quick quotients and roots leave to others.
TEST_F(StageKernels, ShortChainsThatAreNotQuick) {
    if (!alone()) return;
    only_ = h100;
    auto const expect_short = [&](ChainSpec const& chain) {
        StageSpace::seen = {};
        expect_same(scene_of({chain}));
        EXPECT_FALSE(StageSpace::seen.blocks_of_short_chains.empty());
    };
    for (std::size_t const beads : {300, 6000})
        for (std::size_t const bead : {100, 127, 128, 256}) {  // in a part, and where warps meet
            ChainSpec light = random_bead_chain(1, beads, Base::fixed);
            light.beads.mass[bead] = -1e-3;  // no positive definite matrices there
            expect_short(light);
        }
    ChainSpec falling =
        random_bead_chain(3, 301, Base::free);  // biases are zero, some of them less than that
    falling.beads.velocity.assign(falling.beads.size(), {{-1, 0, 0}});
    expect_short(falling);
    ChainSpec tiny = random_bead_chain(2, 300, Base::fixed);
    BeadArrays& b = tiny.beads;
    Vec3 const origin = b.position[100];
    b.anchor = b.anchor - origin;
    for (Vec3& position : b.position) position = position - origin;
    b.position[101] = {{1e-160, 0, 0}};  // whose square has a few digits
    b.length[101] = 1e-160;
    b.length[102] = norm(b.position[102]);
    expect_short(tiny);
}

/// Joints are found whose matrices are not positive definite, wherever they meet and whoever merges
/// them.
TEST_F(StageKernels, MatricesThatAreNotPositiveDefinite) {
    if (!alone()) return;
    for (RandomJoints const joints : {RandomJoints::spherical, RandomJoints::universal,
                                      RandomJoints::revolute, RandomJoints::any})
        for (std::size_t const body : {31, 32, 100, 128, 290}) {  // the last run has 12 bodies
            SCOPED_TRACE("body " + std::to_string(body));
            ChainSpec chain =
                random_chain(9, {.bodies = 300, .joints = joints, .base = Base::fixed});
            chain.bodies.mass[body] = -1e-3;
            expect_same(scene_of({chain}));
        }
}

/// The lowest five levels by the warps that have the runs, and all above them in one launch of one
/// cluster.
TEST_F(StageKernels, GroupsOfOneChain) {
    if (!alone()) return;
    only_ = turns_groups;
    auto const expect_blocks = [&](std::set<unsigned> const& blocks, ChainSpec const& chain) {
        SCOPED_TRACE(chain.beads.size());
        StageSpace::seen = {};
        expect_same(scene_of({chain}));
        EXPECT_EQ(StageSpace::seen.blocks_above_groups, blocks);
    };
    for (std::size_t const bodies : {257, 513, 1024, 5000, 16385})
        for (Base const base : {Base::fixed, Base::free}) {
            if (bodies > 1024 && base == Base::free) continue;
            expect_blocks({bodies > 16384 ? 2U : 1U}, random_bead_chain(bodies, bodies, base));
            if (HasFailure()) return;
        }
    expect_blocks({1}, random_linked_chain(5, 1300, Base::fixed));
    expect_blocks({}, random_bead_chain(5, 1300, Base::fixed, Tip::jointed));
    for (std::size_t const bead :
         {272, 512, 1024, 16384}) {  // within a group, and where groups and warps meet
        ChainSpec light = random_bead_chain(1, bead < 10000 ? 1500 : 17000, Base::fixed);
        light.beads.mass[bead] = -1e-3;  // no positive definite matrix there
        expect_blocks({bead < 10000 ? 1U : 2U}, light);
    }
}
/// So many that launches of their own do them.
TEST_F(StageKernels, VeryManyRuns) {
    if (!alone()) return;
    only_ = h100;
    expect_same(
        scene_of("{count: 8500, generator: {freely_jointed: {beads: 17, length: 0.38}}}, "
                 "{base: fixed, generator: {random: {bodies: 3000, joint: link, seed: 3}}}"));
    EXPECT_EQ(StageSpace::seen.runs_in_stages, 0);
}

}  // namespace
}  // namespace catena::test
