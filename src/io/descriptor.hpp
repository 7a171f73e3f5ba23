// Owner of an open file descriptor that converts failures of the system to exceptions.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "error.hpp"

namespace catena {

/// File that is opened with open(2) and closed on destruction. Every failure throws
/// ComputationError.
class Descriptor {
  public:
    /// Opens `file`. Error messages read "cannot <doing> (<shown>): <cause>".
    Descriptor(std::string const& file, int flags, std::string shown, std::string doing)
        : shown_(std::move(shown)),
          doing_(std::move(doing)),
          descriptor_(::open(file.c_str(), flags | O_CLOEXEC)) {
        if (descriptor_ < 0) fail();
    }
    ~Descriptor() { ::close(descriptor_); }
    Descriptor(Descriptor const&) = delete;
    Descriptor& operator=(Descriptor const&) = delete;
    int get() const { return descriptor_; }

    /// Reads up to `most` bytes from offset `at`. Returns fewer only at the end of the file.
    std::size_t read(char* to, std::size_t most, std::int64_t at) const {
        std::size_t done = 0;
        while (done < most) {
            ssize_t const count =
                ::pread(descriptor_, to + done, most - done, at + static_cast<std::int64_t>(done));
            if (count < 0 && errno == EINTR) continue;
            if (count < 0) fail();
            if (count == 0) break;
            done += static_cast<std::size_t>(count);
        }
        return done;
    }
    /// Writes all bytes at offset `at`.
    void write(std::string_view bytes, std::int64_t at) const {
        while (!bytes.empty()) {
            ssize_t const count = ::pwrite(descriptor_, bytes.data(), bytes.size(), at);
            if (count < 0 && errno == EINTR) continue;
            if (count <= 0) fail();
            bytes.remove_prefix(static_cast<std::size_t>(count));
            at += count;
        }
    }

  private:
    [[noreturn]] void fail() const {
        throw ComputationError("cannot " + doing_ + " (" + shown_ +
                               "): " + std::generic_category().message(errno));
    }

    std::string shown_, doing_;
    int descriptor_;
};

}  // namespace catena
