// The seal of a finished file: a line in its first 512 bytes with the number of bytes behind them and their checksum. It is looked at
// before a library parses the file: HDF5 reads beyond its buffers on damaged ones. HDF5 leaves those bytes to their user ("user block").
#pragma once

#include <cstdint>
#include <string>

namespace catena {

constexpr std::int64_t seal_size = 512;

/// Writes the seal over the first 512 bytes of a file that is otherwise complete, and syncs it. Throws ComputationError "cannot <doing>
/// (<shown>): <cause>".
void put_seal(std::string const& file, std::string const& shown, std::string const& doing);

bool has_seal(std::string const& file);
/// What is wrong with a file that has one, in words ("cut short, ..."), empty for nothing. Throws ComputationError where it cannot be read.
std::string broken_seal(std::string const& file);

}  // namespace catena
