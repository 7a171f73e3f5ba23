// How much memory this process may have.
#pragma once

#include <cstdint>
#include <string>

namespace catena {

/// Bytes: the machine's memory, or less where a control group (a container, a batch job) or
/// RLIMIT_AS sets a limit. `groups`: where the control groups' files are mounted; `own`: the file
/// that names this process's.
std::int64_t memory_limit(std::string const& groups = "/sys/fs/cgroup",
                          std::string const& own = "/proc/self/cgroup");

}  // namespace catena
