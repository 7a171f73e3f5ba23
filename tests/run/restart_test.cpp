// A run that is stopped and restarted is the uninterrupted run, bit for bit: state, trajectory and
// table.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <system_error>
#include <thread>

#include "error.hpp"
#include "frames/trajectory_file.hpp"
#include "io/output.hpp"
#include "reader/load_scene.hpp"
#include "run/simulation.hpp"
#include "tests/integrate/scenes.hpp"
#include "tests/io/dataset_bits.hpp"
#include "tests/io/small_disk.hpp"
#include "tests/io/temporary_folder.hpp"
#include "tests/run/no_more_threads.hpp"

namespace catena::test {
namespace {

std::string text_of(std::string const& file) {
    std::ifstream in(file);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

class Restart : public testing::TestWithParam<RunScene> {
  protected:
    nlohmann::json run(std::string const& output, std::int64_t steps,
                       std::string const& restart = "", StopAgreement::Wish stop = {}) {
        return run({}, output, steps, restart, std::move(stop));
    }
    nlohmann::json run(RunOptions options, std::string const& output, std::int64_t steps,
                       std::string const& restart = "", StopAgreement::Wish stop = {}) {
        options.output = folder_ / output;
        options.steps = steps;
        options.restart = restart;
        options.quiet = true;
        options.stop = std::move(stop);
        return run_simulation(parse_scene(GetParam().text, "scene.yaml"), *communicator_, options);
    }
    TemporaryFolder folder_;
    std::unique_ptr<Communicator> communicator_ = serial_communicator();
};

TEST_P(Restart, IsTheUndisturbedRun) {
    EXPECT_TRUE(run("whole", 40)["valid"].get<bool>());
    run("parts", 20);
    EXPECT_TRUE(run("parts", 40, folder_ / "parts/checkpoint.h5")["valid"].get<bool>());
    Checkpoint const whole = read_checkpoint(folder_ / "whole/checkpoint.h5"),
                     parts = read_checkpoint(folder_ / "parts/checkpoint.h5");
    EXPECT_EQ(whole.step, 40);
    EXPECT_EQ(parts.step, 40);
    EXPECT_EQ(whole.integers, parts.integers);
    ASSERT_FALSE(whole.arrays.empty());
    EXPECT_EQ(
        whole.arrays,
        parts.arrays);  // doubles compared by value: equal means equal bits but for zeros' signs
    EXPECT_EQ(text_of(folder_ / "whole/observables.csv"),
              text_of(folder_ / "parts/observables.csv"));
    EXPECT_EQ(text_of(folder_ / "whole/trajectory.h5md").size(),
              text_of(folder_ / "parts/trajectory.h5md").size());
}

TEST_P(Restart, WithFramesBesideTheSteps) {
    auto const beside = [] {
        RunOptions options;
        options.bodies_beside = 1;
        options.topology_beside = true;
        return options;
    };
    auto const beside_steps = [](nlohmann::json const& summary) {
        return summary["parallel"]["frames_beside_steps"].get<int>();
    };
    EXPECT_EQ(beside_steps(run("one-after-the-other", 20)), 0);
    EXPECT_GT(beside_steps(run(beside(), "beside", 10)), 0);
    EXPECT_GT(beside_steps(run(beside(), "beside", 20, folder_ / "beside/checkpoint.h5")), 0);
    {
        NoMoreThreads const none;
        EXPECT_THROW(std::thread([] {}).join(), std::system_error);
        EXPECT_EQ(beside_steps(run(beside(), "no-thread", 20)), 0);
    }
    for (char const* const name : {"beside", "no-thread"}) {
        EXPECT_EQ(read_checkpoint(folder_ / (std::string(name) + "/checkpoint.h5")).arrays,
                  read_checkpoint(folder_ / "one-after-the-other/checkpoint.h5").arrays)
            << name;
        EXPECT_EQ(text_of(folder_ / (std::string(name) + "/observables.csv")),
                  text_of(folder_ / "one-after-the-other/observables.csv"))
            << name;
        EXPECT_EQ(text_of(folder_ / (std::string(name) + "/topology.pdb")),
                  text_of(folder_ / "one-after-the-other/topology.pdb"))
            << name;
        EXPECT_EQ(bits_of(folder_ / (std::string(name) + "/trajectory.h5md")),
                  bits_of(folder_ / "one-after-the-other/trajectory.h5md"))
            << name;
    }
}

TEST_P(Restart, ATopologyThatCannotBeWrittenEndsTheRun) {
    for (bool const beside : {false, true}) {
        std::string const output = beside ? "beside" : "before", made = folder_ / output;
        std::filesystem::create_directories(made + "/topology.pdb/in-the-way");
        RunOptions options;
        options.overwrite = true;
        options.bodies_beside = 1;
        options.topology_beside = beside;
        try {
            run(options, output, 1000);
            ADD_FAILURE() << output;
        } catch (ComputationError const& error) {
            EXPECT_NE(std::string(error.what()).find("topology.pdb"), std::string::npos)
                << error.what();
        }
        EXPECT_FALSE(std::filesystem::exists(made + "/topology.pdb.writing")) << output;
        EXPECT_FALSE(std::filesystem::exists(made + "/checkpoint.h5")) << output;
    }
}

TEST_P(Restart, FromTheCheckpointBefore) {
    run("whole", 40);
    run("parts", 20);  // leaves checkpoints at 20 and, before it, 10
    run("parts", 40, folder_ / "parts/checkpoint.previous.h5");
    EXPECT_EQ(read_checkpoint(folder_ / "whole/checkpoint.h5").arrays,
              read_checkpoint(folder_ / "parts/checkpoint.h5").arrays);
    EXPECT_EQ(text_of(folder_ / "whole/observables.csv"),
              text_of(folder_ / "parts/observables.csv"));
}

TEST_P(Restart, WhereItWasAskedToStop) {
    run("whole", 40);
    int looks = 0;
    auto const stopped = run("parts", 40, "", [&] { return ++looks == 4 ? 15 : 0; });
    EXPECT_EQ(stopped["run"]["stopped_by"], 15);
    EXPECT_EQ(stopped["run"]["steps"], 40);
    auto const step = stopped["run"]["last_step"].get<std::int64_t>();
    EXPECT_GT(step, 0);
    EXPECT_LT(step, 40);
    EXPECT_EQ(read_checkpoint(folder_ / "parts/checkpoint.h5").step, step);
    run("parts", 40, folder_ / "parts/checkpoint.h5");
    Checkpoint const whole = read_checkpoint(folder_ / "whole/checkpoint.h5"),
                     parts = read_checkpoint(folder_ / "parts/checkpoint.h5");
    EXPECT_EQ(whole.integers, parts.integers);
    EXPECT_EQ(whole.arrays, parts.arrays);
    EXPECT_EQ(text_of(folder_ / "whole/observables.csv"),
              text_of(folder_ / "parts/observables.csv"));
}

TEST_P(Restart, FromTheStart) {
    run("whole", 10);
    run("parts", 0);
    run("parts", 10, folder_ / "parts/checkpoint.h5");
    EXPECT_EQ(read_checkpoint(folder_ / "whole/checkpoint.h5").arrays,
              read_checkpoint(folder_ / "parts/checkpoint.h5").arrays);
    EXPECT_EQ(text_of(folder_ / "whole/observables.csv"),
              text_of(folder_ / "parts/observables.csv"));
}

TEST_P(Restart, RefusesAnotherScene) {
    run("parts", 5);
    RunOptions options;
    options.output = folder_ / "parts";
    options.restart = folder_ / "parts/checkpoint.h5";
    options.quiet = true;
    Scene const other = parse_scene(GetParam().text, "scene.yaml", {"dynamics.step=0.0005"});
    std::string const message = message_of([&] { run_simulation(other, *communicator_, options); });
    EXPECT_NE(message.find("belongs to another scene"), std::string::npos) << message;
}

TEST_P(Restart, RefusesAnExistingFolder) {
    run("parts", 20);
    for (std::string const file : {"checkpoint.h5", "checkpoint.previous.h5"}) {
        std::string const newest = folder_ / "parts/" + file;
        std::string const message = message_of([&] { run("parts", 5); });
        EXPECT_NE(message.find("the output folder exists"), std::string::npos) << message;
        EXPECT_NE(message.find("continue with --restart " + newest), std::string::npos) << message;
        EXPECT_NE(message.find("--overwrite"), std::string::npos) << message;
        std::filesystem::remove(newest);
    }
    EXPECT_EQ(message_of([&] { run("parts", 5); }).find("--restart"), std::string::npos);
}

/// A chain with many frames, whose run fills a small disk.
std::string message_of_full_disk(std::string const& output, std::string const& more) {
    Scene const scene = parse_scene(
        "chains: [{base: free, generator: {freely_jointed: {beads: 60, length: 0.38}}}]\n"
        "dynamics: {integrator: rattle, step: 0.001, steps: 5000}\noutput: {every: 1" +
            more + "}\n",
        "scene.yaml");
    RunOptions options;
    options.output = output;
    options.quiet = true;
    return message_of([&] { run_simulation(scene, *serial_communicator(), options); });
}

TEST(FullDisk, SaysWhatIsKeptAndHowToGoOn) {
    SmallDisk const disk;
    NEEDS_SMALL_DISK(disk);
    std::string const first = message_of_full_disk(disk / "a", "");
    EXPECT_TRUE(first.ends_with(
        "No space left on device: no checkpoint was written yet; correct this and run it again "
        "with --overwrite"))
        << first;
    std::filesystem::remove_all(disk / "a");
    SmallDisk const larger(1500);
    std::string const later = message_of_full_disk(larger / "b", ", checkpoint_every: 10");
    EXPECT_TRUE(later.ends_with(
        "No space left on device: the last checkpoint and the frames up to it are whole; correct "
        "this and continue with --restart " +
        (larger / "b/checkpoint.h5")))
        << later;
    EXPECT_GT(read_checkpoint(larger / "b/checkpoint.h5").step, 0);
}

/// Runs of a star of 3 arms on a checkpoint of another scene.
class OtherScenes : public testing::Test {
  protected:
    void SetUp() override { run({}, "parts"); }
    std::string refusal(std::vector<std::string> const& overrides, bool branch = false) {
        return message_of([&] {
            run(overrides, branch ? "branch" : "parts", folder_ / "parts/checkpoint.h5", branch);
        });
    }
    std::string refused(std::string const& what, std::string const& remedy) {
        return what + " (" + (folder_ / "parts/checkpoint.h5") + "): " + remedy;
    }
    void run(std::vector<std::string> const& overrides, std::string const& output,
             std::string const& restart = "", bool branch = false) {
        RunOptions options;
        options.output = folder_ / output;
        options.restart = restart;
        options.branch = branch;
        options.quiet = true;
        run_simulation(parse_scene(text, "scene.yaml", overrides), *serial_communicator(), options);
    }
    static constexpr char const* text =
        "replicas: 2\n"
        "chains: [{name: s, generator: {star: {arms: 3, arm_length: 2, length: 1, seed: 1}}}]\n"
        "dynamics: {integrator: g-baoab, step: 0.001, steps: 4, temperature: 300, friction: 1}\n";
    std::string const other_ = "the checkpoint belongs to another scene: ",
                      own_ =
                          "restart with its own scene (solver, number of steps and output "
                          "intervals may differ), or ",
                      kept_ = "a branch keeps its chains, replicas and units: ";
    TemporaryFolder folder_;
};

/// In the trajectory replicas have the numbers of their names.
TEST_F(OtherScenes, ReplicasAreCountedFromOne) {
    DatasetBits const bits = bits_of(folder_ / "parts/trajectory.h5md");
    std::vector<char> const& replica = bits.at("catena/chains/replica");
    std::vector<std::int64_t> numbers(2);
    ASSERT_EQ(replica.size(), numbers.size() * sizeof(std::int64_t));
    std::memcpy(numbers.data(), replica.data(), replica.size());
    EXPECT_EQ(numbers, (std::vector<std::int64_t>{1, 2}));
    EXPECT_EQ(TrajectoryFile(folder_ / "parts/trajectory.h5md").topology().chains[1].replica, 1);
}

TEST_F(OtherScenes, AreToldApartWithoutFingerprints) {
    EXPECT_EQ(refusal({"dynamics.step=0.002", "chains[0].generator.star.arm_length=3"}),
              refused(other_ + "chain `s-1` has another name, or other bodies, links or joints",
                      own_ + "start this scene anew"));
    EXPECT_EQ(refusal({"replicas=1"}),
              refused(other_ + "replicas was 2, now it is 1", own_ + "start this scene anew"));
    EXPECT_EQ(refusal({"dynamics.step=0.002"}),
              refused(other_ + "dynamics.step was 0.001, now it is 0.002",
                      own_ + "branch off with --branch --output OTHER"));
}

TEST_F(OtherScenes, AreRefusedForABranchAsTheRestartSaid) {
    EXPECT_EQ(refusal({"replicas=3"}, true),
              refused(kept_ + "replicas was 2, now it is 3", "start this scene anew"));
    EXPECT_EQ(refusal({"chains[0].generator.star.arms=4"}, true),
              refused(kept_ + "chain `s-1` has another name, or other bodies, links or joints",
                      "start this scene anew"));
}

/// --overwrite does not go with --restart: neither advises the other.
TEST_F(OtherScenes, ABranchIntoAnExistingFolderIsToldToTakeAnother) {
    run({}, "branch");
    EXPECT_EQ(refusal({"dynamics.step=0.002"}, true), "the output folder exists (" +
                                                          (folder_ / "branch") +
                                                          "): name another folder with --output");
}

using FromRest = Restart;

TEST_P(FromRest, TakesAwayTheDraftsOfAKilledRun) {
    run("parts", 20);
    std::string const drafts[] = {folder_ / "parts/checkpoint.h5.writing",
                                  folder_ / "parts/checkpoint.previous.h5.writing"};
    for (std::string const& draft : drafts) std::ofstream(draft) << "half";
    EXPECT_NE(message_of([&] { run("parts", 5); }).find("the output folder exists"),
              std::string::npos);
    for (std::string const& draft : drafts)
        EXPECT_TRUE(std::filesystem::exists(draft)) << draft << " of a folder that was refused";
    run("parts", 20, folder_ / "parts/checkpoint.h5");
    for (std::string const& draft : drafts) EXPECT_FALSE(std::filesystem::exists(draft)) << draft;
}

/// What starts at rest gains speed, and sweeps, at steps that nothing but the look at 1, 2, 4, ...
/// falls on.
RunScene const from_rest{
    "from_rest",
    "units: si\nforces: {gravity: [0, 0, -9.81]}\n"
    "chains:\n  - base: fixed\n    anchor: [0, 0, 2]\n    bodies:\n"
    "      - {mass: 0.1, position: [0.3, 0, 1.7], joint: {type: link}}\n"
    "      - {mass: 0.1, position: [0.7, 0, 1.5], joint: {type: link}}\n"
    "      - {mass: 0.1, position: [1.1, 0.1, 1.4], joint: {type: link}}\n"
    "      - {mass: 0.1, position: [1.5, 0, 1.5], joint: {type: link}}\n"
    "dynamics: {integrator: rattle, step: 1e-3, steps: 20}\noutput: {every: 1000}\n"};
TEST_P(FromRest, SweepsAreAddedAsInTheUndisturbedRun) {
    auto const sweeps = [](nlohmann::json const& summary) {
        return summary["solver"]["sweeps_a_drift"].get<int>();
    };
    int const at_start = sweeps(run("start", 0)), at_end = sweeps(run("whole", 40));
    EXPECT_GT(at_end, at_start);
    for (int const stop : {4, 5, 8, 16}) {
        std::string const name = "parts-" + std::to_string(stop);
        run(name, stop);
        EXPECT_EQ(sweeps(run(name, 40, folder_ / (name + "/checkpoint.h5"))), at_end) << stop;
        EXPECT_EQ(read_checkpoint(folder_ / (name + "/checkpoint.h5")).arrays,
                  read_checkpoint(folder_ / "whole/checkpoint.h5").arrays)
            << stop;
    }
}

INSTANTIATE_TEST_SUITE_P(Integrators, FromRest, testing::Values(from_rest),
                         [](auto const& scene) { return scene.param.name; });
/// Whatever a thermostat does to what starts at rest.
RunScene const heated{"heated",
                      "chains: [{base: free, velocities: zero, count: 3, generator: "
                      "{freely_jointed: {beads: 60, length: 0.38}}}]\n"
                      "dynamics: {integrator: g-baoab, step: 0.01, steps: 200, temperature: 300, "
                      "friction: 10}\noutput: {every: 200}\n"};
using Heated = Restart;

TEST_P(Heated, JointsStayClosed) {
    nlohmann::json const summary = run("run", 200);
    EXPECT_TRUE(summary["valid"].get<bool>());
    EXPECT_GT(summary["last_observables"]["temperature [K]"].get<double>(), 200);
}

INSTANTIATE_TEST_SUITE_P(Integrators, Heated, testing::Values(heated),
                         [](auto const& scene) { return scene.param.name; });
INSTANTIATE_TEST_SUITE_P(Integrators, Restart, testing::ValuesIn(run_scenes),
                         [](auto const& scene) { return scene.param.name; });

}  // namespace
}  // namespace catena::test
