// Owners of HDF5 handles, and the one way an HDF5 failure becomes an error: one line with file and
// cause.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <string>
#include <utility>

namespace catena::hdf5 {

/// HDF5 prints its error stack on stderr unless told not to; while a Quiet lives it does not. Every
/// use of HDF5 starts with one: the first also takes HDF5 out of the process's exit.
class Quiet {
  public:
    Quiet();
    ~Quiet();
    Quiet(Quiet const&) = delete;
    Quiet& operator=(Quiet const&) = delete;

  private:
    H5E_auto2_t function_ = nullptr;
    void* data_ = nullptr;
};

/// Move-only owner of one HDF5 identifier, closed by `Close`.
template <herr_t (*Close)(hid_t)>
class Handle {
  public:
    Handle() = default;
    explicit Handle(hid_t id) : id_(id) {}
    Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)) {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(id_, other.id_);
        return *this;
    }
    ~Handle() {
        if (id_ < 0) return;
        Quiet const quiet;
        Close(id_);
    }
    hid_t get() const { return id_; }
    explicit operator bool() const { return id_ >= 0; }
    /// Leaves it open for ever.
    void release() { id_ = H5I_INVALID_HID; }
    /// Closes now; the status tells of data that could not be written.
    herr_t close() { return id_ < 0 ? 0 : Close(std::exchange(id_, H5I_INVALID_HID)); }

  private:
    hid_t id_ = H5I_INVALID_HID;
};

using File = Handle<&H5Fclose>;
using Group = Handle<&H5Gclose>;
using Dataset = Handle<&H5Dclose>;
using Space = Handle<&H5Sclose>;
using Type = Handle<&H5Tclose>;
using Attribute = Handle<&H5Aclose>;
using Object = Handle<&H5Oclose>;
using Properties = Handle<&H5Pclose>;

/// The innermost reason on HDF5's error stack, the system's own words where it holds them ("No
/// space left on device").
std::string cause();

/// Throws ComputationError "cannot <doing> (<file>): <cause>".
[[noreturn]] void fail(std::string const& file, std::string const& doing);

/// Hands a status or an identifier through; a negative one becomes a ComputationError.
template <class Status>
Status check(Status status, std::string const& file, std::string const& doing) {
    if (status < 0) fail(file, doing);
    return status;
}

/// H5Fcreate of a file that nobody else has: what was there is removed, a link or a pipe too, and
/// nothing is followed.
hid_t create_anew(std::string const& file, hid_t creation, hid_t access);

/// Takes these bytes of a file from the system before anybody writes them. Where the file system
/// cannot, a full disk shows at the writes.
void take_from_system(int descriptor, std::int64_t from, std::int64_t bytes,
                      std::string const& file, std::string const& doing);
/// On the disk for all that a flush writes and `more` bytes: a full one is found before anything in
/// the file is overwritten.
void make_room(File const&, hsize_t more, std::string const& file, std::string const& doing);
/// On the disk for all that has its place in the file.
void take_room(File const&, std::string const& file, std::string const& doing);
/// Everything written so far reaches the disk: H5Fflush, then fsync.
void flush_to_disk(File const&, std::string const& file, std::string const& doing);
/// For a file in which something could not be written: as its last flush left it, whatever HDF5
/// still does to it.
void leave_as_flushed(File const&);

}  // namespace catena::hdf5
