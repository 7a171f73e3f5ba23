// What a checkpoint's file holds: attributes format, version, step, time_bits, scene_hash and
// checksum at the root; groups notes (texts), integers and arrays (doubles), one dataset an entry.
// The checksum runs over all of it, of arrays over their numbers at their places, so that several
// ranks can write and read them: what was handed over is what is read. A seal in front of HDF5's
// own bytes tells of damage before HDF5 meets it (file_seal.hpp).
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "io/hdf5_data.hpp"
#include "io/output.hpp"

namespace catena {

/// Where the checkpoint is kept that came before this one.
std::string previous_checkpoint(std::string const& file);

namespace hdf5 {

inline std::string const writing_checkpoint = "write the checkpoint",
                         reading_checkpoint = "read the checkpoint";

/// Numbers of arrays, by their names.
using ArraySizes = std::map<std::string, std::int64_t>;
/// Of an array's numbers from `first` on. Those of all numbers of all arrays are added, in any
/// order.
std::uint64_t checksum_of_values(std::string const& array, std::int64_t first,
                                 std::span<double const> values);
/// Over everything. `head`: its arrays do not matter; `sizes`, `of_values`: of all there are.
std::uint64_t checksum_of(Checkpoint const& head, ArraySizes const& sizes, std::uint64_t of_values);

/// Makes the file `name` of everything but the checksum and the numbers of the arrays `later`, for
/// which it has the room on disk. Messages name `file`.
void make_checkpoint_file(std::string const& name, std::string const& file, Checkpoint const&,
                          ArraySizes const& later);
Dataset open_array(Place const& root, std::string const& name);
void put_checksum(std::string const& name, std::string const& file, std::uint64_t checksum);

/// One of several that share the reading of a file.
struct Reader {
    int number = 0, of = 1;
};
/// Whether a reader keeps its share of the arrays, or takes the memory of a piece of one.
enum class Arrays { keep, only_check };
struct CheckpointRead {
    Checkpoint contents;
    ArraySizes sizes;
    std::uint64_t of_values = 0;  // of the reader's share
    std::uint64_t checksum = 0;   // as the file tells it
};
/// Throws ComputationError for what is damaged, InputError for another version's.
CheckpointRead read_checkpoint_file(Place const& root, Arrays, Reader);

}  // namespace hdf5
}  // namespace catena
