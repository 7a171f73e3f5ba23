// Implements the compression of positions.
#include "analysis/xtc_coding.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <utility>

namespace catena::analysis {
namespace {

__extension__ using Wide = unsigned __int128;  // NOLINT

/// Sizes of small steps, about 2^(i / 3): three coordinates below size i take i bits. The format
/// fixes these numbers; those before `first_index` are not used.
constexpr std::array<std::int32_t, 73> sizes{
    0,        0,        0,       0,       0,       0,       0,       0,       0,       8,
    10,       12,       16,      20,      25,      32,      40,      50,      64,      80,
    101,      128,      161,     203,     256,     322,     406,     512,     645,     812,
    1024,     1290,     1625,    2048,    2580,    3250,    4096,    5060,    6501,    8192,
    10321,    13003,    16384,   20642,   26007,   32768,   41285,   52015,   65536,   82570,
    104031,   131072,   165140,  208063,  262144,  330280,  416127,  524287,  660561,  832255,
    1048576,  1321122,  1664510, 2097152, 2642245, 3329021, 4194304, 5284491, 6658042, 8388607,
    10568983, 13316085, 16777216};
constexpr int first_index = 9, last_index = static_cast<int>(sizes.size()) - 1;
constexpr int range_of_indices = 8;                 // largest change of the index within a frame
constexpr std::size_t most_small = 8;               // steps of a run
constexpr std::int64_t most_in_product = 0xffffff;  // larger extents are coded one by one

/// Bits that follow each other, most significant first.
class Bits {
  public:
    /// Appends the lowest `count` bits of a number, 32 at most.
    void put(int count, std::uint64_t value) {
        pending_ = pending_ << count | value;
        for (waiting_ += count; waiting_ >= 8; waiting_ -= 8)
            bytes_ += static_cast<char>(pending_ >> (waiting_ - 8) & 0xff);
    }
    /// Appends a number of `count` bits, its bytes in ascending order.
    void put_bytes(int count, Wide value) {
        for (; count > 8; count -= 8, value >>= 8) put(8, static_cast<std::uint64_t>(value & 0xff));
        put(count, static_cast<std::uint64_t>(value));
    }
    std::string take() {
        if (waiting_ > 0) put(8 - waiting_, 0);
        return std::move(bytes_);
    }

  private:
    std::string bytes_;
    std::uint64_t pending_ = 0;
    int waiting_ = 0;
};

using Steps = std::array<std::int64_t, 3>;

Steps difference(Lattice const& a, Lattice const& b) {
    return {std::int64_t{a[0]} - b[0], std::int64_t{a[1]} - b[1], std::int64_t{a[2]} - b[2]};
}

/// True if all coordinates differ by less than `limit`.
bool near(Lattice const& a, Lattice const& b, std::int64_t limit) {
    Steps const d = difference(a, b);
    return std::abs(d[0]) < limit && std::abs(d[1]) < limit && std::abs(d[2]) < limit;
}

/// The number of mixed radix whose digits, each below its size, are the coordinates.
Wide product(Steps const& digits, Steps const& radix) {
    Wide number = static_cast<Wide>(digits[0]);
    for (std::size_t i = 1; i < 3; ++i)
        number = number * static_cast<Wide>(radix[i]) + static_cast<Wide>(digits[i]);
    return number;
}

int bits_of(Wide value) {
    int bits = 0;
    for (; value > 0; value >>= 1) ++bits;
    return bits;
}

class Packer {
  public:
    explicit Packer(std::vector<Lattice>&& positions) : x_(std::move(positions)) {
        find_extents();
        index_ = packed_.first_size = first_size();
        highest_ = std::min(last_index, index_ + range_of_indices);
        lowest_ = std::max(first_index, highest_ - range_of_indices);
    }

    PackedPositions pack() {
        while (at_ < x_.size()) put_run();
        packed_.bits = bits_.take();
        return std::move(packed_);
    }

  private:
    void find_extents() {
        packed_.least = packed_.most = x_.front();
        for (Lattice const& x : x_)
            for (std::size_t i = 0; i < 3; ++i) {
                packed_.least[i] = std::min(packed_.least[i], x[i]);
                packed_.most[i] = std::max(packed_.most[i], x[i]);
            }
        extent_ = difference(packed_.most, packed_.least);
        Wide all = 1;
        for (std::int64_t& extent : extent_) all *= static_cast<Wide>(++extent);
        if (*std::max_element(extent_.begin(), extent_.end()) <= most_in_product)
            product_bits_ = bits_of(all);
    }

    /// Index of the size that the shortest step between neighbours has.
    std::int32_t first_size() const {
        std::int64_t shortest = INT32_MAX;
        for (std::size_t k = 1; k < x_.size(); ++k) {
            Steps const d = difference(x_[k], x_[k - 1]);
            shortest = std::min(shortest, std::abs(d[0]) + std::abs(d[1]) + std::abs(d[2]));
        }
        int index = first_index;
        while (index < last_index && sizes[static_cast<std::size_t>(index)] < shortest) ++index;
        return index;
    }

    /// Half of a size: small steps are shorter along each axis.
    static std::int64_t half(int index) { return sizes[static_cast<std::size_t>(index)] / 2; }

    /// Appends a position and the small steps that follow it.
    void put_run() {
        int change = wanted_change();
        // A first step to the second site and one back let two far sites share a near one.
        bool const paired = at_ + 1 < x_.size() && near(x_[at_], x_[at_ + 1], half(index_));
        if (paired) std::swap(x_[at_], x_[at_ + 1]);
        put_position(x_[at_]);
        Lattice previous = x_[at_++];
        std::vector<Steps> steps;
        while (at_ < x_.size() && steps.size() < most_small && (paired || !steps.empty()) &&
               near(x_[at_], previous, half(index_))) {
            if (change < 0 && !near(x_[at_], previous, half(index_ - 1))) change = 0;
            steps.push_back(difference(x_[at_], previous));
            previous = x_[at_++];
        }
        if (steps.empty() && change < 0) change = 0;
        put_steps(steps, change);
        index_ += change;
        previous_ = previous;
    }

    /// Change of the size for the steps that follow this run: 1 if the step to this site was too
    /// long, -1 if shorter ones may come.
    int wanted_change() const {
        bool const was_long = at_ > 0 && !near(x_[at_], previous_, half(index_));
        if (was_long && index_ < highest_ && near(x_[at_], previous_, half(highest_))) return 1;
        return index_ > lowest_ ? -1 : 0;
    }

    void put_position(Lattice const& x) {
        Steps const place = difference(x, packed_.least);
        if (product_bits_ > 0) return bits_.put_bytes(product_bits_, product(place, extent_));
        for (std::size_t i = 0; i < 3; ++i)
            bits_.put(bits_of(static_cast<Wide>(extent_[i])), static_cast<std::uint64_t>(place[i]));
    }

    /// Appends the steps, after their number and the change of the size unless both are as before.
    void put_steps(std::vector<Steps> const& steps, int change) {
        auto const coordinates = static_cast<int>(3 * steps.size());
        if (coordinates == coordinates_ && change == 0) {
            bits_.put(1, 0);
        } else {
            bits_.put(1, 1);
            bits_.put(5, static_cast<std::uint64_t>(coordinates + change + 1));
            coordinates_ = coordinates;
        }
        std::int64_t const size = sizes[static_cast<std::size_t>(index_)];
        for (Steps step : steps) {
            for (std::int64_t& d : step) d += half(index_);
            bits_.put_bytes(index_, product(step, {size, size, size}));
        }
    }

    std::vector<Lattice> x_;
    PackedPositions packed_;
    Bits bits_;
    Steps extent_{};
    int product_bits_ = 0;  // of a position as one number; 0: coordinates one by one
    int index_ = 0, lowest_ = 0, highest_ = 0;  // of the size of small steps
    std::size_t at_ = 0;                        // next site
    Lattice previous_{};
    int coordinates_ = -1;  // of the small steps of the preceding run
};

}  // namespace

PackedPositions pack_positions(std::vector<Lattice> positions) {
    return Packer(std::move(positions)).pack();
}

}  // namespace catena::analysis
