// What a damaged file does to a library that trusts it is found out in a child process.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace catena {

/// What a trial may take beyond what the process has.
struct TrialLimits {
    std::int64_t bytes = 0;    // of address space
    std::int64_t seconds = 0;  // of processor time
};
/// For reading a file: more than a compressed one of its size can need.
TrialLimits limits_for_file(std::string const& file);

/// Runs `action` in a copy of this process, which keeps nothing of what it changes and says
/// nothing. Returns an empty text where it came back or threw, and where the system gives no copy;
/// else how the copy ended ("Segmentation fault").
std::string trial(std::function<void()> const& action, TrialLimits const& limits);

}  // namespace catena
