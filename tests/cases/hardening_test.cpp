// Damaged, hostile and very large inputs: each is read, or refused in one line with status 2,
// within bounded time and memory.
#include <fcntl.h>
#include <hdf5.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <future>
#include <iterator>
#include <limits>

#include "io/memory_limit.hpp"
#include "io/output.hpp"
#include "run/run_lock.hpp"
#include "tests/command/program.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

namespace fs = std::filesystem;

std::string data_of(std::string const& name) { return CATENA_TEST_DATA "/cases/" + name; }

std::string bytes_of(std::string const& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void write(std::string const& file, std::string const& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

double seconds_of(std::function<void()> const& action) {
    auto const start = std::chrono::steady_clock::now();
    action();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// check SCENE with so much memory. The address sanitizer reserves terabytes of addresses, so it
/// limits what is resident.
Ended check_within(int megabytes, std::string const& scene, std::string const& folder = "") {
#ifdef __SANITIZE_ADDRESS__
    std::string const limit = "export ASAN_OPTIONS=hard_rss_limit_mb=" + std::to_string(megabytes);
#else
    std::string const limit = "ulimit -v " + std::to_string(megabytes * 1024);
#endif
    return run_program({"sh", "-c", limit + "; exec \"$0\" check \"$1\"", program(), scene},
                       folder);
}

// ---- Scenes

/// `depth` lists within each other, each with an anchor, around `width` numbers: every anchor keeps
/// all that is within.
std::string nested_anchors(int depth, int width) {
    std::string text = "title: ";
    for (int i = 0; i < depth; ++i) text += "&a" + std::to_string(i) + " [";
    for (int i = 0; i < width; ++i) text += i == 0 ? "1" : ",1";
    return text + std::string(static_cast<std::size_t>(depth), ']') + "\n";
}

TEST(Anchors, AreRefusedBeforeTheirCopiesTakeTheMemory) {
    TemporaryFolder const folder;
    write(folder / "s.yaml",
          nested_anchors(450, 90'000));  // 450 copies of 90,000 values of some 120 bytes: 5 GB
    expect_refused(check_within(3000, "s.yaml", folder.path()), 2, "s.yaml: line 1");
    expect_refused(catena({"check", "s.yaml"}, folder.path()), 2,
                   "anchors and aliases multiply the values to more than 512 MB");
}

TEST(Aliases, MultiplyTextsAndValuesWithinBounds) {
    TemporaryFolder const folder;
    std::string laughs = "a: &a0 [" + std::string(2000, 'x') + "]\n";
    for (int i = 1; i < 8; ++i) {
        laughs += "b" + std::to_string(i) + ": &a" + std::to_string(i) + " [";
        for (int j = 0; j < 9; ++j) laughs += (j == 0 ? "*a" : ", *a") + std::to_string(i - 1);
        laughs += "]\n";
    }
    write(folder / "s.yaml", laughs);
    expect_refused(check_within(3000, "s.yaml", folder.path()), 2, "anchors and aliases multiply");
}

TEST(Aliases, DoNotNestDeeperThanWrittenListsMay) {
    TemporaryFolder const folder;
    std::string text = "a: &a0 [1]\n";
    for (int i = 1; i < 10; ++i)
        text += "b" + std::to_string(i) + ": &a" + std::to_string(i) + " " + std::string(100, '[') +
                "*a" + std::to_string(i - 1) + std::string(100, ']') + "\n";
    write(folder / "s.yaml", text);
    expect_refused(catena({"check", "s.yaml"}, folder.path()), 2,
                   "values nest deeper than 500 levels");
}

TEST(Aliases, OfReasonableSizeAreRead) {
    TemporaryFolder const folder;
    write(folder / "s.yaml",
          "chains: [{name: a, generator: &g {freely_jointed: {beads: 5, length: 1}}}, {name: b, "
          "generator: *g}]\n");
    expect_good(catena({"check", "s.yaml"}, folder.path()));
}

TEST(Boxes, BeyondWhatOpenMmHoldsAreRefused) {
    // 6e9 nm: 3e9 x 30 columns of cells two nanometres wide. The CPU platform's threads threw in
    // vain, the process aborted.
    std::string const scene = data_of("box-edge/scene.yaml");
    expect_refused(catena({"check", scene}), 2, "box");
    for (char const* const edge : {"6e8", "6e6", "6e5"}) {
        TemporaryFolder const folder;
        expect_refused(
            catena({"run", scene, "--set", std::string("box={periodic: [60, 60, ") + edge + "]}",
                    "--steps", "2", "--output", "o", "--quiet"},
                   folder.path()),
            2, "too long for OpenMM's neighbour lists");
    }
    expect_refused(catena({"check", scene, "--set", "box={periodic: [60, 60, 9e125]}"}), 2,
                   "box edge 9e+125 is beyond the range of positions");
    expect_good(catena({"check", scene, "--set", "box={periodic: [60, 60, 6000]}", "--quiet"}));
    expect_refused(catena({"check", scene, "--set", "box={periodic: [6, 60, 60]}"}), 2,
                   "");  // below two cutoffs of 4 nm
}

TEST(Positions, BeyondWhatTheyHoldAreRefused) {
    Ended const far =
        catena({"check", "scene.yaml"}, data_of("far-position"));  // z of one atom is 1e30
    EXPECT_EQ(far.status, 2) << far.out;
    EXPECT_EQ(count(far.err, "\n"), 1U) << far.err;
    TemporaryFolder const folder;
    for (char const* const one : {"[2e9, 0, 0]", "[0, -1e30, 0]", "[1e22, 1e22, 1e22]"}) {
        write(
            folder / "s.yaml",
            std::string("chains: [{bodies: [{mass: 1, position: [0, 0, 0]}, {mass: 1, position: ") +
                one + ", joint: {type: link}}]}]\n");
        expect_refused(catena({"check", "s.yaml"}, folder.path()), 2,
                       "from the origin, beyond the range of positions");
    }
}

TEST(Scenes, AreNeverReadFromDevices) {
    expect_refused(catena({"check", "/dev/zero"}), 2, "a device or pipe, not a file: `/dev/zero`");
}

TEST(Places, AreFoundBesideLongChainsAtOnce) {
    // An extended chain of 4000 residues across the origin and a pentapeptide, which the grid has
    // to put 700 nm away.
    double const seconds = seconds_of(
        [] { expect_good(catena({"check", data_of("far-position/realistic.yaml"), "--quiet"})); });
    EXPECT_LT(seconds, 10);  // it took 31 s, and the fourth power of the length
}

TEST(Chains, AreCheckedInTimeLinearInTheirNumber) {
    // 353 s where each chain asked for the sum over all of them.
    double const seconds = seconds_of([] {
        Ended const e = catena({"check", data_of("many-chains/scene.yaml"), "--json", "-"});
        EXPECT_EQ(e.status, 0) << e.err;
        EXPECT_EQ(e.json().at("bodies"), 300'000);
    });
    EXPECT_LT(seconds, 40);
}

TEST(Chains, BeyondTwentyRowsOfTheTableAreCounted) {
    TemporaryFolder const folder;
    std::string text = "chains:\n";
    for (int i = 0; i < 30; ++i)  // neighbours differ in size: no two share a row
        text += "  - {name: c" + std::to_string(i) +
                ", generator: {freely_jointed: {beads: " + std::to_string(3 + i % 2) +
                ", length: 1}}}\n";
    write(folder / "s.yaml", text);
    Ended const e = catena({"check", "s.yaml"}, folder.path());
    expect_good(e);
    EXPECT_NE(e.out.find("c19"), std::string::npos) << e.out;
    EXPECT_EQ(e.out.find("c20"), std::string::npos) << e.out;
    EXPECT_NE(e.out.find("others"), std::string::npos) << e.out;
}

// ---- HDF5

/// Two bodies; joint_type as text of variable length, the way h5py writes names.
void write_bodies(std::string const& file) {
    hid_t const made = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    auto const put = [&](char const* name, hid_t type, void const* values,
                         std::vector<hsize_t> const& shape) {
        hid_t const space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
        hid_t const data =
            H5Dcreate2(made, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
        H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
        H5Dclose(data);
        H5Sclose(space);
    };
    double const mass[2] = {1, 2}, inertia[12] = {1, 0, 1, 0, 0, 1, 1, 0, 1, 0, 0, 1},
                 axis[6] = {0, 0, 1, 0, 0, 1};
    char const* const types[2] = {"revolute", "spherical"};
    hid_t const text = H5Tcopy(H5T_C_S1);
    H5Tset_size(text, H5T_VARIABLE);
    put("mass", H5T_NATIVE_DOUBLE, mass, {2});
    put("inertia", H5T_NATIVE_DOUBLE, inertia, {2, 6});
    put("axis", H5T_NATIVE_DOUBLE, axis, {2, 3});
    put("joint_type", text, static_cast<void const*>(types), {2});
    H5Tclose(text);
    H5Fclose(made);
}

TEST(VariableTexts, AreReadWithoutHdf5) {
    TemporaryFolder const folder;
    write_bodies(folder / "x.h5");
    write(folder / "s.yaml", "units: si\nchains: [{base: fixed, bodies: {hdf5: x.h5}}]\n");
    Ended const e = catena({"check", "s.yaml", "--json", "-"}, folder.path());
    EXPECT_EQ(e.status, 0) << e.err;
    EXPECT_EQ(e.json().at("dof"), 4);  // one of the revolute joint, three of the spherical one
}

TEST(VariableTexts, ThatAreDamagedAreRefused) {
    // One byte of the global heap is wrong: HDF5 1.10 ended in SIGSEGV.
    expect_refused(catena({"check", "scene.yaml"}, data_of("hdf5-vlen-damaged")), 2,
                   "dataset `joint_type`");
    TemporaryFolder const folder;
    write_bodies(folder / "good.h5");
    write(folder / "s.yaml", "units: si\nchains: [{base: fixed, bodies: {hdf5: x.h5}}]\n");
    std::string const good = bytes_of(folder / "good.h5");
    std::size_t const heap = good.find("GCOL");
    ASSERT_NE(heap, std::string::npos);
    for (std::size_t i = 0; i < 64; ++i) {
        std::string bad = good;
        bad[heap + i] = static_cast<char>(bad[heap + i] ^ (i % 2 == 0 ? 0xff : 0x10));
        write(folder / "x.h5", bad);
        Ended const e = catena({"check", "s.yaml"}, folder.path());
        EXPECT_TRUE(e.status == 0 || e.status == 2) << i << ": " << e.status << e.err;
    }
}

TEST(Datasets, OfIntegersWithoutBitsAreRefused) {
    TemporaryFolder const folder;
    write_bodies(folder / "x.h5");
    hid_t const file = H5Fopen((folder / "x.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT),
                odd = H5Tcopy(H5T_STD_I64LE);
    H5Tset_precision(odd, 21);
    hsize_t const rows = 2;
    hid_t const space = H5Screate_simple(1, &rows, nullptr);
    H5Ldelete(file, "joint_type", H5P_DEFAULT);
    std::int64_t const types[2] = {3, 2};
    hid_t const data =
        H5Dcreate2(file, "joint_type", odd, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(data, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, types);
    H5Dclose(data);
    H5Fclose(file);
    // In the file the precision follows its offset, both of two bytes: HDF5 1.10 ends in SIGBUS
    // where it is 0.
    std::string bytes = bytes_of(folder / "x.h5");
    std::size_t const at = bytes.find(std::string("\0\0\x15\0", 4));
    ASSERT_NE(at, std::string::npos);
    bytes[at + 2] = 0;
    write(folder / "x.h5", bytes);
    write(folder / "s.yaml", "units: si\nchains: [{base: fixed, bodies: {hdf5: x.h5}}]\n");
    expect_refused(catena({"check", "s.yaml"}, folder.path()), 2, "dataset `joint_type`");
}

TEST(Datasets, ThatClaimMoreThanTheFileHoldsAreRefused) {
    TemporaryFolder const folder;
    hid_t const made =
        H5Fcreate((folder / "x.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    hsize_t const rows = 1'000'000'000'000, chunk = 1024;
    hid_t const space = H5Screate_simple(1, &rows, nullptr), how = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(how, 1, &chunk);
    H5Dclose(H5Dcreate2(made, "mass", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, how, H5P_DEFAULT));
    H5Fclose(made);
    write(folder / "s.yaml", "chains: [{base: fixed, bodies: {hdf5: x.h5}}]\n");
    expect_refused(catena({"check", "s.yaml"}, folder.path()), 2,
                   "but the file does not contain them all");
}

TEST(Memory, IsWhatTheControlGroupAllows) {
    TemporaryFolder const folder;
    fs::create_directories(folder / "job/step");
    write(folder / "own", "0::/job/step\n");
    std::int64_t const without = memory_limit(folder.path(), folder / "own");
    write(folder / "job/step/memory.max", "max\n");
    EXPECT_EQ(memory_limit(folder.path(), folder / "own"), without);
    write(folder / "job/memory.max", "123456789\n");  // of the group above
    EXPECT_EQ(memory_limit(folder.path(), folder / "own"), 123456789);
    fs::create_directories(folder / "memory/batch");
    write(folder / "memory/batch/memory.limit_in_bytes", "23456789\n");  // version 1
    write(folder / "own", "7:cpu,memory:/batch\n");
    EXPECT_EQ(memory_limit(folder.path(), folder / "own"), 23456789);
    EXPECT_EQ(memory_limit(folder.path(), folder / "none"), without);
}

// ---- Checkpoints

/// A restart from the checkpoint of `scene` after `change` and a new seal, as only intent can make
/// it.
Ended restarted(std::string const& scene, std::function<void(Checkpoint&)> const& change) {
    TemporaryFolder const folder;
    expect_good(catena({"run", scene, "--steps", "2", "--output", "o", "--quiet"}, folder.path()));
    Checkpoint c = read_checkpoint(folder / "o/checkpoint.h5");
    change(c);
    write_checkpoint(folder / "changed.h5", c);
    return catena(
        {"run", scene, "--steps", "4", "--restart", "changed.h5", "--output", "p", "--quiet"},
        folder.path());
}

TEST(Checkpoints, WithCountersThatNoRunWritesAreRefused) {
    std::string const links = data_of("checkpoint-resealed/links.yaml");
    expect_good(restarted(links, [](Checkpoint&) {}));
    expect_refused(
        restarted(links, [](Checkpoint& c) { c.integers["sweeps_a_drift"] = 1'000'000'000; }), 2,
        "sweeps_a_drift is 1000000000");
    expect_refused(restarted(links, [](Checkpoint& c) { c.integers.erase("sweeps_a_drift"); }), 2,
                   "sweeps_a_drift is missing");
    expect_refused(restarted(links, [](Checkpoint& c) { c.integers["pending_half_kicks"] = -1; }),
                   2, "pending_half_kicks is -1");
    std::string const negative = data_of("checkpoint-resealed/links-step-negative.h5");
    expect_refused(
        catena({"run", links, "--restart", negative, "--output", "never-made", "--quiet"}), 2,
        "the checkpoint is damaged, its step is -");
}

TEST(Checkpoints, WithErrorsThatAreNoNumbersAreRefused) {
    std::string const arm = data_of("checkpoint-resealed/arm.yaml");
    double const nan = std::numeric_limits<double>::quiet_NaN();
    expect_good(restarted(arm, [](Checkpoint&) {}));
    expect_refused(
        restarted(arm, [&](Checkpoint& c) { c.arrays["largest_constraint_error"] = {nan}; }), 2,
        "largest_constraint_error holds nan");
    expect_refused(restarted(arm, [&](Checkpoint& c) { c.arrays["sweep_watch"] = {0}; }), 2,
                   "sweep_watch has 1 numbers");
    expect_refused(
        restarted(arm, [&](Checkpoint& c) { c.integers["corrections_of_tips"] = 1LL << 40; }), 2,
        "corrections_of_tips is 1099511627776");
}

// ---- The run's folder

Words const short_run{"run", data_of("running-folder/scene.yaml"), "--output", "o", "--quiet"};

Ended run_with(TemporaryFolder const& folder, Words const& more) {
    Words words = short_run;
    if (std::find(more.begin(), more.end(), "--steps") == more.end())
        words.insert(words.end(), {"--steps", "4"});
    words.insert(words.end(), more.begin(), more.end());
    return catena(words, folder.path());
}

TEST(RunningFolders, AreLeftAloneByOthers) {
    TemporaryFolder const folder;
    expect_good(run_with(folder, {}));
    EXPECT_FALSE(fs::exists(folder / "o/run.lock"));
    std::string const before = bytes_of(folder / "o/checkpoint.h5");
    {
        RunLock const lock(folder / "o");
        std::string const held = "another run is writing to this folder: process " +
                                 std::to_string(::getpid()) + " on host ";
        expect_refused(run_with(folder, {"--overwrite"}), 2, held);
        expect_refused(run_with(folder, {"--restart", "o/checkpoint.h5", "--steps", "8"}), 2, held);
        expect_refused(run_with(folder, {}), 2, held);
        EXPECT_EQ(run_program({"sh", "-c",
                               "HDF5_USE_FILE_LOCKING=FALSE exec \"$0\" run \"$1\" --steps 2 "
                               "--output o --overwrite",
                               program(), data_of("running-folder/scene.yaml")},
                              folder.path())
                      .status,
                  2);
    }
    EXPECT_EQ(bytes_of(folder / "o/checkpoint.h5"), before);
    expect_good(run_with(folder, {"--restart", "o/checkpoint.h5", "--steps", "8"}));
}

TEST(RunningFolders, OnRanksAreLeftAloneToo) {
    TemporaryFolder const folder;
    fs::create_directories(folder / "o");
    RunLock const lock(folder / "o");
    Ended const e = catena_on(2, short_run, folder.path());
    EXPECT_EQ(e.status, 2) << e.err;
    EXPECT_EQ(count(e.err, "catena: another run is writing to this folder"), 1U) << e.err;
}

TEST(RunningFolders, OfProcessesThatHaveEndedAreFree) {
    TemporaryFolder const folder;
    expect_good(run_with(folder, {}));
    write(folder / "o/run.lock",
          "elsewhere 1 1 2026-01-01T00:00:00Z\n");  // as kill -9 leaves it: nobody holds it
    expect_good(run_with(folder, {"--overwrite"}));
    EXPECT_FALSE(fs::exists(folder / "o/run.lock"));
}

TEST(RunningFolders, HaveOneWriterOfTwoThatStartAtTheSameTime) {
    for (int i = 0; i < 4; ++i) {
        TemporaryFolder const folder;
        auto const start = [&](Words const& more) {
            return std::async(std::launch::async, [&, more] { return run_with(folder, more); });
        };
        auto first = start({"--steps", "400"}), second = start({"--steps", "400"});
        Ended const a = first.get(), b = second.get();
        EXPECT_EQ(std::min(a.status, b.status), 0) << a.err << b.err;
        EXPECT_EQ(std::max(a.status, b.status), 2) << a.err << b.err;
        Ended const next = run_with(folder, {"--restart", "o/checkpoint.h5", "--steps", "410"});
        EXPECT_EQ(next.status, 0) << next.err;
    }
}

TEST(TemporaryFiles, AreNeverWrittenThroughLinksOrPipes) {
    TemporaryFolder const folder;
    fs::create_directories(folder / "o");
    write(folder / "victim", "precious");
    for (char const* const name :
         {"summary.json", "timeline.json", "report.html", "checkpoint.h5", "topology.pdb"})
        fs::create_symlink("../victim", folder / (std::string("o/") + name + ".writing"));
    expect_good(run_with(folder, {"--overwrite"}));
    EXPECT_EQ(bytes_of(folder / "victim"), "precious");
    for (char const* const name : {"summary.json", "timeline.json", "report.html"}) {
        fs::remove(folder / (std::string("o/") + name));
        fs::create_symlink("../victim", folder / (std::string("o/") + name));
        ASSERT_EQ(::mkfifo((folder / (std::string("o/") + name + ".writing")).c_str(), 0600), 0);
    }
    expect_good(run_with(folder, {"--restart", "o/checkpoint.h5", "--steps", "8"}));
    EXPECT_EQ(bytes_of(folder / "victim"), "precious");
    EXPECT_FALSE(fs::is_symlink(folder / "o/summary.json"));
}

std::vector<std::string> names_in(std::string const& folder, std::string const& begin) {
    std::vector<std::string> names;
    std::error_code ignored;
    for (fs::directory_entry const& entry : fs::directory_iterator(folder, ignored))
        if (std::string const name = entry.path().filename().string(); name.starts_with(begin))
            names.push_back(name);
    return names;
}

TEST(Runs, LeaveNothingBehindButTheirFiles) {
    TemporaryFolder const folder;
    fs::create_directories(folder / "tmp");
    for (int i = 0; i < 5; ++i) {
        Ended const e = run_program(
            {"sh", "-c",
             "TMPDIR=\"$PWD/tmp\" exec \"$0\" run \"$1\" --steps 2 --output o --overwrite --quiet",
             program(), data_of("running-folder/scene.yaml")},
            folder.path());
        expect_good(e);
    }
    EXPECT_TRUE(names_in(folder / "tmp", "").empty());
    EXPECT_EQ(
        names_in(folder / "o", "").size(),
        8U);  // trajectory, two topologies, observables, checkpoint, summary, timeline, report
}

TEST(Checkpoints, OfFoldersThatCannotBeLookedIntoAreRefused) {
    TemporaryFolder const folder;
    expect_refused(catena({"run", data_of("running-folder/scene.yaml"), "--steps", "2", "--output",
                           std::string(300, 'x')},
                          folder.path()),
                   2, "the output folder cannot be read");
}

}  // namespace
}  // namespace catena::test
