// What a host has free, by made-up files of the kernel and by a limit of this process; and scenes
// that need more.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "plan/host_memory.hpp"
#include "reader/load_scene.hpp"

namespace catena::test {
namespace {

using command::free_host_memory, command::lacking_memory;

/// A folder with proc and sys, removed at the end.
class FreeHostMemory : public ::testing::Test {
  protected:
    FreeHostMemory() {
        std::filesystem::remove_all(root_);
        write("proc/meminfo", "MemTotal:  9000 kB\nMemFree:   10 kB\nMemAvailable:   4000 kB\n");
    }
    ~FreeHostMemory() override { std::filesystem::remove_all(root_); }
    void write(std::string const& name, std::string const& text) const {
        std::filesystem::path const path = root_ + name;
        std::filesystem::create_directories(path.parent_path());
        std::ofstream(path) << text;
    }
    std::string const root_ =
        ::testing::TempDir() + "catena-free-memory-" + std::to_string(::getpid()) + "/";
};

TEST_F(FreeHostMemory, IsWhatTheKernelCallsAvailable) {
    EXPECT_EQ(free_host_memory(root_), 4000 * 1024.0);
}

TEST_F(FreeHostMemory, IsUnknownWithoutTheKernelsFile) {
    EXPECT_EQ(free_host_memory(root_ + "nowhere/"), std::nullopt);
}

TEST_F(FreeHostMemory, IsWhatTheTightestControlGroupLeaves) {
    write("proc/self/cgroup", "0::/jobs/mine\n");
    write("sys/fs/cgroup/jobs/mine/memory.max", "max\n");
    write("sys/fs/cgroup/jobs/memory.max", "1000000\n");
    write("sys/fs/cgroup/jobs/memory.current", "700000\n");
    write("sys/fs/cgroup/jobs/memory.stat", "anon 5\ninactive_file 200000\nactive_file 7\n");
    EXPECT_EQ(free_host_memory(root_), 500000.0);
}

TEST_F(FreeHostMemory, IsWhatAControlGroupOfVersionOneLeaves) {
    write("proc/self/cgroup", "12:cpu,cpuacct:/other\n5:memory:/jobs/mine\n");
    write("sys/fs/cgroup/memory/jobs/mine/memory.limit_in_bytes", "9223372036854771712\n");
    write("sys/fs/cgroup/memory/jobs/memory.limit_in_bytes", "1000000\n");
    write("sys/fs/cgroup/memory/jobs/memory.usage_in_bytes", "700000\n");
    write("sys/fs/cgroup/memory/jobs/memory.stat", "inactive_file 1\ntotal_inactive_file 200000\n");
    EXPECT_EQ(free_host_memory(root_), 500000.0);
}

TEST_F(FreeHostMemory, IsThatOfAContainerWhichSeesItsOwnGroupOnly) {
    write("proc/self/cgroup", "5:memory:/docker/1234\n");
    write("sys/fs/cgroup/memory/memory.limit_in_bytes", "600000\n");
    EXPECT_EQ(free_host_memory(root_), 600000.0);
}

TEST_F(FreeHostMemory, IgnoresAGroupWithoutALimit) {
    write("proc/self/cgroup", "0::/\n");
    write("sys/fs/cgroup/memory.max", "max\n");
    EXPECT_EQ(free_host_memory(root_), 4000 * 1024.0);
}

/// Limits the address space of this process to what it has and `bytes` more.
class AddressSpace {
  public:
    explicit AddressSpace(rlim_t bytes) {
        ::getrlimit(RLIMIT_AS, &before_);
        std::ifstream file("/proc/self/statm");
        rlim_t pages = 0;
        file >> pages;
        auto const page = static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
        rlimit const less{pages * page + bytes, before_.rlim_max};
        ::setrlimit(RLIMIT_AS, &less);
    }
    ~AddressSpace() { ::setrlimit(RLIMIT_AS, &before_); }
    AddressSpace(AddressSpace const&) = delete;
    AddressSpace& operator=(AddressSpace const&) = delete;

  private:
    rlimit before_{};
};

TEST(LackingMemory, IsSaidWithBothNumbersIfTheScenesArraysFindNoRoom) {
    auto const alone = serial_communicator();
    auto const scene_of = [](std::string const& beads) {
        return parse_scene("chains: [{generator: {freely_jointed: {beads: " + beads +
                               ", length: 0.38, mass: 100}}}]\nsolver: {backend: segments}\n",
                           "scene.yaml", {});
    };
    Scene const small = scene_of("100"), large = scene_of("300000");
    EXPECT_FALSE(lacking_memory(large, *alone));
    AddressSpace const limit(20000000);
    EXPECT_FALSE(lacking_memory(small, *alone));
    auto const lacking = lacking_memory(large, *alone);
    ASSERT_TRUE(lacking);
    EXPECT_GT(lacking->needed, 100 * 3e5);
    EXPECT_LE(lacking->free, 20000000);
    EXPECT_NE(lacking->note().find("`ulimit -v` leaves"), std::string::npos) << lacking->note();
}

}  // namespace
}  // namespace catena::test
