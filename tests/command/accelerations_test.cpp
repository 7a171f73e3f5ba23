// --accelerations: the numbers of the JSON, in HDF5 flat and with offsets, as CSV and as JSON.
#include <hdf5.h>

#include <algorithm>
#include <fstream>
#include <type_traits>

#include "tests/command/program.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

using Json = nlohmann::json;

/// A dataset of doubles or 64-bit integers.
template <class T>
std::vector<T> dataset(std::string const& path, char const* name) {
    hid_t const file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    hid_t const data = H5Dopen2(file, name, H5P_DEFAULT), space = H5Dget_space(data);
    hid_t const type = std::is_same_v<T, double> ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64;
    EXPECT_GE(space, 0) << path << ", " << name;
    std::vector<T> values(
        static_cast<std::size_t>(std::max<hssize_t>(H5Sget_simple_extent_npoints(space), 0)));
    EXPECT_GE(H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0)
        << path << ", " << name;
    H5Sclose(space);
    H5Dclose(data);
    H5Fclose(file);
    return values;
}

void flatten(Json const& value, std::vector<double>& list) {
    if (value.is_number()) return list.push_back(value.get<double>());
    if (value.is_array()) {
        for (Json const& entry : value) flatten(entry, list);
        return;
    }
    flatten(value.at("alpha"), list);
    flatten(value.at("acceleration"), list);
}

TEST(Accelerations, HoldTheNumbersOfTheJson) {
    TemporaryFolder const folder;
    std::ofstream(folder / "mixed.yaml")
        << "units: si\nforces: {gravity: [0, 0, -9.81]}\nchains:\n"
           "  - {base: free, generator: {random: {bodies: 5, joint: spherical}}}\n"
           "  - {base: fixed, generator: {random: {bodies: 4, joint: link}}}\n"
           "  - {base: fixed, generator: {random: {bodies: 3, joint: revolute}}}\n";
    Ended const e =
        catena({"solve", "mixed.yaml", "--accelerations", "a.h5", "--json", "-", "--repeat", "1"},
               folder.path());
    expect_good(e);
    Json const json = e.json();
    std::string const file = folder / "a.h5";
    auto const accelerations = dataset<double>(file, "accelerations"),
               forces = dataset<double>(file, "joint_forces");
    auto const offsets = dataset<std::int64_t>(file, "offsets");
    std::vector<double> expected_accelerations, expected_forces;
    std::vector<std::int64_t> expected_offsets;
    for (std::size_t body = 0; body < 12; ++body) {
        expected_offsets.insert(expected_offsets.end(),
                                {std::ssize(expected_accelerations), std::ssize(expected_forces)});
        flatten(json["joint_accelerations"][body], expected_accelerations);
        flatten(json["joint_forces"][body], expected_forces);
    }
    expected_offsets.insert(expected_offsets.end(),
                            {std::ssize(expected_accelerations), std::ssize(expected_forces)});
    EXPECT_EQ(accelerations, expected_accelerations);
    EXPECT_EQ(forces, expected_forces);
    EXPECT_EQ(offsets, expected_offsets);
    EXPECT_EQ(accelerations.size(), 6U + 4 * 3 + 4 * 3 + 3);
    EXPECT_EQ(forces.size(), 5U * 6 + 4 + 3 * 6);
}

TEST(Accelerations, HoldTheForcesOfTips) {
    TemporaryFolder const folder;
    Ended const e = catena({"solve", input("four-bar.yaml"), "--accelerations", "a.h5", "--json",
                            "-", "--repeat", "1"},
                           folder.path());
    expect_good(e);
    std::string const file = folder / "a.h5";
    auto const forces = dataset<double>(file, "tip_forces");
    auto const chains = dataset<std::int64_t>(file, "tip_chains");
    Json const tip = e.json()["tip_forces"].at(0);
    std::vector<double> expected = tip["torque"].get<std::vector<double>>();
    for (Json const& f : tip["force"]) expected.push_back(f.get<double>());
    EXPECT_EQ(forces, expected);
    EXPECT_EQ(chains, std::vector<std::int64_t>{0});
    EXPECT_GT(std::abs(forces.at(4)), 1.0);  // it carries a part of the bars' weight
}

TEST(Accelerations, TheTrajectoryHoldsTheForcesOfTips) {
    TemporaryFolder const folder;
    std::ofstream(folder / "two.yaml")
        << "units: si\nforces: {gravity: [0, -9.81, 0]}\nchains:\n"
           "  - {name: first, base: fixed, generator: {random: {bodies: 5, joint: spherical}}}\n"
           "  - {name: held, base: fixed, tip: {joint: {type: spherical}}, generator: {random: "
           "{bodies: 6, joint: universal}}}\n"
           "dynamics: {integrator: rk4, step: 1e-4, steps: 2}\noutput: {every: 1, joint_forces: "
           "true}\n";
    expect_good(catena({"run", "two.yaml", "--output", "r", "--quiet"}, folder.path()));
    Json const tip = catena({"solve", "two.yaml", "--repeat", "1", "--json", "-"}, folder.path())
                         .json()["tip_forces"]
                         .at(0);
    std::string const file = folder / "r/trajectory.h5md";
    auto const force = dataset<double>(file, "catena/tip_force/value"),
               torque = dataset<double>(file, "catena/tip_torque/value");
    auto const chain = dataset<std::int64_t>(file, "catena/tip_force/chain");
    ASSERT_EQ(force.size(), 9U);  // frames of steps 0, 1, 2
    ASSERT_EQ(torque.size(), 9U);
    EXPECT_EQ(chain, std::vector<std::int64_t>{1});
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(force[i], tip["force"][i].get<double>());
        EXPECT_EQ(torque[i], tip["torque"][i].get<double>());
    }
}

/// Fields of a line.
std::vector<std::string> fields_of(std::string const& line) {
    std::vector<std::string> fields(1);
    for (char const c : line)
        if (c == ',')
            fields.emplace_back();
        else
            fields.back().push_back(c);
    return fields;
}

TEST(Accelerations, CsvHasALinePerBodyAndTip) {
    TemporaryFolder const folder;
    Ended const e = catena({"solve", input("four-bar.yaml"), "--accelerations", "a.csv", "--json",
                            "-", "--repeat", "1"},
                           folder.path());
    expect_good(e);
    Json const json = e.json();
    std::ifstream file(folder / "a.csv");
    std::vector<std::vector<std::string>> lines;
    for (std::string line; std::getline(file, line);) lines.push_back(fields_of(line));
    std::size_t const bodies = json["joint_accelerations"].size();
    ASSERT_EQ(lines.size(), 1 + bodies + 1);
    for (auto const& line : lines) EXPECT_EQ(line.size(), 15U);
    EXPECT_EQ(lines[0][3], "acceleration_1");
    EXPECT_EQ(lines[0][14], "joint_force_6");
    for (std::size_t b = 0; b < bodies; ++b) {
        EXPECT_EQ(lines[b + 1][1], std::to_string(b + 1));
        EXPECT_EQ(lines[b + 1][2], "revolute");
        EXPECT_EQ(std::stod(lines[b + 1][3]), json["joint_accelerations"][b].get<double>());
        EXPECT_EQ(lines[b + 1][4], "");
        EXPECT_EQ(std::stod(lines[b + 1][13]), json["joint_forces"][b][4].get<double>());
    }
    EXPECT_EQ(lines.back()[1], "tip");
    EXPECT_EQ(std::stod(lines.back()[13]), json["tip_forces"][0]["force"][1].get<double>());
}

TEST(Accelerations, JsonHoldsThoseOfSolve) {
    TemporaryFolder const folder;
    Ended const e = catena({"solve", input("spherical-chain.yaml"), "--accelerations", "a.json",
                            "--json", "-", "--repeat", "1"},
                           folder.path());
    expect_good(e);
    Json const json = e.json(), file = Json::parse(std::ifstream(folder / "a.json"));
    for (char const* const name : {"joint_accelerations", "joint_forces", "tip_forces"})
        EXPECT_EQ(file.at(name), json.at(name)) << name;
}

TEST(Accelerations, FilesThatCannotBeAreRefusedBeforeAnythingIsComputed) {
    expect_refused(catena({"solve", input("arm.yaml"), "--accelerations", "/no/such/folder/a.h5"}),
                   2, "no such folder");
    expect_refused(catena({"solve", input("arm.yaml"), "--accelerations", "/dev/null"}), 2,
                   "not a regular file (--accelerations /dev/null)");
    expect_refused(catena({"solve", input("arm.yaml"), "--accelerations", "a.txt"}), 2,
                   "unknown ending .txt (--accelerations a.txt): name a file with .csv, .json or "
                   ".h5 (.hdf5) at its end");
    expect_refused(catena({"solve", input("arm.yaml"), "--accelerations", "a"}), 2,
                   "the name has no ending");
}

}  // namespace
}  // namespace catena::test
