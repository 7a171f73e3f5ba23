// The seal of a finished file: a line in its first 512 bytes with the number of bytes behind them
// and their checksum. It is looked at before a library parses the file: HDF5 reads beyond its
// buffers on damaged ones. HDF5 leaves those bytes to their user ("user block").
#pragma once

#include <cstdint>
#include <string>

namespace catena {

constexpr std::int64_t seal_size = 512;

/// What a seal tells of a file, or of some of its pieces of 4 MiB: those of several readers are
/// added.
struct Sealed {
    std::int64_t bytes = 0;
    std::uint64_t checksum = 0;
    friend bool operator==(Sealed const&, Sealed const&) = default;
};
/// Of every `readers`th piece from number `reader` on. Throws ComputationError "cannot <doing>
/// (<shown>): <cause>".
Sealed sum_pieces(std::string const& file, int reader, int readers, std::string const& shown,
                  std::string const& doing);
/// Writes the seal over the first 512 bytes of a file that is otherwise complete, and syncs it.
/// Throws as sum_pieces().
void put_seal(std::string const& file, Sealed const&, std::string const& shown,
              std::string const& doing);

/// `earlier`: as earlier versions of Catena put it, whose checksum was another.
enum class SealKind { none, earlier, own };
SealKind kind_of_seal(std::string const& file);
/// What is wrong with a file that has its own, in words ("cut short, ..."), empty for nothing.
/// Throws ComputationError where it cannot be read.
std::string broken_seal(std::string const& file);

}  // namespace catena
