// A disk that is full must never look like success: HDF5 reports it at flushes and at no other
// place.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "error.hpp"
#include "sample_frames.hpp"
#include "small_disk.hpp"
#include "temporary_folder.hpp"

namespace catena::test {
namespace {

/// Files of this process end at `bytes` while it lives.
class FileSizeLimit {
  public:
    explicit FileSizeLimit(rlim_t bytes) {
        ::signal(SIGXFSZ, SIG_IGN);
        ::getrlimit(RLIMIT_FSIZE, &before_);
        rlimit const limited{bytes, before_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limited);
    }
    FileSizeLimit(FileSizeLimit const&) = delete;
    FileSizeLimit& operator=(FileSizeLimit const&) = delete;
    ~FileSizeLimit() { ::setrlimit(RLIMIT_FSIZE, &before_); }

  private:
    rlimit before_{};
};

Checkpoint checkpoint_of(std::size_t doubles) {
    Checkpoint checkpoint;
    checkpoint.step = static_cast<std::int64_t>(doubles);
    checkpoint.arrays["positions"].assign(doubles, 0.25);
    return checkpoint;
}

void expect_failure(std::string const& message, std::string const& begin,
                    std::string const& cause) {
    EXPECT_TRUE(message.starts_with(begin) && message.ends_with("): " + cause)) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

/// Writes frames, flushing now and then, until something is thrown.
std::string fill_with_frames(std::string const& file, bool flushing) {
    Topology const topology = sample_topology();
    auto const trajectory = make_trajectory(file, topology, true, true, {});
    return message_of([&] {
        for (std::int64_t step = 0; step < 5000; ++step) {
            trajectory->write(sample_frame(step, topology));
            if (flushing && step % 100 == 0) trajectory->flush();
        }
        trajectory->close();
    });
}

TEST(DiskFull, CheckpointIsNoSuccessAndTheOneBeforeStays) {
    SmallDisk const disk;
    NEEDS_SMALL_DISK(disk);
    std::string const file = disk / "checkpoint.h5";
    write_checkpoint(file, checkpoint_of(10));
    for (std::size_t const doubles : {50000, 51000, 60000, 1000000})
        expect_failure(message_of([&] { write_checkpoint(file, checkpoint_of(doubles)); }),
                       "cannot write the checkpoint (" + file, "No space left on device");
    EXPECT_EQ(read_checkpoint(file).arrays, checkpoint_of(10).arrays);
    EXPECT_FALSE(std::filesystem::exists(file + ".writing"))
        << "the draft goes on filling the disk";
}

TEST(DiskFull, TrajectoryIsNoSuccess) {
    for (bool const flushing : {true, false}) {
        SmallDisk const disk;
        NEEDS_SMALL_DISK(disk);
        std::string const file = disk / "trajectory.h5md";
        expect_failure(fill_with_frames(file, flushing), "cannot write the trajectory (" + file,
                       "No space left on device");
    }
}

TEST(DiskFull, TextAndTableAreNoSuccess) {
    SmallDisk const disk;
    NEEDS_SMALL_DISK(disk);
    write_text_file(disk / "summary.json", "old");
    EXPECT_EQ(message_of([&] { write_text_file(disk / "summary.json", std::string(500000, 'x')); }),
              "cannot write (" + (disk / "summary.json.writing") + "): No space left on device");
    EXPECT_EQ(std::filesystem::file_size(disk / "summary.json"), 3U) << "the text before is gone";
    EXPECT_FALSE(std::filesystem::exists(disk / "summary.json.writing"));
    ObservablesWriter table(disk / "observables.csv", {"a", "b"}, {});
    std::string const message = message_of([&] {
        for (std::int64_t step = 0; step < 100000; ++step) table.write(step, 0.1, {0.1, 0.3});
    });
    EXPECT_EQ(message,
              "cannot write (" + (disk / "observables.csv") + "): No space left on device");
}

TEST(FileTooLarge, CheckpointAndTrajectoryAreNoSuccess) {
    TemporaryFolder const folder;
    std::string const file = folder / "checkpoint.h5", trajectory = folder / "trajectory.h5md";
    write_checkpoint(file, checkpoint_of(10));
    FileSizeLimit const limit(100000);
    expect_failure(message_of([&] { write_checkpoint(file, checkpoint_of(20000)); }),
                   "cannot write the checkpoint (" + file, "File too large");
    EXPECT_EQ(read_checkpoint(file).arrays, checkpoint_of(10).arrays);
    EXPECT_FALSE(std::filesystem::exists(file + ".writing"));
    expect_failure(fill_with_frames(trajectory, true), "cannot write the trajectory (" + trajectory,
                   "File too large");
}

TEST(DeviceFull, TableIsNoSuccess) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "NOT RUN: no /dev/full here";
    EXPECT_EQ(message_of([] { ObservablesWriter("/dev/full", {"a"}, {}).close(); }),
              "cannot write (/dev/full): No space left on device");
    EXPECT_EQ(message_of([] { write_text_file("/dev/full", "text"); }),
              "cannot write (/dev/full): No space left on device");
}

}  // namespace
}  // namespace catena::test
