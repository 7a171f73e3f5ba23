// Trial of an action in a child process: a library that crashes on a damaged file ends only the
// child.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace catena {

/// Resources that a trial may use in addition to those of this process.
struct TrialLimits {
    std::int64_t bytes = 0;    // address space
    std::int64_t seconds = 0;  // processor time
};
/// Limits for reading a file: more than a compressed file of its size can need.
TrialLimits limits_for_file(std::string const& file);

/// Runs `action` in a copy of this process, whose changes and output are discarded. Returns an
/// empty text if the action returned or threw, or if the system cannot make a copy. Otherwise
/// returns how the copy ended ("Segmentation fault").
std::string trial(std::function<void()> const& action, TrialLimits const& limits);

}  // namespace catena
