// Layout of a checkpoint file. The root holds the attributes format, version, step, time_bits,
// scene_hash and checksum. The groups notes (texts), integers and arrays (doubles) hold one dataset
// per entry. The checksum covers all of them. Elements of arrays enter it together with their
// positions, so that several ranks can write and read them. The checksum thus proves that what is
// read is what was handed to the writer. A seal in front of HDF5's own bytes reveals damage before
// HDF5 parses the file (file_seal.hpp).
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "io/hdf5_data.hpp"
#include "io/output.hpp"

namespace catena {

/// Returns the path of the preceding checkpoint: `checkpoint.previous.h5` next to `checkpoint.h5`.
std::string previous_checkpoint(std::string const& file);

namespace hdf5 {

/// Actions that error messages name ("cannot write the checkpoint").
inline std::string const writing_checkpoint = "write the checkpoint",
                         reading_checkpoint = "read the checkpoint";

/// Number of elements of each array, by the array's name.
using ArraySizes = std::map<std::string, std::int64_t>;
/// Checksum of the elements [first, first + values.size()) of `array`. The checksums of all parts
/// of all arrays are summed modulo 2^64, in any order.
std::uint64_t checksum_of_values(std::string const& array, std::int64_t first,
                                 std::span<double const> values);
/// Checksum of a whole checkpoint. The arrays of `head` are ignored. `sizes`: sizes of all arrays;
/// `of_values`: sum of checksum_of_values() over all their elements.
std::uint64_t checksum_of(Checkpoint const& head, ArraySizes const& sizes, std::uint64_t of_values);

/// Creates the file `name` with everything except the checksum and the elements of the arrays
/// `later`. Disk space for those elements is reserved. Error messages name `file`.
void make_checkpoint_file(std::string const& name, std::string const& file, Checkpoint const&,
                          ArraySizes const& later);
/// Opens a dataset of the group arrays.
Dataset open_array(Place const& root, std::string const& name);
/// Overwrites the attribute checksum of the file `name` and syncs it to disk. Error messages name
/// `file`.
void put_checksum(std::string const& name, std::string const& file, std::uint64_t checksum);

/// Share of one of several readers of a file: reader `number` of `of` readers.
struct Reader {
    int number = 0, of = 1;
};
/// Instructs read_checkpoint_file() to return the reader's share of every array, or only to add it
/// to the checksum. The latter needs memory for a single piece of an array.
enum class Arrays { keep, only_check };
/// Contents of a checkpoint file as one Reader sees them.
struct CheckpointRead {
    Checkpoint contents;          // arrays: the reader's share, absent with only_check
    ArraySizes sizes;             // sizes of the whole arrays
    std::uint64_t of_values = 0;  // sum of checksum_of_values() over the reader's share
    std::uint64_t checksum = 0;   // attribute of the file, not compared here
};
/// Reads a checkpoint file. Throws ComputationError for damaged contents and InputError for another
/// version of the format.
CheckpointRead read_checkpoint_file(Place const& root, Arrays, Reader);

}  // namespace hdf5
}  // namespace catena
