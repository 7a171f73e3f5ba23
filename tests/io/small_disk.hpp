// A disk that fills up soon.
#pragma once

#include <gtest/gtest.h>
#include <sys/mount.h>

#include <cerrno>
#include <cstring>

#include "tests/io/temporary_folder.hpp"

namespace catena::test {

/// A file system of its own, by default of a few hundred kB; `mounted` is false without the
/// privilege.
class SmallDisk {
  public:
    explicit SmallDisk(int kilobytes = 400)
        : mounted_(::mount("catena", folder_.path().c_str(), "tmpfs", 0,
                           ("size=" + std::to_string(kilobytes) + "k").c_str()) == 0) {}
    SmallDisk(SmallDisk const&) = delete;
    SmallDisk& operator=(SmallDisk const&) = delete;
    ~SmallDisk() {
        if (mounted_) ::umount2(folder_.path().c_str(), MNT_DETACH);
    }
    bool mounted() const { return mounted_; }
    std::string operator/(std::string const& name) const { return folder_ / name; }

  private:
    TemporaryFolder folder_;
    bool mounted_;
};

#define NEEDS_SMALL_DISK(disk) \
    if (!(disk).mounted())     \
    GTEST_SKIP() << "NOT RUN: mounting a small disk needs root (" << std::strerror(errno) << ")"

}  // namespace catena::test
