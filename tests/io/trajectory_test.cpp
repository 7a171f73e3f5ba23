#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <fstream>

#include "error.hpp"
#include "io/hdf5_handle.hpp"
#include "sample_frames.hpp"
#include "temporary_folder.hpp"

namespace catena::test {
namespace {

using hdf5::Attribute;
using hdf5::Dataset;
using hdf5::File;
using hdf5::Object;
using hdf5::Space;
using hdf5::Type;

/// All numbers of a dataset, as doubles or integers.
template <class Value>
std::vector<Value> read(std::string const& file, std::string const& name, hid_t type) {
    File const handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
    Dataset const data(H5Dopen2(handle.get(), name.c_str(), H5P_DEFAULT));
    Space const space(H5Dget_space(data.get()));
    std::vector<Value> values(
        static_cast<std::size_t>(std::max<hssize_t>(0, H5Sget_simple_extent_npoints(space.get()))));
    EXPECT_GE(H5Dread(data.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0) << name;
    return values;
}
std::vector<double> numbers(std::string const& file, std::string const& name) {
    return read<double>(file, name, H5T_NATIVE_DOUBLE);
}
std::vector<std::int64_t> steps(std::string const& file) {
    return read<std::int64_t>(file, "particles/trajectory/position/step", H5T_NATIVE_INT64);
}

template <class Values>
std::vector<double> flat(std::vector<Frame> const& frames, Values values) {
    std::vector<double> all;
    for (Frame const& frame : frames)
        for (auto const& entry : values(frame)) {
            auto const* const first = reinterpret_cast<double const*>(&entry);
            all.insert(all.end(), first, first + sizeof entry / sizeof(double));
        }
    return all;
}

void expect_same_bits(std::vector<double> const& a, std::vector<double> const& b) {
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(double)), 0);
}

void write_frames(std::string const& file, std::vector<std::int64_t> const& frames,
                  std::optional<std::int64_t> after = {}) {
    Topology const topology = sample_topology();
    auto const trajectory = make_trajectory(file, topology, true, true, after);
    for (std::int64_t const step : frames) trajectory->write(sample_frame(step, topology));
    trajectory->close();
}

TEST(Trajectory, ReadsBackBitForBit) {
    TemporaryFolder const folder;
    std::string const file = folder / "trajectory.h5md";
    write_frames(file, {0, 10, 20});
    Topology const topology = sample_topology();
    std::vector<Frame> const frames{sample_frame(0, topology), sample_frame(10, topology),
                                    sample_frame(20, topology)};

    EXPECT_EQ(steps(file), (std::vector<std::int64_t>{0, 10, 20}));
    expect_same_bits(numbers(file, "particles/trajectory/position/time"),
                     {frames[0].time, frames[1].time, frames[2].time});
    expect_same_bits(numbers(file, "particles/trajectory/position/value"),
                     flat(frames, [](Frame const& f) { return f.positions; }));
    expect_same_bits(numbers(file, "particles/trajectory/velocity/value"),
                     flat(frames, [](Frame const& f) { return f.velocities; }));
    expect_same_bits(numbers(file, "catena/orientation/value"),
                     flat(frames, [](Frame const& f) { return f.orientations; }));
    auto const half = [](std::vector<Vector<double, 6>> Frame::* wrenches, std::size_t first) {
        return [wrenches, first](Frame const& frame) {
            std::vector<Vec3> part;
            for (auto const& w : frame.*wrenches)
                part.push_back({{w.data[first], w.data[first + 1], w.data[first + 2]}});
            return part;
        };
    };
    expect_same_bits(numbers(file, "catena/joint_torque/value"),
                     flat(frames, half(&Frame::joint_forces, 0)));
    expect_same_bits(numbers(file, "catena/joint_force/value"),
                     flat(frames, half(&Frame::joint_forces, 3)));
    expect_same_bits(numbers(file, "catena/tip_torque/value"),
                     flat(frames, half(&Frame::tip_forces, 0)));
    expect_same_bits(numbers(file, "catena/tip_force/value"),
                     flat(frames, half(&Frame::tip_forces, 3)));
    EXPECT_EQ((read<std::int64_t>(file, "catena/tip_force/chain", H5T_NATIVE_INT64)),
              (std::vector<std::int64_t>{0, 1}));
    expect_same_bits(numbers(file, "particles/trajectory/mass"), topology.mass);
    expect_same_bits(numbers(file, "particles/trajectory/box/edges/value"),
                     {10, 11, 12, 10, 11, 12, 10, 11, 12});
    EXPECT_EQ((read<std::int64_t>(file, "catena/orientation/site", H5T_NATIVE_INT64)),
              (std::vector<std::int64_t>{5, 6, 7}));
}

TEST(Trajectory, EveryElementHasTheSameStepDataset) {
    TemporaryFolder const folder;
    std::string const file = folder / "trajectory.h5md";
    write_frames(file, {0, 5});
    for (char const* element : {"particles/trajectory/velocity", "particles/trajectory/box/edges",
                                "catena/orientation", "catena/joint_force", "catena/tip_force"}) {
        EXPECT_EQ((read<std::int64_t>(file, std::string(element) + "/step", H5T_NATIVE_INT64)),
                  (std::vector<std::int64_t>{0, 5}))
            << element;
        EXPECT_EQ(numbers(file, std::string(element) + "/time"), (std::vector<double>{0, 0.5}))
            << element;
    }
}

TEST(Trajectory, WithoutBoxVelocitiesAndForcesTheseAreAbsent) {
    TemporaryFolder const folder;
    std::string const file = folder / "trajectory.h5md";
    Topology topology = sample_topology();
    topology.chains.pop_back();
    topology.mass.resize(5);
    topology.residue.resize(5);
    topology.bodies.clear();
    topology.tips.clear();
    topology.box.reset();
    auto const trajectory = make_trajectory(file, topology, false, false, {});
    trajectory->write(sample_frame(1, topology));
    trajectory->close();
    File const handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
    for (char const* absent : {"particles/trajectory/velocity", "particles/trajectory/box/edges",
                               "catena/orientation", "catena/joint_force", "catena/tip_force"})
        EXPECT_EQ(H5Lexists(handle.get(), absent, H5P_DEFAULT), 0) << absent;
    EXPECT_EQ(H5Lexists(handle.get(), "particles/trajectory/box", H5P_DEFAULT), 1);
}

TEST(Trajectory, UnitsAreTheScenes) {
    TemporaryFolder const folder;
    for (bool const si : {false, true}) {
        std::string const file = folder / "trajectory.h5md";
        Topology topology = sample_topology();
        topology.si = si;
        make_trajectory(file, topology, true, true, {})->close();
        File const handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
        auto const unit = [&](char const* object) {
            Object const owner(H5Oopen(handle.get(), object, H5P_DEFAULT));
            Attribute const attribute(H5Aopen(owner.get(), "unit", H5P_DEFAULT));
            Type const type(H5Aget_type(attribute.get()));
            EXPECT_GT(H5Tis_variable_str(type.get()), 0)
                << "MDAnalysis refuses units of fixed length";
            EXPECT_EQ(H5Tget_cset(type.get()), H5T_CSET_UTF8);
            char* text = nullptr;
            H5Aread(attribute.get(), type.get(), static_cast<void*>(&text));
            std::string const copy = text;
            H5free_memory(text);
            return copy;
        };
        EXPECT_EQ(unit("particles/trajectory/position/value"), si ? "m" : "nm");
        EXPECT_EQ(unit("particles/trajectory/position/time"), si ? "s" : "ps");
        EXPECT_EQ(unit("particles/trajectory/velocity/value"), si ? "m s-1" : "nm ps-1");
        EXPECT_EQ(unit("particles/trajectory/box/edges/value"), si ? "m" : "nm");
        EXPECT_EQ(unit("particles/trajectory/mass"), si ? "kg" : "u");
        EXPECT_EQ(unit("catena/joint_force/value"), si ? "N" : "kJ mol-1 nm-1");
        EXPECT_EQ(unit("catena/joint_torque/value"), si ? "N m" : "kJ mol-1");
    }
}

TEST(Trajectory, RestartCutsLaterFramesAndGoesOn) {
    TemporaryFolder const folder;
    std::string const file = folder / "trajectory.h5md",
                      uninterrupted = folder / "uninterrupted.h5md";
    write_frames(uninterrupted, {0, 10, 20, 30, 40, 50});
    write_frames(file, {0, 10, 20, 30, 35});
    write_frames(file, {30, 40, 50}, 29);
    EXPECT_EQ(steps(file), (std::vector<std::int64_t>{0, 10, 20, 30, 40, 50}));
    for (char const* name : {"particles/trajectory/position/value",
                             "particles/trajectory/velocity/value", "catena/orientation/value",
                             "catena/joint_force/value", "particles/trajectory/position/time"})
        expect_same_bits(numbers(file, name), numbers(uninterrupted, name));
}

TEST(Trajectory, RestartAtAFramesOwnStepKeepsItAndBeforeAllKeepsNone) {
    TemporaryFolder const folder;
    std::string const file = folder / "trajectory.h5md";
    write_frames(file, {0, 10, 20});
    write_frames(file, {}, 10);
    EXPECT_EQ(steps(file), (std::vector<std::int64_t>{0, 10}));
    write_frames(file, {0}, -1);
    EXPECT_EQ(steps(file), (std::vector<std::int64_t>{0}));
}

TEST(Trajectory, AKilledRunLeavesAllFlushedFrames) {
    TemporaryFolder const folder;
    std::string const file = folder / "trajectory.h5md";
    pid_t const child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        Topology const topology = sample_topology();
        auto const trajectory = make_trajectory(file, topology, true, true, {});
        for (std::int64_t step = 0; step < 4000; ++step) {
            trajectory->write(sample_frame(step, topology));
            if (step == 1499) trajectory->flush();
        }
        ::kill(::getpid(), SIGKILL);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
    ASSERT_GE(steps(file).size(), 1500U);
    write_frames(file, {1500, 1501}, 1499);
    auto const all = steps(file);
    ASSERT_EQ(all.size(), 1502U);
    for (std::size_t k = 0; k < all.size(); ++k) ASSERT_EQ(all[k], static_cast<std::int64_t>(k));
    Topology const topology = sample_topology();
    auto const positions = numbers(file, "particles/trajectory/position/value");
    for (std::int64_t const step : {0, 750, 1499, 1501}) {
        auto const expected =
            flat({sample_frame(step, topology)}, [](Frame const& f) { return f.positions; });
        auto const from = positions.begin() + static_cast<std::ptrdiff_t>(expected.size()) * step;
        expect_same_bits({from, from + static_cast<std::ptrdiff_t>(expected.size())}, expected);
    }
}

TEST(Trajectory, RefusesWhatItDidNotWrite) {
    TemporaryFolder const folder;
    std::string const file = folder / "trajectory.h5md";
    Topology const topology = sample_topology();
    auto const restart = [&](Topology const& with, bool velocities = true) {
        return message_of([&] {
            try {
                make_trajectory(file, with, velocities, true, 0);
            } catch (ComputationError const& error) {
                FAIL() << "not the user's fault: " << error.what();
            }
        });
    };
    EXPECT_EQ(restart(topology), "there is no trajectory to continue (" + file +
                                     "): restore it, or " + Continuation::way_beside);
    std::ofstream(file) << "no HDF5 at all";
    EXPECT_NE(restart(topology).find("cannot be opened"), std::string::npos) << restart(topology);
    File(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)).close();
    EXPECT_NE(restart(topology).find("was not written by Catena"), std::string::npos)
        << restart(topology);
    write_frames(file, {0, 10});
    EXPECT_NE(restart(topology, false).find("contains velocities that this run does not write"),
              std::string::npos)
        << restart(topology, false);
    Topology larger = topology;
    larger.mass.push_back(1);
    ++larger.chains[1].count;
    EXPECT_NE(restart(larger).find("has 8 sites but the scene 9"), std::string::npos)
        << restart(larger);
    Topology open = topology;
    open.box.reset();
    EXPECT_NE(restart(open).find("contains box edges that this run does not write"),
              std::string::npos)
        << restart(open);
    Topology si = topology;
    si.si = true;
    EXPECT_NE(restart(si).find("is in nm"), std::string::npos) << restart(si);
    EXPECT_EQ(steps(file), (std::vector<std::int64_t>{0, 10}))
        << "a refused restart changed the file";
}

/// As a frame comes from several ranks: cut where one likes, bodies with their sites.
TEST(Trajectory, PartsMakeTheWholeFrame) {
    TemporaryFolder const folder;
    Topology const topology = sample_topology();  // sites 5 to 7 are the bodies
    Frame const whole = sample_frame(10, topology);
    write_frames(folder / "whole.h5md", {10});
    auto const trajectory = make_trajectory(folder / "parts.h5md", topology, true, true, {});
    EXPECT_THROW(
        {
            trajectory->begin(10, whole.time);
            trajectory->end(whole.tip_forces);
        },
        ComputationError)
        << "no part of it";
    trajectory->begin(10, whole.time);
    for (std::size_t const first : {0, 3, 6}) {
        std::size_t const end = std::min<std::size_t>(first + 3, 8);
        auto const cut = [](auto const& from, std::size_t a, std::size_t b) {
            return std::decay_t<decltype(from)>(from.begin() + static_cast<std::ptrdiff_t>(a),
                                                from.begin() + static_cast<std::ptrdiff_t>(b));
        };
        Frame part;
        part.first_site = first;
        part.first_body = first < 5 ? 0 : first - 5;
        part.positions = cut(whole.positions, first, end);
        part.velocities = cut(whole.velocities, first, end);
        part.joint_forces = cut(whole.joint_forces, first, end);
        part.orientations = cut(whole.orientations, part.first_body, end < 5 ? 0 : end - 5);
        trajectory->put(part);
        EXPECT_THROW(trajectory->put(part), ComputationError) << "the same part twice";
    }
    trajectory->end(whole.tip_forces);
    trajectory->close();
    EXPECT_EQ(steps(folder / "parts.h5md"), (std::vector<std::int64_t>{10}));
    for (char const* const name :
         {"particles/trajectory/position/value", "particles/trajectory/velocity/value",
          "catena/orientation/value", "catena/joint_force/value", "catena/joint_torque/value",
          "catena/tip_force/value"})
        EXPECT_EQ(numbers(folder / "parts.h5md", name), numbers(folder / "whole.h5md", name))
            << name;
}

TEST(Trajectory, RefusesFramesThatDoNotFit) {
    TemporaryFolder const folder;
    Topology const topology = sample_topology();
    auto const trajectory = make_trajectory(folder / "trajectory.h5md", topology, true, true, {});
    Frame frame = sample_frame(10, topology);
    trajectory->write(frame);
    EXPECT_THROW(trajectory->write(frame), ComputationError) << "the same step twice";
    frame.step = 11;
    frame.orientations.pop_back();
    EXPECT_THROW(trajectory->write(frame), ComputationError);
    frame = sample_frame(11, topology);
    frame.positions.pop_back();
    EXPECT_THROW(trajectory->write(frame), ComputationError);
    trajectory->write(sample_frame(12, topology));
    trajectory->close();
    EXPECT_EQ(steps(folder / "trajectory.h5md"), (std::vector<std::int64_t>{10, 12}));
}

TEST(Trajectory, AFolderThatIsMissingIsNamed) {
    TemporaryFolder const folder;
    std::string const file = folder / "missing/trajectory.h5md";
    std::string const message =
        message_of([&] { make_trajectory(file, sample_topology(), true, true, {}); });
    EXPECT_EQ(message, "cannot write the trajectory (" + file + "): No such file or directory");
}

}  // namespace
}  // namespace catena::test
