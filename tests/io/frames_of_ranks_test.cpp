// A trajectory that all ranks write together holds the same bits as one that a rank writes alone,
// and ends as well.
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "dataset_bits.hpp"
#include "error.hpp"
#include "mpi/first_rank.hpp"
#include "ranks_that_write.hpp"
#include "sample_frames.hpp"
#include "small_disk.hpp"

namespace catena::test {
namespace {

using catena::testing::world;

std::size_t frames_in(std::string const& file) {
    return bits_of(file).at("catena/joint_force/step").size() / 8;
}

class FramesOfRanks : public ::testing::Test {
  protected:
    void TearDown() override {
        ::unsetenv("CATENA_HDF5");
        world().barrier();
    }
    TrajectoryOfRanks make(std::string const& name, Topology const& topology,
                           std::optional<std::int64_t> after = {}) const {
        return make_trajectory(world(), of_root(folder_ / name), topology, true, true, after);
    }
    TemporaryFolder folder_;
};

/// The sample, or so many beads that a frame is cut into several chunks.
Topology topology_of(std::size_t beads) {
    Topology topology = sample_topology();
    if (beads == 0) return topology;
    topology.chains = {{"beads", 0, static_cast<std::int64_t>(beads), true, false}};
    topology.residue.assign(beads, "UNK");
    topology.mass.assign(beads, 1);
    topology.bodies.clear();
    topology.tips.clear();
    return topology;
}

/// What `owner` says is this rank's, one part a run of neighbours.
template <class Owner>
std::vector<Frame> own_parts(Frame const& whole, std::size_t first_body_site, Owner const& owner) {
    std::vector<Frame> parts;
    for (std::size_t site = 0; site < whole.positions.size(); ++site) {
        if (owner(site) != world().rank()) continue;
        bool const goes_on =
            !parts.empty() && parts.back().first_site + parts.back().positions.size() == site;
        if (!goes_on) {
            parts.emplace_back().first_site = site;
            parts.back().first_body = site < first_body_site ? 0 : site - first_body_site;
        }
        parts.back().positions.push_back(whole.positions[site]);
        parts.back().velocities.push_back(whole.velocities[site]);
        parts.back().joint_forces.push_back(whole.joint_forces[site]);
        if (!whole.orientations.empty() && site >= first_body_site)
            parts.back().orientations.push_back(whole.orientations[site - first_body_site]);
    }
    return parts;
}

/// In two rounds, of which a rank may have nothing.
template <class Owner>
void write_own(TrajectoryWriter& writer, Frame const& whole, Topology const& topology,
               Owner const& owner) {
    std::vector<Frame> const parts =
        own_parts(whole, topology.bodies.empty() ? whole.positions.size() : 5, owner);
    std::size_t const half = parts.size() / 2;
    writer.begin(whole.step, whole.time);
    writer.put(std::span(parts).first(half));
    writer.put(std::span(parts).subspan(half));
    writer.end(world().rank() == 0 ? whole.tip_forces : std::vector<Vector<double, 6>>());
}

TEST_F(FramesOfRanks, AreTheBitsOfOneWriter) {
    NEEDS_PARALLEL_HDF5;
    ::setenv("CATENA_HDF5", "collective", 1);
    int const ranks = world().size();
    for (std::size_t const beads : {std::size_t{0}, std::size_t{20000}}) {
        Topology const topology = topology_of(beads);
        std::size_t const sites = topology.mass.size();
        auto const write = [&](std::string const& name, auto const& owner,
                               std::vector<std::int64_t> const& steps,
                               std::optional<std::int64_t> after = {}) {
            TrajectoryOfRanks made = make(name, topology, after);
            EXPECT_EQ(made.way.text, "collective, " + std::to_string(ranks) + " ranks");
            ASSERT_NE(made.writer, nullptr);
            for (std::int64_t const step : steps)
                write_own(*made.writer, sample_frame(step, topology), topology, owner);
            made.writer->close();
        };
        auto const in_turn = [&](std::size_t site) {
            return static_cast<int>(beads == 0 ? site : site / 7777) % ranks;
        };
        auto const in_runs = [&](std::size_t site) {
            return static_cast<int>(site * static_cast<std::size_t>(ranks) / sites);
        };
        auto const last_has_none = [&](std::size_t site) {
            return static_cast<int>(beads == 0 ? site : site / 7777) % (ranks - 1);
        };
        write("turns.h5md", in_turn, {0, 10, 20});
        write("runs.h5md", in_runs, {0, 10, 20});
        write("none.h5md", last_has_none, {0, 10});
        write("none.h5md", in_turn, {10, 20}, 9);
        if (world().rank() != 0) continue;
        auto const alone = make_trajectory(folder_ / "alone.h5md", topology, true, true, {});
        for (std::int64_t const step : {0, 10, 20}) alone->write(sample_frame(step, topology));
        alone->close();
        DatasetBits const expected = bits_of(folder_ / "alone.h5md");
        ASSERT_GT(expected.size(), 10U);
        for (char const* const name : {"turns.h5md", "runs.h5md", "none.h5md"})
            EXPECT_TRUE(bits_of(folder_ / name) == expected) << name << ", " << beads;
        auto const goes_on = make_trajectory(folder_ / "runs.h5md", topology, true, true, 10);
        goes_on->write(sample_frame(20, topology));
        goes_on->close();
        EXPECT_TRUE(bits_of(folder_ / "runs.h5md") == expected) << "gone on with by one writer";
    }
}

TEST_F(FramesOfRanks, WhatWasNotFlushedOrClosedLeavesTheRestWhole) {
    NEEDS_PARALLEL_HDF5;
    ::setenv("CATENA_HDF5", "collective", 1);
    Topology const topology = sample_topology();
    {
        TrajectoryOfRanks const made = make("left.h5md", topology);
        for (std::int64_t step = 0; step < 10; ++step) {
            write_own(*made.writer, sample_frame(step, topology), topology,
                      [](std::size_t site) { return static_cast<int>(site) % 2; });
            if (step == 6) made.writer->flush();
        }
    }
    world().barrier();
    if (world().rank() == 0) {
        EXPECT_EQ(frames_in(folder_ / "left.h5md"), 7U);
    }
}

TEST_F(FramesOfRanks, AFullDiskIsEveryRanksErrorAndLeavesWhatWasFlushed) {
    NEEDS_PARALLEL_HDF5;
    ::setenv("CATENA_HDF5", "collective", 1);
    std::unique_ptr<SmallDisk> disk;
    if (world().rank() == 0) disk = std::make_unique<SmallDisk>(4000);
    if (world().sum(disk && disk->mounted() ? 1 : 0) == 0)
        GTEST_SKIP() << "NOT RUN: mounting a small disk needs root";
    std::string const file = of_root(disk ? *disk / "trajectory.h5md" : "");
    Topology const topology = topology_of(2000);
    std::int64_t flushed = 0;
    std::string message;
    {
        TrajectoryOfRanks const made = make_trajectory(world(), file, topology, true, true, {});
        try {
            for (std::int64_t step = 0; step < 100; ++step) {
                write_own(*made.writer, sample_frame(step, topology), topology,
                          [](std::size_t site) { return site < 900 ? 0 : 1; });
                if (step % 2 == 0) continue;
                made.writer->flush();
                flushed = step + 1;
            }
        } catch (SharedError const& error) {
            message = error.what();
        }
    }
    EXPECT_EQ(message, "cannot write the trajectory (" + file + "): No space left on device");
    world().barrier();
    if (world().rank() == 0) {
        EXPECT_EQ(static_cast<std::int64_t>(frames_in(file)), flushed);
    }
    world().barrier();
}

TEST_F(FramesOfRanks, AreWrittenByTheRootWhereSmallOrAskedFor) {
    if (world().size() == 1) GTEST_SKIP() << "NOT RUN: one rank";
    Topology const topology = sample_topology();
    for (auto const& [word, text] : {std::pair{"", "by the root: frames are small"},
                                     {"root", "by the root: CATENA_HDF5 says so"}}) {
        ::setenv("CATENA_HDF5", word, 1);
        TrajectoryOfRanks const made = make("root.h5md", topology);
        EXPECT_EQ(made.way.text, text);
        EXPECT_EQ(made.writer != nullptr, world().rank() == 0);
    }
}

TEST_F(FramesOfRanks, RefuseWhatTheyCannotDo) {
    Topology const topology = sample_topology();
    ::setenv("CATENA_HDF5", "fast", 1);
    std::string const refused = message_of([&] { make("x.h5md", topology); });
    EXPECT_NE(refused.find("not a way to write files: fast (CATENA_HDF5)"), std::string::npos)
        << refused;
    if (world().size() == 1 || can_write_together()) return;
    ::setenv("CATENA_HDF5", "collective", 1);
    std::string const serial = message_of([&] { make("x.h5md", topology); });
    EXPECT_NE(serial.find("ranks cannot write together, "), std::string::npos) << serial;
}

}  // namespace
}  // namespace catena::test
