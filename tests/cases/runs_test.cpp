// What users ask of a run: its first and last frames, orientations and joint coordinates, branches
// from checkpoints, restarts that have lost files, masses, and files that may not be had.
#include <hdf5.h>
#include <sys/stat.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "io/output.hpp"
#include "tests/command/program.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

namespace fs = std::filesystem;

std::string scene_of(std::string const& name) {
    return std::string(CATENA_SOURCE_DIR) + "/tests/data/cases/" + name + "/scene.yaml";
}

std::string text_of(std::string const& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

/// Columns by name, of observables.csv.
std::map<std::string, std::vector<double>> table_of(std::string const& folder) {
    std::ifstream in(folder + "/observables.csv");
    std::vector<std::string> names;
    std::map<std::string, std::vector<double>> table;
    for (std::string line, cell; std::getline(in, line);) {
        std::istringstream cells(line);
        bool const head = names.empty();
        for (std::size_t i = 0; std::getline(cells, cell, ',');)
            if (head)
                names.push_back(cell);
            else
                table[names.at(i++)].push_back(std::stod(cell));
    }
    return table;
}

/// A dataset's numbers, and its extents.
struct Numbers {
    std::vector<hsize_t> shape;
    std::vector<double> values;
    double at(hsize_t frame, hsize_t i) const {
        return values.at(frame * (values.size() / shape.at(0)) + i);
    }
};
Numbers numbers_of(std::string const& file, std::string const& name) {
    Numbers found;
    hid_t const opened = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT),
                data = H5Lexists(opened, name.substr(0, name.find_last_of('/')).c_str(),
                                 H5P_DEFAULT) > 0
                           ? H5Dopen2(opened, name.c_str(), H5P_DEFAULT)
                           : H5I_INVALID_HID;
    if (data >= 0) {
        hid_t const space = H5Dget_space(data);
        found.shape.resize(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
        H5Sget_simple_extent_dims(space, found.shape.data(), nullptr);
        found.values.resize(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
        H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, found.values.data());
        H5Sclose(space);
        H5Dclose(data);
    }
    H5Fclose(opened);
    return found;
}
std::vector<double> steps_of(std::string const& folder) {
    return numbers_of(folder + "/trajectory.h5md", "particles/trajectory/position/step").values;
}
nlohmann::json summary_of(std::string const& folder) {
    return nlohmann::json::parse(std::ifstream(folder + "/summary.json"));
}

class Runs : public ::testing::Test {
  protected:
    Ended run(std::string const& name, Words const& more) const {
        Words words{"run", scene_of(name), "--quiet"};
        words.insert(words.end(), more.begin(), more.end());
        return catena(words, folder_.path());
    }
    std::string at(std::string const& name) const { return folder_ / name; }
    TemporaryFolder folder_;
};

TEST_F(Runs, TheLastStateIsAFrameWhereTheRunIsShorterThanOutputEvery) {
    expect_good(run("23-frames", {"--output", "o"}));
    EXPECT_EQ(steps_of(at("o")), (std::vector<double>{0, 100}));
    EXPECT_EQ(table_of(at("o")).at("step"), (std::vector<double>{0, 100}));
    EXPECT_NE(
        summary_of(at("o")).at("notes").dump().find("output.every = 5000 exceeds the 100 steps"),
        std::string::npos);
}

TEST_F(Runs, CheckSaysThatFramesAreFewerThanTheStepsAskFor) {
    Ended const checked = catena({"check", scene_of("23-frames"), "--json", "-"});
    expect_good(checked);
    EXPECT_NE(
        checked.json().at("notes").dump().find("output.every = 5000 exceeds dynamics.steps = 100"),
        std::string::npos);
}

TEST_F(Runs, NoStepsAreOneFrameWithEnergies) {
    for (Words const& none : {Words{"--steps", "0"}, Words{"--set", "dynamics.steps=0"}}) {
        Words words = none;
        words.insert(words.end(), {"--output", none[0] == "--steps" ? "option" : "key"});
        expect_good(run("23-frames", words));
        EXPECT_EQ(steps_of(at(words.back())), (std::vector<double>{0}));
        EXPECT_EQ(table_of(at(words.back())).count("yukawa_energy [kJ/mol]"), 1U);
        EXPECT_EQ(summary_of(at(words.back())).at("valid"), true);
    }
    expect_refused(run("23-frames", {"--set", "dynamics.steps=null", "--output", "o"}), 2,
                   "no steps to run");
}

/// The frame at an interrupted run's end is none of the uninterrupted run's, and goes when it is
/// continued.
TEST_F(Runs, ARestartTakesAwayTheFrameWhereTheRunBeforeEnded) {
    expect_good(
        run("restart-branch", {"--set", "output.every=30", "--steps", "100", "--output", "whole"}));
    expect_good(
        run("restart-branch", {"--set", "output.every=30", "--steps", "50", "--output", "parts"}));
    EXPECT_EQ(steps_of(at("parts")), (std::vector<double>{0, 30, 50}));
    expect_good(
        run("restart-branch", {"--set", "output.every=30", "--restart", "parts/checkpoint.h5"}));
    EXPECT_EQ(steps_of(at("parts")), (std::vector<double>{0, 30, 60, 90, 100}));
    EXPECT_EQ(text_of(at("parts/observables.csv")), text_of(at("whole/observables.csv")));
    EXPECT_EQ(
        numbers_of(at("parts/trajectory.h5md"), "particles/trajectory/position/value").values,
        numbers_of(at("whole/trajectory.h5md"), "particles/trajectory/position/value").values);
}

/// Of the run before, which wrote more often.
TEST_F(Runs, ARestartThatWritesLessOftenKeepsTheFrameOfTheCheckpoint) {
    expect_good(
        run("restart-branch", {"--set", "output.every=10", "--steps", "40", "--output", "o"}));
    Words const less{"--set", "output.every=30", "--restart", "o/checkpoint.h5", "--steps"};
    for (auto const& [steps, frames] : {std::pair{"40", std::vector<double>{0, 10, 20, 30, 40}},
                                        {"70", {0, 10, 20, 30, 40, 60, 70}}}) {
        Words words = less;
        words.emplace_back(steps);
        expect_good(run("restart-branch", words));
        EXPECT_EQ(steps_of(at("o")), frames);
        EXPECT_EQ(table_of(at("o")).at("step"), frames);
    }
}

TEST_F(Runs, TheFirstFrameOutlivesAKill) {
    std::string const run = program() + " run " + scene_of("23-frames") +
                            " --steps 100000000 --set output.every=50000000 --output killed";
    run_program({"sh", "-c", run + " > killed.log 2>&1 & p=$!; sleep 3; kill -9 $p; wait $p"},
                folder_.path());
    EXPECT_EQ(steps_of(at("killed")), (std::vector<double>{0}));
}

/// A body of 2 kg, centre of mass c = (0.3, 0.1, 0), inertia diag(0.1, 0.2, 0.25) about it, on a
/// ball joint with springs K on the rotation vector p from rest: I dw/dt = -Jr^-T K p + c x m R^T g
/// - w x I w about the joint, dq/dt = q w / 2 (quaternion w x y z, w in body axes). Integrated here
/// by the classical Runge-Kutta scheme in steps of 1e-4, whose error is below 1e-11.
struct SprungBody {
    using State = std::array<double, 7>;
    static State rates(State const& s) {
        double const* const q = s.data();
        std::array<double, 3> const w{s[4], s[5], s[6]}, c{0.3, 0.1, 0}, spring{40, 25, 10};
        constexpr double m = 2, g = -9.81;
        // Third row of R, on which gravity pulls: R^T (0, 0, g).
        std::array<double, 3> const down{2 * (q[1] * q[3] - q[0] * q[2]) * m * g,
                                         2 * (q[2] * q[3] + q[0] * q[1]) * m * g,
                                         (1 - 2 * (q[1] * q[1] + q[2] * q[2])) * m * g};
        double const sine = std::sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3]),
                     angle = 2 * std::atan2(sine, q[0]);
        std::array<double, 3> p{}, pull{}, torque{};
        for (std::size_t i = 0; i < 3; ++i)
            p[i] = angle * q[i + 1] / sine, pull[i] = spring[i] * p[i];
        auto const cross = [](auto const& a, auto const& b) {
            return std::array<double, 3>{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                                         a[0] * b[1] - a[1] * b[0]};
        };
        // dp/dt = Jr^-1 w, Jr^-1 = 1 + P / 2 + k P P: its transpose has -P / 2.
        double const k =
            1 / (angle * angle) - (1 + std::cos(angle)) / (2 * angle * std::sin(angle));
        auto const once = cross(p, pull), twice = cross(p, once), weight = cross(c, down);
        // I about the joint: I_c + m (c c - c x c x).
        double const xx = 0.1 + m * 0.01, yy = 0.2 + m * 0.09, zz = 0.25 + m * 0.1, xy = -m * 0.03;
        std::array<double, 3> const spin{xx * w[0] + xy * w[1], xy * w[0] + yy * w[1], zz * w[2]};
        auto const gyro = cross(w, spin);
        for (std::size_t i = 0; i < 3; ++i)
            torque[i] = -(pull[i] - 0.5 * once[i] + k * twice[i]) + weight[i] - gyro[i];
        double const det = xx * yy - xy * xy;
        return {0.5 * (-q[1] * w[0] - q[2] * w[1] - q[3] * w[2]),
                0.5 * (q[0] * w[0] + q[2] * w[2] - q[3] * w[1]),
                0.5 * (q[0] * w[1] - q[1] * w[2] + q[3] * w[0]),
                0.5 * (q[0] * w[2] + q[1] * w[1] - q[2] * w[0]),
                (yy * torque[0] - xy * torque[1]) / det,
                (xx * torque[1] - xy * torque[0]) / det,
                torque[2] / zz};
    }
    static State step(State const& s, double h) {
        auto const moved = [&](State const& by, double length) {
            State to = s;
            for (std::size_t i = 0; i < to.size(); ++i) to[i] += length * by[i];
            return to;
        };
        State const a = rates(s), b = rates(moved(a, h / 2)), c = rates(moved(b, h / 2)),
                    d = rates(moved(c, h));
        State to = s;
        for (std::size_t i = 0; i < to.size(); ++i)
            to[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
        return to;
    }
};

void expect_body_moves_as_derived(std::string const& file) {
    Numbers const orientation = numbers_of(file, "catena/orientation/value"),
                  joint = numbers_of(file, "catena/joint_position/value"),
                  rate = numbers_of(file, "catena/joint_rate/value"),
                  omega = numbers_of(file, "catena/angular_velocity/value");
    ASSERT_EQ(orientation.shape, (std::vector<hsize_t>{201, 1, 4}));
    ASSERT_EQ(joint.shape, (std::vector<hsize_t>{201, 1, 4}));
    ASSERT_EQ(rate.shape, (std::vector<hsize_t>{201, 1, 3}));
    ASSERT_EQ(omega.shape, (std::vector<hsize_t>{201, 1, 3}));
    SprungBody::State s{0.5, 0.5, 0.5, 0.5, 1, 0.5, -0.7};
    for (hsize_t frame = 0; frame <= 200; ++frame) {
        double const sign = orientation.at(frame, 0) * s[0] + orientation.at(frame, 1) * s[1] < 0
                                ? -1
                                : 1;  // q and -q turn alike
        for (hsize_t i = 0; i < 4; ++i) {
            ASSERT_NEAR(sign * orientation.at(frame, i), s[i], 1e-8) << "frame " << frame;
            ASSERT_NEAR(std::fabs(joint.at(frame, i)), std::fabs(s[i]), 1e-8) << "frame " << frame;
        }
        for (hsize_t i = 0; i < 3; ++i) {
            ASSERT_NEAR(omega.at(frame, i), s[4 + i], 1e-7) << "frame " << frame;
            ASSERT_NEAR(rate.at(frame, i), s[4 + i], 1e-7) << "frame " << frame;
        }
        for (int part = 0; part < 100; ++part) s = SprungBody::step(s, 1e-4);
    }
}

TEST_F(Runs, OrientationsAndJointCoordinatesFollowTheEquationsOfMotion) {
    expect_good(run("body-orientation", {"--set", "output.coordinates=true", "--output", "one"}));
    expect_body_moves_as_derived(at("one/trajectory.h5md"));
    expect_good(run("body-orientation", {"--output", "without"}));
    EXPECT_TRUE(
        numbers_of(at("without/trajectory.h5md"), "catena/joint_position/value").shape.empty());
}

TEST_F(Runs, CoordinatesAreTheSameOnSeveralRanks) {
    Words const words{
        "run",   input("mixed-joints.yaml"), "--quiet", "--steps", "20", "--set", "output.every=10",
        "--set", "output.coordinates=true",  "--output"};
    auto const into = [&](char const* name) {
        Words all = words;
        all.emplace_back(name);
        return all;
    };
    expect_good(catena(into("one"), folder_.path()));
    EXPECT_EQ(catena_on(2, into("two"), folder_.path()).status, 0);
    for (char const* const name : {"joint_position", "joint_rate", "angular_velocity",
                                   "body_position", "body_velocity", "orientation"}) {
        std::string const data = std::string("catena/") + name + "/value";
        Numbers const one = numbers_of(at("one/trajectory.h5md"), data);
        EXPECT_GT(one.values.size(), 0U) << name;
        EXPECT_EQ(one.values, numbers_of(at("two/trajectory.h5md"), data).values) << name;
    }
}

TEST_F(Runs, ABranchedChainOfBodiesHasTheSameBitsInPartsAndOnRanks) {
    auto const words = [](std::initializer_list<char const*> more) {
        Words all{"run",   input("humanoid.yaml"),   "--quiet", "--set", "output.every=10",
                  "--set", "output.coordinates=true"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    expect_good(catena(words({"--steps", "40", "--output", "whole"}), folder_.path()));
    expect_good(catena(words({"--steps", "20", "--output", "parts"}), folder_.path()));
    expect_good(
        catena(words({"--steps", "40", "--restart", "parts/checkpoint.h5"}), folder_.path()));
    EXPECT_EQ(catena_on(2, words({"--steps", "40", "--output", "two"}), folder_.path()).status, 0);
    for (char const* const data :
         {"particles/trajectory/position/value", "catena/joint_position/value",
          "catena/joint_rate/value", "catena/body_velocity/value"}) {
        Numbers const whole = numbers_of(at("whole/trajectory.h5md"), data);
        EXPECT_EQ(whole.shape.at(0), 5U) << data;
        EXPECT_EQ(numbers_of(at("parts/trajectory.h5md"), data).values, whole.values) << data;
        EXPECT_EQ(numbers_of(at("two/trajectory.h5md"), data).values, whole.values) << data;
    }
    EXPECT_EQ(numbers_of(at("whole/trajectory.h5md"), "catena/parent").values,
              (std::vector<double>{-1, 0, 1, 1, 3, 1, 5, 0, 7, 8, 0, 10, 11}));
    EXPECT_EQ(numbers_of(at("whole/trajectory.h5md"), "connectivity/bonds").shape,
              (std::vector<hsize_t>{12, 2}));
}

TEST_F(Runs, ABranchGoesOnFromPositionsAndVelocitiesWithOtherValues) {
    expect_good(run("restart-branch", {"--set", "output.velocities=true", "--output", "out"}));
    std::string const from = "out/checkpoint.h5";
    struct Change {
        std::string key, value;
    };
    for (auto const& [key, value] :
         {Change{"dynamics.temperature", "310"}, Change{"dynamics.friction", "0.3"},
          Change{"dynamics.seed", "10"}, Change{"dynamics.step", "0.005"},
          Change{"dynamics.integrator", "rattle"}, Change{"forces.gravity", "[0, 0, 1]"}}) {
        std::string const set =
            key == "forces.gravity" ? "forces={gravity: [0, 0, 1]}" : key + "=" + value;
        expect_refused(run("restart-branch", {"--restart", from, "--steps", "200", "--set", set,
                                              "--output", "hot-" + key}),
                       2, key + " was ");
        Ended const branched =
            run("restart-branch", {"--restart", from, "--branch", "--steps", "200", "--set", set,
                                   "--set", "output.velocities=true", "--output", "hot-" + key});
        expect_good(branched);
        nlohmann::json const branch = summary_of(at("hot-" + key)).at("branch");
        ASSERT_EQ(branch.at("changes").size(), 1U) << branch.dump();
        EXPECT_EQ(branch.at("changes")[0].at("key"), key);
        EXPECT_EQ(branch.at("changes")[0].at("now"), value);
        for (char const* const array : {"position", "velocity"}) {
            std::string const data = std::string("particles/trajectory/") + array + "/value";
            Numbers const before = numbers_of(at("out/trajectory.h5md"), data),
                          after = numbers_of(at("hot-" + key + "/trajectory.h5md"), data);
            std::size_t const size = 3 * 500;
            ASSERT_EQ(before.values.size() % size, 0U);
            if (key == "forces.gravity" && array == std::string("velocity"))
                continue;  // shown with half a step of the new forces
            EXPECT_TRUE(
                std::equal(before.values.end() - size, before.values.end(), after.values.begin()))
                << key << ", " << array;
        }
        EXPECT_EQ(table_of(at("hot-" + key)).at("time [ps]").front(), 1.0)
            << "time goes on where it was";
    }
}

/// The half kick that ends the checkpoint's step has that step's length, whatever the branch's:
/// without forces nothing shows it, under gravity energy is kept to the order of the shorter steps.
TEST_F(Runs, ABranchWithAShorterStepKeepsTheEnergy) {
    std::ofstream(at("rope.yaml")) << "units: md\nchains: [{name: r, velocities: zero, base: "
                                      "fixed, generator: {freely_jointed: {beads: 20, "
                                      "length: 0.38, mass: 100}}}]\nforces: {gravity: [0, 5, 0]}\n"
                                      "dynamics: {integrator: rattle, step: 0.004, steps: "
                                      "50}\noutput: {every: 1, observables: [energy]}\n";
    expect_good(catena({"run", "rope.yaml", "--quiet", "--output", "a"}, folder_.path()));
    expect_good(catena({"run", "rope.yaml", "--quiet", "--restart", "a/checkpoint.h5", "--branch",
                        "--set", "dynamics.step=0.0005", "--output", "b"},
                       folder_.path()));
    auto const before = table_of(at("a")), after = table_of(at("b"));
    EXPECT_EQ(after.at("step").back(), 100) << "without --steps as many more as the scene says";
    EXPECT_EQ(after.at("total_energy [kJ/mol]").front(), before.at("total_energy [kJ/mol]").back());
    double const kinetic = after.at("kinetic_energy [kJ/mol]").back();
    EXPECT_NEAR(after.at("total_energy [kJ/mol]").back(), after.at("total_energy [kJ/mol]").front(),
                1e-4 * kinetic);
    EXPECT_NEAR(after.at("time [ps]").back(), 0.2 + 50 * 0.0005, 1e-12);
    // One that ends where it begins owes more than a whole kick of its own.
    auto const go_on = [&](std::string const& from, std::string const& steps, Words const& more) {
        Words words{
            "run",     "rope.yaml", "--quiet", "--restart", from, "--set", "dynamics.step=0.0005",
            "--steps", steps};
        words.insert(words.end(), more.begin(), more.end());
        expect_good(catena(words, folder_.path()));
    };
    go_on("a/checkpoint.h5", "50", {"--branch", "--output", "c"});
    go_on("c/checkpoint.h5", "100", {});
    EXPECT_EQ(table_of(at("c")).at("total_energy [kJ/mol]").back(),
              after.at("total_energy [kJ/mol]").back());
}

TEST_F(Runs, ABranchThatCannotBeIsRefused) {
    expect_good(run("restart-branch", {"--output", "out"}));
    auto const branch = [&](Words const& more) {
        Words words{"--restart", "out/checkpoint.h5", "--branch", "--steps", "200"};
        words.insert(words.end(), more.begin(), more.end());
        return run("restart-branch", words);
    };
    expect_refused(branch({}), 2, "--output");
    expect_refused(branch({"--output", "out"}), 2, "a folder of its own");
    expect_refused(
        branch({"--output", "b", "--set", "chains[0].generator.freely_jointed.beads=400"}), 2,
        "other bodies, links or joints");
    expect_refused(branch({"--output", "b", "--set", "chains[0].count=2"}), 2,
                   "a branch keeps its chains");
    expect_refused(branch({"--output", "b", "--set", "chains[0].generator.freely_jointed.mass=50"}),
                   2, "other bodies, links or joints");
    expect_refused(run("restart-branch", {"--branch", "--output", "b"}), 2, "--restart");
    EXPECT_FALSE(fs::exists(at("b")));
}

TEST_F(Runs, LostFramesAndLinesAreSaidAtARestart) {
    expect_good(run("restart-branch", {"--output", "out"}));
    auto const restart = [&](std::string const& folder, Words const& more = {}) {
        Words words{"--restart", folder + "/checkpoint.h5", "--steps", "120"};
        words.insert(words.end(), more.begin(), more.end());
        return run("restart-branch", words);
    };
    auto const copy = [&](std::string const& name) {
        fs::copy(at("out"), at(name), fs::copy_options::recursive);
    };
    copy("no-table");
    fs::remove(at("no-table/observables.csv"));
    expect_refused(restart("no-table"), 2, "there is no table of observables to continue");
    copy("no-trajectory");
    fs::remove(at("no-trajectory/trajectory.h5md"));
    expect_refused(restart("no-trajectory"), 2, "--output OTHER");
    copy("short-table");
    std::string const table = text_of(at("short-table/observables.csv"));
    std::ofstream(at("short-table/observables.csv")) << table.substr(0, table.find("\n50,") + 1);
    expect_refused(restart("short-table"), 2,
                   "has lost lines: 10 of the 20 before the checkpoint are there");
    expect_good(run("restart-branch", {"--steps", "40", "--output", "early"}));
    copy("short-trajectory");
    fs::copy(at("early/trajectory.h5md"), at("short-trajectory/trajectory.h5md"),
             fs::copy_options::overwrite_existing);
    expect_refused(restart("short-trajectory"), 2,
                   "has lost frames: 9 of the 20 before the checkpoint are there");
    expect_good(restart("short-table", {"--output", "beside"}));
}

TEST_F(Runs, ATrajectoryThatIsDeletedDuringTheRunIsMissed) {
    std::string const run = program() + " run " + scene_of("restart-branch") +
                            " --quiet --set output.every=1 --steps 1000 --output out";
    Ended const ended = run_program({"sh", "-c",
                                     run + " & p=$!; while [ ! -e out/checkpoint.h5 ]; do sleep "
                                           "0.01; done; rm out/trajectory.h5md; wait $p"},
                                    folder_.path());
    expect_refused(ended, 1, "deleted while it ran (out/trajectory.h5md)");
    EXPECT_TRUE(fs::exists(at("out/summary.json")));
}

/// Three beads of 1, 1 and 98 amu at x = 0, 1, 2: about their middle sqrt((1 + 0 + 1) / 3), about
/// their centre of mass at 1.97 sqrt((1.97^2 + 0.97^2 + 98 0.03^2) / 100).
TEST_F(Runs, TheRadiusOfGyrationIsWeightedUnlessAskedOtherwise) {
    expect_good(
        run("rg-weight",
            {"--set", "output.observables=[radius_of_gyration, unweighted_radius_of_gyration]",
             "--output", "o"}));
    auto const table = table_of(at("o"));
    EXPECT_NEAR(table.at("radius_of_gyration [nm]").front(),
                std::sqrt((1.97 * 1.97 + 0.97 * 0.97 + 98 * 0.03 * 0.03) / 100), 1e-14);
    EXPECT_NEAR(table.at("unweighted_radius_of_gyration [nm]").front(), std::sqrt(2.0 / 3), 1e-14);
    expect_good(run("rg-weight", {"--set", "output.observables=null", "--output", "default"}));
    EXPECT_EQ(table_of(at("default")).count("unweighted_radius_of_gyration [nm]"), 0U);
}

TEST_F(Runs, MassesAndBondsStandInThePsf) {
    expect_good(run("rg-weight", {"--output", "o"}));
    std::string const psf = text_of(at("o/topology.psf"));
    EXPECT_NE(psf.find("\n       3 A 3 UNK CA CA 0.000000 98 0\n"), std::string::npos) << psf;
    EXPECT_NE(psf.find("       2 !NBOND: bonds\n       1       2       2       3\n"),
              std::string::npos)
        << psf;
}

/// A checkpoint by the clock changes nothing of the run, and a run goes on from it as if nothing
/// had happened.
TEST_F(Runs, ACheckpointByTheClockLeavesTheRunAsItIs) {
    Words const steps{"--set", "output.checkpoint_every=0", "--steps", "60", "--output"};
    auto const with = [&](char const* minutes, char const* folder) {
        Words words{"--set", std::string("output.checkpoint_minutes=") + minutes};
        words.insert(words.end(), steps.begin(), steps.end());
        words.emplace_back(folder);
        return run("restart-branch", words);
    };
    expect_good(with("0", "without"));
    expect_good(with("1e-6", "with"));
    EXPECT_FALSE(fs::exists(at("without/checkpoint.previous.h5")));
    ASSERT_TRUE(fs::exists(at("with/checkpoint.previous.h5")));
    EXPECT_EQ(read_checkpoint(at("with/checkpoint.h5")).arrays,
              read_checkpoint(at("without/checkpoint.h5")).arrays);
    EXPECT_EQ(text_of(at("with/observables.csv")), text_of(at("without/observables.csv")));
    EXPECT_GT(read_checkpoint(at("with/checkpoint.previous.h5")).step, 0);
    EXPECT_LT(read_checkpoint(at("with/checkpoint.previous.h5")).step, 60);
    expect_good(run("restart-branch", {"--set", "output.checkpoint_every=0", "--steps", "60",
                                       "--restart", "with/checkpoint.previous.h5"}));
    EXPECT_EQ(read_checkpoint(at("with/checkpoint.h5")).arrays,
              read_checkpoint(at("without/checkpoint.h5")).arrays);
    EXPECT_EQ(text_of(at("with/observables.csv")), text_of(at("without/observables.csv")));
}

TEST_F(Runs, WhatIsNoFileOrFolderIsRefusedInTheSystemsWords) {
    std::string const long_name(300, 'x');
    expect_refused(run("rg-weight", {"--output", long_name}), 2, "File name too long");
    expect_refused(run("rg-weight", {"--output", "/dev/null/below"}), 2, "Not a directory");
    expect_refused(run("rg-weight", {"--restart", long_name}), 2, "File name too long");
    expect_refused(catena({"check", "/dev/zero"}), 2, "a device or pipe, not a file");
    ASSERT_EQ(::mkfifo(at("pipe").c_str(), 0600), 0);
    expect_refused(catena({"check", at("pipe")}), 2, "a device or pipe, not a file");
    expect_refused(catena({"check", long_name}), 2, "File name too long");
}

}  // namespace
}  // namespace catena::test
