// Who has an HDF5 file open and writes into it: one rank for itself, or all of them together, each
// what is its own. What all do together is collective: every rank calls it.
#pragma once

#include <memory>
#include <string>

#include "io/hdf5_handle.hpp"
#include "mpi/communicator.hpp"

namespace catena::hdf5 {

class Writers {
  public:
    virtual ~Writers() = default;
    virtual bool are_several() const = 0;
    /// Of them, the one that writes what does not belong to a rank.
    virtual bool is_first() const = 0;
    /// Makes H5Fopen and H5Fcreate theirs.
    virtual void prepare(Properties const& access, std::string const& file,
                         std::string const& doing) const = 0;
    /// To be told of the file once it is open.
    virtual void watch(File const&, std::string const& file, std::string const& doing) = 0;
    /// For H5Dwrite.
    virtual hid_t transfer() const = 0;
    virtual std::int64_t sum(std::int64_t value) const = 0;
    /// On the disk for what a flush writes, and for `more` bytes that are not in the file yet: a
    /// full one is found before anything in the file is overwritten.
    virtual void make_room(File const&, hsize_t more, std::string const& file,
                           std::string const& doing) = 0;
    /// Everything written so far reaches the disk.
    virtual void flush_to_disk(File const&, std::string const& file,
                               std::string const& doing) const = 0;
    /// For a file in which something could not be written: as its last flush left it, whatever HDF5
    /// still does to it. False where HDF5 is to do nothing more to it: it and what is open in it
    /// are then to be left open.
    virtual bool leave_as_flushed(File const&) const = 0;
};

std::unique_ptr<Writers> one_writer();
/// Precondition: why_not_by_all() is empty.
std::unique_ptr<Writers> all_writers(Communicator const&);
/// What keeps this rank from writing with the others: "this build's HDF5 is serial".
std::string why_not_by_all(Communicator const&);

}  // namespace catena::hdf5
