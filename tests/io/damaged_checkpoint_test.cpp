// Every byte of a checkpoint may be wrong. HDF5 reads beyond its buffers on some damaged files, so
// none must come before it.
#include <gtest/gtest.h>

#include "sample_checkpoint.hpp"

namespace catena::test {
namespace {

/// A flipped bit anywhere either changes nothing that is read or is refused as the user's input; it
/// never goes through.
TEST(DamagedCheckpoint, NoFlippedBitGoesThrough) {
    TemporaryFolder const folder;
    std::string const file = folder / "checkpoint.h5";
    write_checkpoint(file, sample());
    std::string const good = bytes_of(file);
    std::size_t refused = 0;
    for (std::size_t at = 0; at < good.size(); at += 7) {
        std::string bad = good;
        bad[at] = static_cast<char>(bad[at] ^ (1 << (at / 7 % 8)));
        put_bytes(file, bad);
        try {
            expect_same(read_checkpoint(file), sample());
        } catch (InputError const&) {
            ++refused;
        }
        ASSERT_FALSE(HasFailure()) << "byte " << at;
    }
    EXPECT_GT(refused, sample().arrays["velocities"].size()) << "of " << good.size() / 7;
}

TEST(DamagedCheckpoint, CutShortIsRefused) {
    TemporaryFolder const folder;
    std::string const file = folder / "checkpoint.h5";
    write_checkpoint(file, sample());
    std::string const good = bytes_of(file);
    for (std::size_t length = 0; length < good.size(); length += 97) {
        put_bytes(file, good.substr(0, length));
        ASSERT_NE(refusal(file), "read without complaint")
            << length << " of " << good.size() << " bytes";
    }
    put_bytes(file, good.substr(0, good.size() - 1));
    EXPECT_NE(refusal(file).find("cut short"), std::string::npos) << refusal(file);
}

}  // namespace
}  // namespace catena::test
