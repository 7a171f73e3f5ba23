// Seal of a finished file: a line in its first 512 bytes with the number of bytes behind them and
// their checksum. The seal is verified before a library parses the file, because HDF5 reads beyond
// its buffers on damaged files. HDF5 leaves those bytes to its user ("user block").
#pragma once

#include <cstdint>
#include <string>

namespace catena {

/// Size of the seal in bytes.
constexpr std::int64_t seal_size = 512;

/// Size and checksum of the contents of a sealed file, or of some of its pieces of 4 MiB. The
/// values of several readers are added.
struct Sealed {
    std::int64_t bytes = 0;
    std::uint64_t checksum = 0;
    friend bool operator==(Sealed const&, Sealed const&) = default;
};
/// Sums the pieces reader, reader + readers, reader + 2 readers, ... of a file, which begin behind
/// its seal. Throws ComputationError "cannot <doing> (<shown>): <cause>".
Sealed sum_pieces(std::string const& file, int reader, int readers, std::string const& shown,
                  std::string const& doing);
/// Writes the seal over the first 512 bytes of a file that is otherwise complete, and syncs it to
/// disk. Throws the errors of sum_pieces().
void put_seal(std::string const& file, Sealed const&, std::string const& shown,
              std::string const& doing);

/// Kind of a file's seal. `earlier`: written by an earlier version of Catena with another checksum;
/// `own`: written in this version's format.
enum class SealKind { none, earlier, own };
/// Returns `none` for anything but a regular file. Throws ComputationError if the file cannot be
/// read.
SealKind kind_of_seal(std::string const& file);
/// Describes what is wrong with a file of kind `own` ("cut short, ..."); empty if nothing is wrong.
/// Throws ComputationError if the file cannot be read.
std::string broken_seal(std::string const& file);

}  // namespace catena
