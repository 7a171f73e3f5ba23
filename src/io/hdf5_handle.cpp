// Implements error texts, reservation of disk space and clean-up for files of HDF5.
#include "io/hdf5_handle.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "error.hpp"
#include "io/output.hpp"
#include "io/output_file.hpp"

namespace catena::hdf5 {
namespace {

/// Mark in front of the system's message in the errors of HDF5's file drivers.
constexpr char const* system_words = "error message = '";

/// Callback of H5Ewalk2 that stores the system's message, or else the first description.
herr_t innermost_first(unsigned, H5E_error2_t const* error, void* found) {
    auto& text = *static_cast<std::string*>(found);
    std::string const description = error->desc != nullptr ? error->desc : "";
    auto const begin = description.find(system_words);
    if (begin != std::string::npos) {
        auto const from = begin + std::string(system_words).size();
        text = description.substr(from, description.find('\'', from) - from);
        return 1;
    }
    if (text.empty()) text = description;
    return 0;
}

}  // namespace

Quiet::Quiet() {
    // HDF5's exit handler would try again to close files that a full disk kept open, and crash. All
    // files of this program are closed by then.
    [[maybe_unused]] static herr_t const no_clean_up_at_exit = H5dont_atexit();
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Quiet::~Quiet() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }

std::string cause() {
    std::string text;
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, innermost_first, &text);
    return text.empty() ? "HDF5 gives no reason" : text;
}

void fail(std::string const& file, std::string const& doing) {
    throw ComputationError("cannot " + doing + " (" + file + "): " + cause());
}

hid_t create_anew(std::string const& file, hid_t creation, hid_t access) {
    ::unlink(file.c_str());
    return H5Fcreate(file.c_str(), H5F_ACC_EXCL, creation, access);
}

void take_from_system(int descriptor, std::int64_t from, std::int64_t bytes,
                      std::string const& file, std::string const& doing) {
    int error = 0;
    do error = fallocate(descriptor, FALLOC_FL_KEEP_SIZE, from, bytes) == 0 ? 0 : errno;
    while (error == EINTR);
    if (error == ENOSPC || error == EDQUOT || error == EFBIG)
        throw ComputationError("cannot " + doing + " (" + file + "): " + std::strerror(error));
}

void refuse_beyond_limit(std::int64_t bytes, std::string const& file, std::string const& doing) {
    rlimit limit{};
    if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY &&
        static_cast<rlim_t>(bytes) > limit.rlim_cur)
        throw ComputationError("cannot " + doing + " (" + file + "): " + std::strerror(EFBIG));
}

namespace {
int descriptor_of(File const& handle, std::string const& file, std::string const& doing) {
    void* descriptor = nullptr;
    check(H5Fget_vfd_handle(handle.get(), H5P_DEFAULT, &descriptor), file, doing);
    return *static_cast<int const*>(descriptor);
}
std::int64_t size_of(File const& handle, std::string const& file, std::string const& doing) {
    hsize_t size = 0;
    check(H5Fget_filesize(handle.get(), &size), file, doing);
    return static_cast<std::int64_t>(size);
}
}  // namespace

void make_room(File const& handle, hsize_t more, std::string const& file,
               std::string const& doing) {
    std::int64_t const written = size_of(handle, file, doing) + static_cast<std::int64_t>(more);
    std::int64_t const metadata = std::min<std::int64_t>(8 << 20, written / 32 + (32 << 10));
    refuse_beyond_limit(written + metadata, file, doing);
    std::int64_t const not_placed_yet = std::min<std::int64_t>(
        8 << 20, written / 4 + (16 << 10));  // space for chunks in HDF5's caches
    take_from_system(descriptor_of(handle, file, doing), 0, written + not_placed_yet, file, doing);
}

void take_room(File const& handle, std::string const& file, std::string const& doing) {
    take_from_system(descriptor_of(handle, file, doing), 0, size_of(handle, file, doing), file,
                     doing);
}

void flush_to_disk(File const& handle, std::string const& file, std::string const& doing) {
    check(H5Fflush(handle.get(), H5F_SCOPE_LOCAL), file, doing);
    sync_to_disk(descriptor_of(handle, file, doing), file);
}

void leave_as_flushed(File const& handle) {
    void* descriptor = nullptr;
    int const nowhere = memfd_create("catena", 0);
    if (nowhere < 0) return;
    if (H5Fget_vfd_handle(handle.get(), H5P_DEFAULT, &descriptor) >= 0)
        dup2(nowhere, *static_cast<int const*>(descriptor));
    ::close(nowhere);
}

}  // namespace catena::hdf5

namespace catena {

void start_hdf5() { hdf5::Quiet const started; }

std::string hdf5_version() {
    unsigned major = 0, minor = 0, release = 0;
    H5get_libversion(&major, &minor, &release);
    return "HDF5 " + std::to_string(major) + "." + std::to_string(minor) + "." +
           std::to_string(release);
}

}  // namespace catena
