// What each target of the fuzzer defines, and files in memory for readers that open theirs by a
// path.
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <string_view>

namespace catena::fuzz {

/// Reads the bytes as the file of one of Catena's readers. InputError: they are no such file. All
/// else is a fault.
void read(std::string_view bytes);

/// Ends the process as a finding where a property of the reader does not hold.
inline void require(bool holds) {
    if (!holds) std::abort();
}

inline void fill(int descriptor, std::string_view bytes) {
    require(descriptor >= 0 &&
            ::write(descriptor, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
}

/// A file in memory that readers open by its path.
class MemoryFile {
  public:
    explicit MemoryFile(std::string_view bytes)
        : descriptor_(::memfd_create("bytes", MFD_CLOEXEC)) {
        fill(descriptor_, bytes);
    }
    MemoryFile(MemoryFile const&) = delete;
    MemoryFile& operator=(MemoryFile const&) = delete;
    ~MemoryFile() { ::close(descriptor_); }
    std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

  private:
    int descriptor_;
};

/// A file with a name: HDF5 asks the system for the real path of what it opens.
class NamedFile {
  public:
    explicit NamedFile(std::string_view bytes)
        : path_("/dev/shm/catena-fuzz-" + std::to_string(::getpid())) {
        int const descriptor =
            ::open(path_.c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0600);
        fill(descriptor, bytes);
        ::close(descriptor);
    }
    NamedFile(NamedFile const&) = delete;
    NamedFile& operator=(NamedFile const&) = delete;
    ~NamedFile() { ::unlink(path_.c_str()); }
    std::string const& path() const { return path_; }

  private:
    std::string path_;
};

}  // namespace catena::fuzz
