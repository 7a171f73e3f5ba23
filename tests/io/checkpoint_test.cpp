#include <gtest/gtest.h>

#include "io/file_seal.hpp"
#include "sample_checkpoint.hpp"

namespace catena::test {
namespace {

TEST(Checkpoint, ReadsBackBitForBit) {
    TemporaryFolder const folder;
    write_checkpoint(folder / "checkpoint.h5", sample());
    expect_same(read_checkpoint(folder / "checkpoint.h5"), sample());
    EXPECT_FALSE(std::filesystem::exists(folder / "checkpoint.h5.writing"));
    EXPECT_FALSE(std::filesystem::exists(folder / "checkpoint.previous.h5"));
}

TEST(Checkpoint, KeepsTheOneBefore) {
    TemporaryFolder const folder;
    std::string const file = folder / "checkpoint.h5";
    for (std::int64_t const step : {100, 200, 300}) write_checkpoint(file, sample(step));
    expect_same(read_checkpoint(file), sample(300));
    expect_same(read_checkpoint(folder / "checkpoint.previous.h5"), sample(200));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2);
}

/// A run that ended between the renames left both names to one file: it is kept, and nothing else.
TEST(Checkpoint, OneFileOfBothNamesIsTheOneBefore) {
    TemporaryFolder const folder;
    std::string const file = folder / "checkpoint.h5";
    write_checkpoint(file, sample(100));
    std::filesystem::create_hard_link(file, folder / "checkpoint.previous.h5");
    write_checkpoint(file, sample(200));
    expect_same(read_checkpoint(file), sample(200));
    expect_same(read_checkpoint(folder / "checkpoint.previous.h5"), sample(100));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2);
}

TEST(Checkpoint, LeftoversOfAKilledRunDoNotDisturb) {
    TemporaryFolder const folder;
    std::string const file = folder / "checkpoint.h5";
    write_checkpoint(file, sample(100));
    put_bytes(file + ".writing", "half");
    put_bytes(folder / "checkpoint.previous.h5.writing", "half");
    write_checkpoint(file, sample(200));
    expect_same(read_checkpoint(file), sample(200));
    expect_same(read_checkpoint(folder / "checkpoint.previous.h5"), sample(100));
}

TEST(Checkpoint, OneAlteredNumberIsSeen) {
    TemporaryFolder const folder;
    std::string const file = folder / "checkpoint.h5";
    write_checkpoint(file, sample());
    std::string bytes = bytes_of(file);
    double const number = 1e308;
    auto const at = bytes.find(std::string(reinterpret_cast<char const*>(&number), sizeof number));
    ASSERT_NE(at, std::string::npos);
    bytes[at] = static_cast<char>(bytes[at] ^ 1);
    put_bytes(file, bytes);
    EXPECT_EQ(refusal(file),
              "the checkpoint is damaged, its checksum does not match its contents (" + file +
                  "): start anew");
    put_bytes(folder / "checkpoint.previous.h5", "");
    EXPECT_NE(refusal(file).find("use the previous one, " + (folder / "checkpoint.previous.h5")),
              std::string::npos)
        << refusal(file);
}

/// What is damaged never comes before HDF5, so neither do its errors.
TEST(Checkpoint, DamageIsSeenBeforeHdf5) {
    TemporaryFolder const folder;
    std::string const file = folder / "checkpoint.h5";
    write_checkpoint(file, sample());
    std::string const good = bytes_of(file);
    EXPECT_TRUE(good.starts_with("Catena, sealed file: " + std::to_string(good.size() - 512) +
                                 " bytes, checksum by places "))
        << good.substr(0, 80);
    EXPECT_EQ(good.substr(512, 4), "\x89HDF");
    put_bytes(file, good + "more");
    EXPECT_EQ(refusal(file),
              "the checkpoint is damaged, its checksum does not match its contents (" + file +
                  "): start anew");
    put_bytes(file, good.substr(0, 600));
    EXPECT_EQ(refusal(file), "the checkpoint is damaged, cut short, 600 of " +
                                 std::to_string(good.size()) + " bytes (" + file + "): start anew");
    put_bytes(file, good.substr(0, 100));
    EXPECT_NE(refusal(file).find("cut short, 100 of"), std::string::npos) << refusal(file);
    std::string seal = "Catena, sealed file: 99999999999999999999999 bytes, checksum by places 0";
    seal.resize(512);
    put_bytes(file, seal + good.substr(512));
    EXPECT_NE(refusal(file).find("cut short"), std::string::npos) << refusal(file);
    std::string earlier = "Catena, sealed file: " + std::to_string(good.size() - 512) +
                          " bytes, checksum 0123456789abcdef\n";
    earlier.resize(512);
    put_bytes(file, earlier + good.substr(512));
    EXPECT_EQ(refusal(file), "a checkpoint of another version of Catena (" + file +
                                 "): restart with the version that wrote it");
    // What is left of this version's words is no earlier one's.
    std::string broken = good;
    broken[broken.find("by places")] = 'x';
    put_bytes(file, broken);
    EXPECT_NE(refusal(file).find("the checkpoint is damaged, its checksum"), std::string::npos)
        << refusal(file);
    put_bytes(file, good.substr(0, good.find("by places") + 3));
    EXPECT_NE(refusal(file).find("the checkpoint is damaged, cut short"), std::string::npos)
        << refusal(file);
    put_bytes(file, good.substr(512));
    EXPECT_NE(refusal(file).find("one of an earlier version"), std::string::npos) << refusal(file);
    EXPECT_NE(refusal(file).find("restart with the version that wrote it"), std::string::npos)
        << refusal(file);
    put_bytes(file, std::string(4096, '\0'));
    EXPECT_NE(refusal(file).find("not a checkpoint of Catena, or damaged"), std::string::npos)
        << refusal(file);
    EXPECT_NE(refusal(file).find("name the checkpoint.h5 of a run"), std::string::npos)
        << refusal(file);
    put_bytes(folder / "checkpoint.previous.h5", good);
    for (std::string const& bytes : {std::string(4096, '\0'), std::string()}) {
        put_bytes(file, bytes);
        EXPECT_NE(
            refusal(file).find("use the previous one, " + (folder / "checkpoint.previous.h5")),
            std::string::npos)
            << refusal(file);
    }
}

TEST(Checkpoint, TwoFlippedSignsAreSeen) {
    TemporaryFolder const folder;
    std::string const file = folder / "checkpoint.h5";
    write_checkpoint(file, sample());
    std::string bytes = bytes_of(file);
    double const third[] = {1 / 3.0, 1 / 3.0};
    auto const at = bytes.find(std::string(reinterpret_cast<char const*>(third), sizeof third));
    ASSERT_NE(at, std::string::npos);
    for (std::size_t const sign : {at + 7, at + 15})
        bytes[sign] = static_cast<char>(bytes[sign] ^ 0x80);
    put_bytes(file, bytes);
    EXPECT_NE(refusal(file).find("checksum"), std::string::npos) << refusal(file);
}

TEST(Seal, PiecesOfSeveralReadersAreThoseOfOne) {
    TemporaryFolder const folder;
    std::string const file = folder / "file";
    std::string bytes(512 + 3 * (4 << 20) + 1001, 'x');
    for (std::size_t i = 0; i < bytes.size(); i += 97) bytes[i] = static_cast<char>(i / 97);
    put_bytes(file, bytes);
    Sealed const whole = sum_pieces(file, 0, 1, file, "look");
    EXPECT_EQ(whole.bytes, static_cast<std::int64_t>(bytes.size()) - seal_size);
    for (int const readers : {2, 3, 6}) {
        Sealed sum;
        for (int reader = 0; reader < readers; ++reader) {
            Sealed const part = sum_pieces(file, reader, readers, file, "look");
            sum.bytes += part.bytes;
            sum.checksum += part.checksum;
        }
        EXPECT_EQ(sum, whole) << readers;
    }
    // Two pieces change places: the same bytes, another file.
    std::string const first = bytes.substr(512, 4 << 20),
                      second = bytes.substr(512 + (4 << 20), 4 << 20);
    put_bytes(file, bytes.substr(0, 512) + second + first + bytes.substr(512 + (8 << 20)));
    EXPECT_NE(sum_pieces(file, 0, 1, file, "look"), whole);
}

TEST(Checkpoint, MissingAndForeignFilesAreRefused) {
    TemporaryFolder const folder;
    EXPECT_EQ(refusal(folder / "none.h5"),
              "no such checkpoint (" + (folder / "none.h5") + "): name the checkpoint.h5 of a run");
    make_trajectory(folder / "trajectory.h5md", {}, false, false, {})->close();
    EXPECT_NE(refusal(folder / "trajectory.h5md").find("not a checkpoint of Catena"),
              std::string::npos);
    EXPECT_EQ(refusal(folder.path()), "a folder, not a checkpoint (" + folder.path() +
                                          "): name the checkpoint.h5 of a run");
}

TEST(Checkpoint, AFolderIsToldTheCheckpointThatItHolds) {
    TemporaryFolder const folder;
    write_checkpoint(folder / "checkpoint.previous.h5", sample());
    auto const expect_named = [&](char const* name) {
        EXPECT_EQ(refusal(folder.path()),
                  "a folder, not a checkpoint (" + folder.path() + "): name " + (folder / name));
    };
    expect_named("checkpoint.previous.h5");
    write_checkpoint(folder / "checkpoint.h5", sample());
    expect_named("checkpoint.h5");
}

TEST(Checkpoint, KeysThatAreNoNamesAreRefused) {
    TemporaryFolder const folder;
    Checkpoint checkpoint = sample();
    checkpoint.arrays["a/b"] = {1};
    EXPECT_THROW(write_checkpoint(folder / "checkpoint.h5", checkpoint), ComputationError);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace catena::test
