// 64-bit checksums, of a stream of words and of words at their places. One round is that of
// xxHash64 (Y. Collet, https://xxhash.com): for a given state it maps words one to one, so a change
// of any single word is always seen.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace catena {

class Checksum {
  public:
    void add(std::uint64_t word) {
        state_ = std::rotl(state_ + word * 0xC2B2AE3D27D4EB4FULL, 31) * 0x9E3779B185EBCA87ULL;
        ++words_;
    }
    void add(std::int64_t value) { add(static_cast<std::uint64_t>(value)); }
    void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
    /// Its length first, so that ["ab", "c"] and ["a", "bc"] differ.
    void add(std::string_view text) {
        add(std::uint64_t{text.size()});
        for (std::size_t at = 0; at < text.size(); at += sizeof(std::uint64_t)) {
            std::uint64_t word = 0;
            std::memcpy(&word, text.data() + at, std::min(sizeof word, text.size() - at));
            add(word);
        }
    }
    std::uint64_t value() const {
        std::uint64_t mixed = state_ + words_;
        mixed = (mixed ^ (mixed >> 33)) * 0xC2B2AE3D27D4EB4FULL;
        mixed = (mixed ^ (mixed >> 29)) * 0x165667B19E3779F9ULL;
        return mixed ^ (mixed >> 32);
    }

  private:
    std::uint64_t state_ = 0x27D4EB2F165667C5ULL, words_ = 0;
};

/// Of a word at its place, mixed one to one: a change of any single word is always seen in the sum
/// over all places, and neither who adds which words nor in which order matters. The rounds are
/// those above.
inline std::uint64_t checksum_at(std::uint64_t place, std::uint64_t word) {
    Checksum sum;
    sum.add(place);
    sum.add(word);
    return sum.value();
}

}  // namespace catena
