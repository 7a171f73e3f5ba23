// Reads the memory limits of the machine, of control groups (versions 1 and 2) and of the process.
#include "io/memory_limit.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>

namespace catena {
namespace {

constexpr std::int64_t none = std::numeric_limits<std::int64_t>::max();  // no limit

/// Returns the first number of a file; `none` if there is no number ("max").
std::int64_t number_in(std::string const& file) {
    std::ifstream in(file);
    std::int64_t value = 0;
    return in >> value && value > 0 ? value : none;
}

/// Returns the smallest limit of a control group and its ancestors. `path`: "/job/step" or "/".
std::int64_t least_of(std::string const& mounted, std::string path, char const* file) {
    std::int64_t least = none;
    while (true) {
        least = std::min(least, number_in(mounted + path + "/" + file));
        if (path.empty()) return least;
        path.resize(path.find_last_of('/'));
    }
}

/// Returns the smallest limit of this process's control groups. Lines of `own` are
/// "number:controllers:path". Version 2, whose limits form one tree, has "0::path".
std::int64_t limit_of_groups(std::string const& groups, std::string const& own) {
    std::int64_t least = std::min(number_in(groups + "/memory.max"),
                                  number_in(groups + "/memory/memory.limit_in_bytes"));
    std::ifstream in(own);
    for (std::string line; std::getline(in, line);) {
        std::size_t const first = line.find(':'), second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos ||
            line.compare(second + 1, 1, "/") != 0)
            continue;
        std::string const controllers = "," + line.substr(first + 1, second - first - 1) + ",",
                          path = line.substr(second + 1);
        if (controllers == ",,") least = std::min(least, least_of(groups, path, "memory.max"));
        if (controllers.find(",memory,") != std::string::npos)
            least = std::min(least, least_of(groups + "/memory", path, "memory.limit_in_bytes"));
    }
    return least;
}

std::int64_t limit_of_process() {
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return none;
    return limit.rlim_cur > static_cast<rlim_t>(none) ? none
                                                      : static_cast<std::int64_t>(limit.rlim_cur);
}

}  // namespace

std::int64_t memory_limit(std::string const& groups, std::string const& own) {
    std::int64_t const machine = std::int64_t{sysconf(_SC_PHYS_PAGES)} * sysconf(_SC_PAGESIZE);
    return std::min({machine, limit_of_groups(groups, own), limit_of_process()});
}

std::string available_memory(std::string const& groups, std::string const& own) {
    std::int64_t const least = memory_limit(groups, own);
    char const* const cause = least == limit_of_process()             ? " by `ulimit -v`"
                              : least == limit_of_groups(groups, own) ? " by the control group of "
                                                                        "this container or job"
                                                                      : "";
    return fmt::format("{:.3g} GB are {}{}", 1e-9 * static_cast<double>(least),
                       *cause == '\0' ? "available" : "allowed", cause);
}

bool is_limited_by_ulimit() { return limit_of_process() != none; }

}  // namespace catena
