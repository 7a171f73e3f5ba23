// Checksums of 64 bits over a stream of words and over words at known positions. One round is that
// of xxHash64 (Y. Collet, https://xxhash.com). A round maps words one to one for a given state, so
// that a change of any single word always changes the checksum.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace catena {

/// Checksum of a stream of 64-bit words. Integers and doubles are added by their bit patterns.
class Checksum {
  public:
    void add(std::uint64_t word) {
        state_ = std::rotl(state_ + word * 0xC2B2AE3D27D4EB4FULL, 31) * 0x9E3779B185EBCA87ULL;
        ++words_;
    }
    void add(std::int64_t value) { add(static_cast<std::uint64_t>(value)); }
    void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
    /// Adds the length before the characters, so that ["ab", "c"] and ["a", "bc"] differ.
    void add(std::string_view text) {
        add(std::uint64_t{text.size()});
        for (std::size_t at = 0; at < text.size(); at += sizeof(std::uint64_t)) {
            std::uint64_t word = 0;
            std::memcpy(&word, text.data() + at, std::min(sizeof word, text.size() - at));
            add(word);
        }
    }
    /// Returns the final mix of the state and the number of words.
    std::uint64_t value() const {
        std::uint64_t mixed = state_ + words_;
        mixed = (mixed ^ (mixed >> 33)) * 0xC2B2AE3D27D4EB4FULL;
        mixed = (mixed ^ (mixed >> 29)) * 0x165667B19E3779F9ULL;
        return mixed ^ (mixed >> 32);
    }

  private:
    std::uint64_t state_ = 0x27D4EB2F165667C5ULL, words_ = 0;
};

/// Checksum of a word at a position, mixed one to one by the rounds above. A change of any single
/// word always changes the sum over all positions. The sum depends neither on which rank adds which
/// words nor on the order.
inline std::uint64_t checksum_at(std::uint64_t place, std::uint64_t word) {
    Checksum sum;
    sum.add(place);
    sum.add(word);
    return sum.value();
}

}  // namespace catena
