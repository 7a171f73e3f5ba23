// Writers of an HDF5 file: one rank alone, or all ranks together, each with its own data.
// Operations of all ranks together are collective.
#pragma once

#include <memory>
#include <string>

#include "io/hdf5_handle.hpp"
#include "mpi/communicator.hpp"

namespace catena::hdf5 {

/// Access of one rank or of all ranks to an HDF5 file. Error messages read "cannot <doing>
/// (<file>): <cause>".
class Writers {
  public:
    virtual ~Writers() = default;
    virtual bool are_several() const = 0;
    /// True on the rank that writes the data that belong to no particular rank.
    virtual bool is_first() const = 0;
    /// Sets up `access`, the property list with which H5Fopen or H5Fcreate then opens the file.
    virtual void prepare(Properties const& access, std::string const& file,
                         std::string const& doing) const = 0;
    /// Registers a file after it has been opened.
    virtual void watch(File const&, std::string const& file, std::string const& doing) = 0;
    /// Property list for H5Dwrite.
    virtual hid_t transfer() const = 0;
    /// Sum over the writing ranks.
    virtual std::int64_t sum(std::int64_t value) const = 0;
    /// Reserves disk space for what a flush writes and for `more` bytes that are not in the file
    /// yet. A full disk is thus detected before anything in the file is overwritten.
    virtual void make_room(File const&, hsize_t more, std::string const& file,
                           std::string const& doing) = 0;
    /// Flushes everything written so far to disk.
    virtual void flush_to_disk(File const&, std::string const& file,
                               std::string const& doing) const = 0;
    /// Keeps a file as its last flush left it after a failed write, whatever HDF5 still does to it.
    /// Returns false if HDF5 must not touch the file again: the file and its open objects must then
    /// stay open.
    virtual bool leave_as_flushed(File const&) const = 0;
};

/// Writer for a single rank.
std::unique_ptr<Writers> one_writer();
/// Writers for all ranks of the communicator. Precondition: why_not_by_all() is empty.
std::unique_ptr<Writers> all_writers(Communicator const&);
/// Reason why this rank cannot write with the others ("this build's HDF5 is serial"); empty if it
/// can.
std::string why_not_by_all(Communicator const&);

}  // namespace catena::hdf5
