// Whole runs with OpenMM's double-precision platform on several ranks: replicated they are the run
// on one rank, bit for bit; with ghosts no pair is missed, and a restart is the uninterrupted run.
#include <fmt/format.h>

#include <cmath>

#include "io/observables_table.hpp"
#include "reader/load_scene.hpp"
#include "tests/run/whole_run.hpp"

namespace catena::test {
namespace {

std::string scene_with(std::string const& box, std::string const& openmm) {
    return "units: md\n"
           "chains: [{name: short, count: 9, sequence: MKDEGFYRSAKD, model: calvados2, "
           "conformation: self_avoiding, velocities: thermal},\n"
           "         {name: long, sequence: MDVFMKGLSKAKEGVVAAAEKTKQGVAEAAGKTKEGVLYVGSKTKEGVVHG, "
           "model: calvados2, conformation: "
           "self_avoiding, velocities: thermal}]\n"
           "box: " +
           box + "\nforces: {openmm: {builder: calvados2, platform: Reference, path: inline, " +
           openmm +
           "}}\n"
           "dynamics: {integrator: g-baoab, step: 0.01, steps: 40, temperature: 300, friction: "
           "0.1, seed: 4}\n"
           "output: {every: 7, checkpoint_every: 10}\n";
}

std::string const boxes[] = {"{periodic: [40, 14, 14]}", "none"};

class OpenMmRuns : public WholeRun {
  protected:
    nlohmann::json run_with(Communicator const& communicator, std::string const& name,
                            std::string const& openmm, std::int64_t steps,
                            std::string const& restart = "",
                            std::vector<std::string> const& overrides = {}) {
        RunOptions options = options_of(name, steps, restart);
        options.own_costs = costs_;
        return run_simulation(
            parse_scene(scene_with(GetParam().text, openmm), "scene.yaml", overrides), communicator,
            options);
    }
    Communicator const& world_ = catena::testing::world();
    MeasureOwnCosts costs_ = measure_own_costs;
};

TEST_P(OpenMmRuns, ReplicatedTheyAreTheRunOnOneRank) {
    run_with(world_, "all", "replicate: true", 20);
    if (world_.rank() == 0) {
        run_with(*serial_communicator(), "one", "replicate: true", 20);
        EXPECT_EQ(arrays("all"), arrays("one"));
    }
    world_.barrier();
}

TEST_P(OpenMmRuns, WithGhostsARestartIsTheUndisturbedRun) {
    run_with(world_, "whole", "audit: true", 40);
    nlohmann::json const half = run_with(world_, "parts", "audit: true", 20);
    run_with(world_, "parts", "audit: true", 40, "parts/checkpoint.h5");
    if (world_.rank() != 0) return;
    EXPECT_EQ(arrays("whole"), arrays("parts"));
    EXPECT_EQ(half.at("parallel").at("messages_a_step").at("ranks_that_differ"), 0);
    if (world_.size() == 1) return;
    auto const& ghosts = half.at("forces").at("ghosts");
    EXPECT_EQ(ghosts.at("evaluations"), 21);
    EXPECT_GE(ghosts.at("rebuilds").get<int>(), 3);  // at the start and at two checkpoints
    EXPECT_LT(ghosts.at("rebuilds").get<int>(), 15);
    EXPECT_EQ(std::ssize(ghosts.at("bytes_a_step")), world_.size());
    std::int64_t own = 0;
    for (auto const& beads : ghosts.at("own_beads")) own += beads.get<std::int64_t>();
    EXPECT_EQ(own, 9 * 12 + 51);
}

/// Chains of RNA stay whole; forces between ranks are those of any other chains.
TEST_P(OpenMmRuns, BranchedChainsOnRanks) {
    std::vector<std::string> const rna{
        "chains[0]={name: rna, count: 5, sequence: ACGUUGCA, model: calvados_rna, conformation: "
        "self_avoiding, velocities: thermal}"};
    run_with(world_, "all", "replicate: true", 20, "", rna);
    if (world_.rank() == 0) {
        run_with(*serial_communicator(), "one", "replicate: true", 20, "", rna);
        EXPECT_EQ(arrays("all"), arrays("one"));
    }
    run_with(world_, "whole", "audit: true", 40, "", rna);
    run_with(world_, "parts", "audit: true", 20, "", rna);
    run_with(world_, "parts", "audit: true", 40, "parts/checkpoint.h5", rna);
    if (world_.rank() == 0) {
        EXPECT_EQ(arrays("whole"), arrays("parts"));
    }
}

/// Where forces round by who owns what, a restart needs the very shares.
TEST_P(OpenMmRuns, WithUnequalSharesARestartIsTheUndisturbedRun) {
    costs_ = [](Scene const&, Axes, Communicator const& ranks, double) {
        return std::vector<OwnCost>{{100, ranks.rank() == 0 ? 3.0 : 1.0}};
    };
    auto const whole = run_with(world_, "whole", "audit: true", 40, "", {"solver.balance=true"});
    run_with(world_, "parts", "audit: true", 20, "", {"solver.balance=true"});
    costs_ = measure_own_costs;  // not asked for
    auto const rest = run_with(world_, "parts", "audit: true", 40, "parts/checkpoint.h5",
                               {"solver.balance=true"});
    if (world_.rank() != 0) return;
    EXPECT_EQ(arrays("whole"), arrays("parts"));
    if (world_.size() == 1) return;
    EXPECT_EQ(rest.at("parallel").at("shares"), whole.at("parallel").at("shares"));
    auto const bodies = whole.at("parallel").at("bodies_of_rank").get<std::vector<std::int64_t>>();
    if (world_.size() == 2) {
        EXPECT_NEAR(static_cast<double>(bodies[0]), (9 * 12 + 51) / 4.0, 12);
    }
}

TEST_P(OpenMmRuns, SharesAreMeasuredByTheChainsAlone) {
    auto const summary =
        run_with(world_, "measured", "audit: true", 3, "", {"solver.balance=true"});
    if (world_.rank() == 0 && world_.size() > 1) {
        EXPECT_EQ(summary.at("parallel").at("shares_from"), "measurement");
    }
}

TEST_P(OpenMmRuns, ARestartOnAnotherPlatformSaysSo) {
    run_with(world_, "parts", "threads: 1", 10);
    auto const same = run_with(world_, "parts", "threads: 1", 20, "parts/checkpoint.h5");
    auto const other = run_with(world_, "parts", "threads: 1", 30, "parts/checkpoint.h5",
                                {"forces.openmm.platform=CPU"});
    if (world_.rank() != 0) return;
    EXPECT_TRUE(same.at("notes").empty()) << same.at("notes");
    ASSERT_EQ(other.at("notes").size(), 1U);
    EXPECT_NE(other["notes"][0].get<std::string>().find(
                  "made on OpenMM's platform Reference, this run continues on CPU"),
              std::string::npos);
}

/// Forces differ by rounding, which 20 steps leave small.
TEST_P(OpenMmRuns, WithGhostsTheyAreTheRunOnOneRankButForRounding) {
    double constexpr growth = 1e4, eps = 0x1p-53;
    run_with(world_, "all", "threads: 1", 20);
    if (world_.rank() == 0) {
        run_with(*serial_communicator(), "one", "threads: 1", 20);
        std::vector<double> const x = arrays("all").at("position"),
                                  expected = arrays("one").at("position");
        ASSERT_EQ(x.size(), expected.size());
        for (std::size_t i = 0; i < x.size(); ++i)
            EXPECT_NEAR(x[i], expected[i], growth * eps * (1 + std::abs(expected[i])));
    }
    world_.barrier();
}

/// Replicas of two chains: a written start and a random one.
class ReplicaRuns : public WholeRun {
  protected:
    static std::string scene(std::string const& start) {
        return "units: md\nreplicas: 12\n"
               "chains: [{name: long, sequence: MDVFMKGLSKAKEGVVAAAEKTKQG, model: calvados2, "
               "conformation: " +
               start +
               ", velocities: thermal}, {name: short, sequence: KDEKDE, model: calvados2, "
               "velocities: thermal}]\n"
               "forces: {openmm: {builder: calvados2, platform: Reference, path: inline, "
               "threads: 1}}\n"
               "dynamics: {integrator: g-baoab, step: 0.01, steps: 40, temperature: 300, "
               "friction: 0.1, seed: 4}\n"
               "output: {every: 5, checkpoint_every: 10}\n";
    }
    nlohmann::json run_with(Communicator const& communicator, std::string const& name,
                            std::int64_t steps, std::string const& restart = "",
                            std::vector<std::string> const& overrides = {},
                            std::string const& start = "self_avoiding") {
        return run_simulation(parse_scene(scene(start), "scene.yaml", overrides), communicator,
                              options_of(name, steps, restart));
    }
    /// Position of bead `bead` of a replica, relative to its first bead.
    Vec3 relative(std::vector<double> const& x, std::size_t replica, std::size_t bead) const {
        std::size_t const first = 3 * beads * replica, at = first + 3 * bead;
        return {{x[at] - x[first], x[at + 1] - x[first + 1], x[at + 2] - x[first + 2]}};
    }
    ObservablesTable table(std::string const& name) const {
        return read_observables(folder_ + "/" + name);
    }
    static constexpr std::size_t beads = 25 + 6, replicas = 12;
    Communicator const& world_ = catena::testing::world();
};

TEST_P(ReplicaRuns, ARestartIsTheUndisturbedRun) {
    run_with(world_, "whole", 40);
    run_with(world_, "parts", 20);
    run_with(world_, "parts", 40, "parts/checkpoint.h5");
    if (world_.rank() != 0) return;
    EXPECT_EQ(arrays("whole"), arrays("parts"));
    EXPECT_EQ(table("whole/replicas.csv").columns, table("parts/replicas.csv").columns);
}

/// Ranks place their replicas elsewhere, which rounds otherwise.
TEST_P(ReplicaRuns, OnRanksTheyAreTheRunOnOneRankButForRounding) {
    auto const summary = run_with(world_, "all", 20);
    if (world_.rank() == 0) {
        EXPECT_EQ(summary.at("parallel").at("messages_a_step").at("ranks_that_differ"), 0);
        run_with(*serial_communicator(), "one", 20);
        std::vector<double> const x = arrays("all").at("position"),
                                  expected = arrays("one").at("position");
        ASSERT_EQ(x.size(), expected.size());
        for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], expected[i], 1e-9);
    }
    world_.barrier();
}

TEST_P(ReplicaRuns, HaveNoiseOfTheirOwn) {
    run_with(world_, "straight", 10, "", {"dynamics.steps=10"}, "extended");
    run_with(world_, "start", 0, "", {}, "extended");
    run_with(world_, "random", 0);
    if (world_.rank() != 0) return;
    std::vector<double> const start = arrays("start").at("position"),
                              end = arrays("straight").at("position"),
                              random = arrays("random").at("position");
    ASSERT_EQ(start.size(), 3 * beads * replicas);
    for (std::size_t r = 1; r < replicas; ++r) {
        EXPECT_LT(norm(relative(start, r, 24) - relative(start, 0, 24)), 1e-12);
        EXPECT_GT(norm(relative(end, r, 24) - relative(end, 0, 24)), 1e-3);
        EXPECT_GT(norm(relative(random, r, 24) - relative(random, 0, 24)), 0.1);
    }
}

TEST_P(ReplicaRuns, HaveATableOfTheirOwn) {
    auto const summary = run_with(world_, "run", 40);
    if (world_.rank() != 0) return;
    ObservablesTable const means = table("run/observables.csv"), each = table("run/replicas.csv");
    ASSERT_EQ(each.names.size(), 2 + 4 * replicas);
    EXPECT_EQ(each.names[2], "radius_of_gyration_long_replica_1 [nm]");
    EXPECT_EQ(each.names.back(), "end_to_end_distance_short_replica_12 [nm]");
    EXPECT_EQ(each.columns[0], means.columns[0]);
    std::size_t const last = means.names.size() - 4;
    EXPECT_EQ(means.names[last], "mean_radius_of_gyration_long [nm]");
    EXPECT_EQ(means.names[last + 1], "mean_radius_of_gyration_short [nm]");
    for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t f = 0; f < means.columns[0].size(); ++f) {
            double mean = 0;
            for (std::size_t r = 0; r < replicas; ++r)
                mean += each.columns[2 + k * replicas + r][f] / replicas;
            EXPECT_NEAR(mean, means.columns[last + k][f], 1e-12);
        }
    auto const& radius = summary.at("observables").at("mean_radius_of_gyration_long");
    EXPECT_EQ(radius.at("replicas"), replicas);
    EXPECT_GT(radius.at("standard_error_between_replicas").get<double>(), 0.001);
    EXPECT_GE(radius.at("standard_error").get<double>(),
              radius.at("standard_error_between_replicas").get<double>());
    EXPECT_EQ(summary.at("system").at("description"),
              "1 chain of 25 beads (long); 1 chain of 6 beads (short); 12 replicas");
}

TEST_P(ReplicaRuns, OneIsTheSceneItself) {
    run_with(world_, "one", 20, "", {"replicas=1"});
    Scene plain = parse_scene(scene("self_avoiding").replace(10, 13, ""), "scene.yaml");
    run_simulation(plain, world_, options_of("plain", 20, ""));
    if (world_.rank() == 0) {
        EXPECT_EQ(arrays("one"), arrays("plain"));
    }
}

INSTANTIATE_TEST_SUITE_P(All, ReplicaRuns, ::testing::Values(RunScene{"replicas", ""}),
                         [](auto const& scene) { return std::string(scene.param.name); });

/// Two chains of bodies in joint coordinates that fly past each other, so fast that lists last nine
/// steps. Frames and checkpoints fall on different steps.
std::string passing_bodies(std::string const& box) {
    auto const chain = [](char const* name, double y, double speed) {
        std::string bodies;
        for (int k = 0; k < 40; ++k) {
            bool const even = k % 2 == 0;
            std::string const joint =
                k == 0
                    ? fmt::format(
                          "type: free, q: {{position: [0, {}, 0]}}, qd: {{velocity: [{}, 0, 0]}}",
                          y, speed)
                    : fmt::format(
                          "type: revolute, axis: [0, 0, 1], translation: [0.38, 0, 0], q: {}",
                          even ? 0.4 : -0.4);
            bodies += fmt::format(
                "{{mass: 100, com: [0.1, 0, 0], inertia: [2, 3, 4], joint: {{{}}}, beads: "
                "[{{residue: {}, position: [0, 0, 0], mass: "
                "100}}]}}, ",
                joint, even ? "LYS" : "GLU");
        }
        return fmt::format("{{name: {}, base: free, bodies: [{}]}}", name, bodies);
    };
    return fmt::format(
        "chains: [{}, {}]\nbox: {}\nforces: {{openmm: {{builder: calvados2, platform: Reference, "
        "path: inline, audit: true}}}}\n"
        "dynamics: {{integrator: velocity-verlet, step: 0.01, steps: 30}}\noutput: {{every: 7, "
        "checkpoint_every: 10}}\n",
        chain("here", 0, 3), chain("there", 2.5, -3), box);
}

class VerletRuns : public WholeRun {};

TEST_P(VerletRuns, WithGhostsARestartIsTheUndisturbedRun) {
    Communicator const& world = catena::testing::world();
    nlohmann::json const whole = run(world, "whole", 30), first = run(world, "parts", 10);
    nlohmann::json const rest = run(world, "parts", 30, "parts/checkpoint.h5");
    if (world.rank() == 0) {
        EXPECT_EQ(arrays("whole"), arrays("parts"));
        EXPECT_EQ(rest.at("parallel").at("messages_a_step").at("ranks_that_differ"), 0);
        auto const lists = [](nlohmann::json const& summary) {
            return summary.at("forces").at("ghosts").at("rebuilds").get<int>();
        };
        if (world.size() > 1) {  // made at the same steps: both parts make those of the checkpoint
            EXPECT_EQ(lists(whole), lists(first) + lists(rest) - 1);
        }
    }
    world.barrier();
}

/// The first state has been evaluated before anything is written.
TEST_P(VerletRuns, FramesEvaluateAnewForEnergiesAlone) {
    Communicator const& world = catena::testing::world();
    auto const run_with = [&](std::string const& name, std::string const& observables) {
        Scene scene = parse_scene(GetParam().text, "scene.yaml",
                                  {"output.observables=[" + observables + "]"});
        return run_simulation(std::move(scene), world, options_of(name, 30, ""));
    };
    nlohmann::json const with = run_with("with", "energy"),
                         without = run_with("without", "radius_of_gyration");
    if (world.rank() == 0) {
        auto const state = [this](std::string const& name) {
            auto all = arrays(name);
            all.erase("verdict_frames");  // energies of frames, which only one of the runs has
            return all;
        };
        EXPECT_EQ(state("with"), state("without"));
        if (world.size() > 1) {  // steps 7, 14, 21, 28 and the last one
            auto const evaluations = [](nlohmann::json const& s) {
                return s.at("forces").at("ghosts").at("evaluations").get<int>();
            };
            EXPECT_EQ(evaluations(with) - evaluations(without), 5);
            EXPECT_GT(evaluations(without), 30);
        }
    }
    world.barrier();
}

RunScene const passing[] = {{"InABox", passing_bodies(boxes[0])},
                            {"InTheOpen", passing_bodies(boxes[1])}};
INSTANTIATE_TEST_SUITE_P(Boxes, VerletRuns, ::testing::ValuesIn(passing),
                         [](auto const& scene) { return scene.param.name; });

RunScene const in_boxes[] = {{"InABox", boxes[0]}, {"InTheOpen", boxes[1]}};
INSTANTIATE_TEST_SUITE_P(Boxes, OpenMmRuns, ::testing::ValuesIn(in_boxes),
                         [](auto const& scene) { return scene.param.name; });

}  // namespace
}  // namespace catena::test
