// Amount of memory that this process may use.
#pragma once

#include <cstdint>
#include <string>

namespace catena {

/// Returns the machine's memory in bytes, or less if a control group (a container, a batch job) or
/// RLIMIT_AS sets a limit. `groups`: mount point of the control groups' files; `own`: file that
/// names the control groups of this process.
std::int64_t memory_limit(std::string const& groups = "/sys/fs/cgroup",
                          std::string const& own = "/proc/self/cgroup");

/// Returns the limit and its cause for messages: "2 GB are allowed by `ulimit -v`", "16 GB are
/// available".
std::string available_memory(std::string const& groups = "/sys/fs/cgroup",
                             std::string const& own = "/proc/self/cgroup");

/// True if RLIMIT_AS (`ulimit -v`) limits this process.
bool is_limited_by_ulimit();

}  // namespace catena
