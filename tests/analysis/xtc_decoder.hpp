// Reader of the compressed positions of XTC files, written from the format's description and not
// from the writer: what GROMACS, MDAnalysis and mdtraj see.
#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "analysis/xtc_coding.hpp"

namespace catena::test {

using analysis::Lattice;
using analysis::PackedPositions;

/// Decodes the bits of one frame.
class XtcDecoder {
  public:
    explicit XtcDecoder(PackedPositions const& packed) : packed_(packed) {}

    std::vector<Lattice> decode(std::size_t sites) {
        std::array<std::uint64_t, 3> extent{};
        bool large = false;
        for (std::size_t i = 0; i < 3; ++i) {
            extent[i] =
                static_cast<std::uint64_t>(std::int64_t{packed_.most[i]} - packed_.least[i] + 1);
            large = large || extent[i] > 0xffffff;
        }
        int const all = large ? 0 : width(extent);
        int index = packed_.first_size, run = 0;
        std::vector<Lattice> found;
        while (found.size() < sites) {
            Lattice first{};
            std::array<std::uint64_t, 3> place{};
            if (large)
                for (std::size_t i = 0; i < 3; ++i) place[i] = bits(width({extent[i], 1, 1}));
            else
                place = digits(all, extent);
            for (std::size_t i = 0; i < 3; ++i)
                first[i] = static_cast<std::int32_t>(packed_.least[i] +
                                                     static_cast<std::int64_t>(place[i]));
            int change = 0;
            if (bits(1) == 1) {
                run = static_cast<int>(bits(5));
                change = run % 3 - 1;
                run -= run % 3;
            }
            Lattice previous = first;
            if (run == 0) found.push_back(first);
            for (int k = 0; k < run; k += 3) {
                std::uint64_t const size = sizes_.at(static_cast<std::size_t>(index));
                std::array<std::uint64_t, 3> const step = digits(index, {size, size, size});
                Lattice here{};
                for (std::size_t i = 0; i < 3; ++i)
                    here[i] = previous[i] + static_cast<std::int32_t>(step[i]) -
                              static_cast<std::int32_t>(size / 2);
                previous = here;
                found.push_back(here);
                if (k == 0) found.push_back(first);  // the first two sites change places
            }
            index += change;
        }
        if (at_ + 7 < 8 * packed_.bits.size()) throw std::runtime_error("bits are left");
        return found;
    }

  private:
    static int width(std::array<std::uint64_t, 3> const& sizes) {
        std::array<std::uint32_t, 4> product{1, 0, 0, 0};
        for (std::uint64_t const size : sizes) {
            std::uint64_t carry = 0;
            for (std::uint32_t& limb : product) {
                carry += size * limb;
                limb = static_cast<std::uint32_t>(carry);
                carry >>= 32;
            }
        }
        for (int bit = 127; bit >= 0; --bit)
            if ((product[static_cast<std::size_t>(bit / 32)] >> (bit % 32) & 1) != 0)
                return bit + 1;
        return 0;
    }
    std::uint64_t bits(int count) {
        std::uint64_t value = 0;
        for (; count > 0; --count, ++at_)
            value = value << 1 |
                    (static_cast<unsigned char>(packed_.bits.at(at_ / 8)) >> (7 - at_ % 8) & 1);
        return value;
    }
    /// Digits of a number of mixed radix, whose bytes come in ascending order.
    std::array<std::uint64_t, 3> digits(int count, std::array<std::uint64_t, 3> const& radix) {
        std::vector<std::uint64_t> bytes;
        for (; count > 8; count -= 8) bytes.push_back(bits(8));
        bytes.push_back(bits(count));
        std::array<std::uint64_t, 3> found{};
        for (std::size_t digit = 2; digit > 0; --digit) {
            std::uint64_t rest = 0;
            for (std::size_t k = bytes.size(); k-- > 0;) {
                rest = rest << 8 | bytes[k];
                bytes[k] = rest / radix[digit];
                rest %= radix[digit];
            }
            found[digit] = rest;
        }
        for (std::size_t k = bytes.size(); k-- > 0;) found[0] = found[0] << 8 | bytes[k];
        return found;
    }

    PackedPositions const& packed_;
    std::size_t at_ = 0;
    static constexpr std::array<std::uint64_t, 73> sizes_{
        0,        0,        0,       0,       0,       0,       0,       0,       0,       8,
        10,       12,       16,      20,      25,      32,      40,      50,      64,      80,
        101,      128,      161,     203,     256,     322,     406,     512,     645,     812,
        1024,     1290,     1625,    2048,    2580,    3250,    4096,    5060,    6501,    8192,
        10321,    13003,    16384,   20642,   26007,   32768,   41285,   52015,   65536,   82570,
        104031,   131072,   165140,  208063,  262144,  330280,  416127,  524287,  660561,  832255,
        1048576,  1321122,  1664510, 2097152, 2642245, 3329021, 4194304, 5284491, 6658042, 8388607,
        10568983, 13316085, 16777216};
};

}  // namespace catena::test
