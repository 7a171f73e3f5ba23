// Owners of HDF5 handles. Every failure of HDF5 becomes an error of one line with file and cause.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <string>
#include <utility>

namespace catena::hdf5 {

/// Suppresses HDF5's error stack on stderr during its lifetime. Every use of HDF5 begins with a
/// Quiet. The first Quiet also removes HDF5's clean-up from the exit of the process.
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
    /// Releases ownership: the HDF5 object stays open until the process ends.
    void release() { id_ = H5I_INVALID_HID; }
    /// Closes the object now. A negative status reports data that could not be written.
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

/// Returns the innermost reason on HDF5's error stack. The system's own message is preferred if the
/// stack holds one ("No space left on device").
std::string cause();

/// Throws ComputationError "cannot <doing> (<file>): <cause>".
[[noreturn]] void fail(std::string const& file, std::string const& doing);

/// Passes a status or an identifier through. A negative one throws ComputationError.
template <class Status>
Status check(Status status, std::string const& file, std::string const& doing) {
    if (status < 0) fail(file, doing);
    return status;
}

/// Creates a file with H5Fcreate that no other process uses. An existing file, link or pipe of that
/// name is removed first, and links are not followed.
hid_t create_anew(std::string const& file, hid_t creation, hid_t access);

/// Reserves the bytes [from, from + bytes) of a file on disk before anything is written there. File
/// systems without fallocate report a full disk only at the writes.
void take_from_system(int descriptor, std::int64_t from, std::int64_t bytes,
                      std::string const& file, std::string const& doing);
/// Throws ComputationError if the process may not write files of so many bytes. fallocate() does
/// not compare a length that the file need not get.
void refuse_beyond_limit(std::int64_t bytes, std::string const& file, std::string const& doing);
/// Reserves disk space for everything that a flush writes and for `more` further bytes. A full disk
/// is thus detected before anything in the file is overwritten.
void make_room(File const&, hsize_t more, std::string const& file, std::string const& doing);
/// Reserves disk space for everything that already has an offset in the file.
void take_room(File const&, std::string const& file, std::string const& doing);
/// Flushes everything written so far to disk: H5Fflush, then fsync.
void flush_to_disk(File const&, std::string const& file, std::string const& doing);
/// Keeps a file as its last flush left it after a failed write: later writes of HDF5 are redirected
/// to memory.
void leave_as_flushed(File const&);

}  // namespace catena::hdf5
