// A checkpoint that all ranks write together holds the same bits as one that the root writes, and
// is as safe.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "dataset_bits.hpp"
#include "mpi/first_rank.hpp"
#include "ranks_that_write.hpp"
#include "sample_checkpoint.hpp"
#include "small_disk.hpp"

namespace catena::test {
namespace {

using catena::testing::world;

using Sizes = std::map<std::string, std::int64_t>;
/// Numbers of the arrays that ranks bring: one of them shorter than ranks are many, one empty.
Sizes const usual{{"few", 2}, {"many", 100'003}, {"none", 0}};
double number(std::string const& array, std::int64_t i) {
    return static_cast<double>(array.size()) + 1 / (1.0 + static_cast<double>(i));
}

class CheckpointOfRanks : public ::testing::Test {
  protected:
    void TearDown() override {
        ::unsetenv("CATENA_HDF5");
        world().barrier();
    }
    std::string path(std::string const& name) const { return of_root(folder_ / name); }
    TemporaryFolder folder_;
};

/// Runs of so many numbers are each rank's in turn, in two rounds. The run with number `but` of an
/// array is left out.
void put_own(CheckpointWriter& writer, Sizes const& sizes, std::int64_t run,
             std::int64_t but = -1) {
    bool const together = writer.way().collective;
    if (!together && world().rank() != 0) return;
    std::int64_t const first = together ? world().rank() : 0, every = together ? world().size() : 1;
    for (auto const& [name, size] : sizes) {
        std::vector<std::vector<double>> values;
        std::vector<ArrayPart> parts;
        for (std::int64_t r = first; r * run < size; r += every) {
            if (r == but) continue;
            values.emplace_back();
            for (std::int64_t i = r * run; i < std::min(size, (r + 1) * run); ++i)
                values.back().push_back(number(name, i));
            parts.push_back({r * run, values.back()});
        }
        std::size_t const half = parts.size() / 2;
        writer.put(name, std::span(parts).first(half));
        writer.put(name, std::span(parts).subspan(half));
    }
}
std::string write(std::string const& file, Checkpoint const& checkpoint, std::int64_t run,
                  Sizes const& sizes = usual) {
    CheckpointWriter writer(world(), file, checkpoint, sizes);
    put_own(writer, sizes, run);
    writer.finish();
    return writer.way().text;
}
Checkpoint whole(Checkpoint checkpoint, Sizes const& sizes = usual) {
    for (auto const& [name, size] : sizes) {
        std::vector<double>& values = checkpoint.arrays[name];
        for (std::int64_t i = 0; i < size; ++i) values.push_back(number(name, i));
    }
    return checkpoint;
}
std::string together() { return "collective, " + std::to_string(world().size()) + " ranks"; }
/// What `action` throws on this rank, as every rank's error.
template <class Action>
std::string shared_error_of(Action const& action) {
    try {
        action();
    } catch (SharedError const& error) {
        return error.what();
    }
    return "nothing thrown";
}

TEST_F(CheckpointOfRanks, HoldsTheBitsOfOneWriter) {
    std::string const root = path("root.h5"), whole_at_once = path("at-once.h5");
    EXPECT_EQ(write(root, sample(), 1000),
              world().size() == 1 ? "by the root" : "by the root: arrays are small");
    if (world().rank() == 0) {
        expect_same(read_checkpoint(root), whole(sample()));
        write_checkpoint(whole_at_once, whole(sample()));
        EXPECT_TRUE(bits_of(whole_at_once) == bits_of(root));
    }
    NEEDS_PARALLEL_HDF5;
    ::setenv("CATENA_HDF5", "collective", 1);
    for (std::int64_t const run :
         {1000, 40'000, 200'000}) {  // many a rank, some without any, all one rank's
        std::string const file = path("together" + std::to_string(run) + ".h5");
        EXPECT_EQ(write(file, sample(), run), together());
        if (world().rank() != 0) continue;
        expect_same(read_checkpoint(file), whole(sample()));
        EXPECT_TRUE(bits_of(file) == bits_of(root)) << run;
        EXPECT_FALSE(std::filesystem::exists(file + ".writing"));
    }
}

/// Several pieces of the seal a rank, several of an array.
TEST_F(CheckpointOfRanks, LargeOnesAreWrittenTogetherUnasked) {
    NEEDS_PARALLEL_HDF5;
    Sizes const large{{"many", 3'000'001}};
    std::string const file = path("large.h5"), root = path("root.h5");
    EXPECT_EQ(write(file, sample(), 70'001, large), together());
    ::setenv("CATENA_HDF5", "root", 1);
    EXPECT_EQ(write(root, sample(), 70'001, large), "by the root: CATENA_HDF5 says so");
    if (world().rank() != 0) return;
    expect_same(read_checkpoint(file), whole(sample(), large));
    EXPECT_TRUE(bits_of(file) == bits_of(root));
}

TEST_F(CheckpointOfRanks, KeepsTheOneBefore) {
    for (char const* const way : {"root", "collective"}) {
        if (way == std::string("collective") && !can_write_together()) continue;
        ::setenv("CATENA_HDF5", way, 1);
        std::string const file = path(std::string(way) + "/checkpoint.h5");
        if (world().rank() == 0) std::filesystem::create_directory(folder_ / way);
        for (std::int64_t const step : {100, 200}) write(file, sample(step), 1000);
        {
            CheckpointWriter left(world(), file, sample(300), usual);
            put_own(left, usual, 1000);
        }
        world().barrier();
        if (world().rank() != 0) continue;
        EXPECT_EQ(read_checkpoint(file).step, 200);
        EXPECT_EQ(read_checkpoint(folder_ / (std::string(way) + "/checkpoint.previous.h5")).step,
                  100);
        EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_ / way), {}), 2)
            << "what was not finished is gone";
    }
}

TEST_F(CheckpointOfRanks, WhatNobodyBroughtIsMissed) {
    for (char const* const way : {"root", "collective"}) {
        if (way == std::string("collective") && !can_write_together()) continue;
        ::setenv("CATENA_HDF5", way, 1);
        std::string const file = path("checkpoint.h5");
        write(file, sample(100), 1000);
        std::string const message = shared_error_of([&] {
            CheckpointWriter writer(world(), file, sample(200), usual);
            put_own(writer, usual, 1000, 77);
            writer.finish();
        });
        EXPECT_EQ(message,
                  "cannot write the checkpoint (" + file +
                      "): it does not read back, its checksum does not match its contents");
        world().barrier();
        if (world().rank() != 0) continue;
        EXPECT_EQ(read_checkpoint(file).step, 100);
        EXPECT_FALSE(std::filesystem::exists(file + ".writing"));
    }
}

/// What fails on the root alone while parts come is told at the end, to all.
TEST_F(CheckpointOfRanks, APartThatFitsNoArrayIsEveryRanksErrorAtTheEnd) {
    ::setenv("CATENA_HDF5", "root", 1);
    std::string const file = path("checkpoint.h5");
    std::string const message = shared_error_of([&] {
        CheckpointWriter writer(world(), file, sample(), usual);
        std::vector<double> const values(10, 0.5);
        ArrayPart const part{usual.at("many") - 5, values};
        if (world().rank() == 0) writer.put("many", std::span(&part, 1));
        writer.finish();
    });
    EXPECT_TRUE(message.starts_with("cannot write the checkpoint (" + file + "): ")) << message;
    world().barrier();
    EXPECT_FALSE(std::filesystem::exists(file) || std::filesystem::exists(file + ".writing"));
}

TEST_F(CheckpointOfRanks, AFullDiskIsEveryRanksErrorBeforeNumbersAreWritten) {
    for (char const* const way : {"root", "collective"}) {
        if (way == std::string("collective") && !can_write_together()) continue;
        ::setenv("CATENA_HDF5", way, 1);
        std::unique_ptr<SmallDisk> disk;
        if (world().rank() == 0) disk = std::make_unique<SmallDisk>(1500);  // room for one
        if (world().sum(disk && disk->mounted() ? 1 : 0) == 0)
            GTEST_SKIP() << "NOT RUN: mounting a small disk needs root";
        std::string const file = of_root(disk ? *disk / "checkpoint.h5" : "");
        write(file, sample(100), 1000);
        EXPECT_EQ(shared_error_of([&] { CheckpointWriter(world(), file, sample(200), usual); }),
                  "cannot write the checkpoint (" + file + "): No space left on device");
        world().barrier();
        if (world().rank() == 0) {
            EXPECT_EQ(read_checkpoint(file).step, 100);
            EXPECT_FALSE(std::filesystem::exists(file + ".writing"));
        }
        world().barrier();
    }
}

TEST_F(CheckpointOfRanks, WhatIsNoNameIsEveryRanksError) {
    std::string const file = path("checkpoint.h5");
    EXPECT_THROW(CheckpointWriter(world(), file, sample(), {{"a/b", 3}}), SharedError);
    world().barrier();
    EXPECT_FALSE(std::filesystem::exists(file + ".writing"));
}

}  // namespace
}  // namespace catena::test
