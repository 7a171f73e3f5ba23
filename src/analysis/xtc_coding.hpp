// Compression of positions in XTC files ("3dfcoord" of the GROMACS manual, chapter file formats).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace catena::analysis {

/// Position in units of the file's precision.
using Lattice = std::array<std::int32_t, 3>;

/// Compressed positions of one frame.
struct PackedPositions {
    Lattice least{}, most{};      // smallest and largest coordinate along each axis
    std::int32_t first_size = 0;  // index of the first size of small steps in the format's table
    std::string bits;             // most significant bit first, padded with zeros to whole bytes
};

/// Largest difference of two coordinates that the format holds.
constexpr std::int64_t most_extent = INT32_MAX - 3;

/// Compresses positions. Each run of sites begins with an absolute position, coded as one number of
/// mixed radix, and goes on with up to 8 steps from site to site, if they are small. The size that
/// counts as small follows the steps. Coordinates must not differ by more than `most_extent`.
PackedPositions pack_positions(std::vector<Lattice> positions);

}  // namespace catena::analysis
