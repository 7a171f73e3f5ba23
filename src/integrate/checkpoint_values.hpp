// Checked reading of a checkpoint's values other than the bodies' arrays. Only values that a run
// can have written are accepted.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "error.hpp"
#include "io/output.hpp"

namespace catena {

/// Throws the InputError about a damaged checkpoint; `what`: "step is missing".
[[noreturn]] inline void refuse_checkpoint(std::string const& what) {
    throw InputError("the checkpoint is damaged, " + what, "--restart",
                     "use checkpoint.previous.h5, or start anew");
}

/// Returns the counter of this name. Throws InputError if it is missing or outside least .. most.
inline int counter_of(Checkpoint const& c, std::string const& name, int least, int most) {
    auto const found = c.integers.find(name);
    if (found == c.integers.end()) refuse_checkpoint(name + " is missing");
    if (found->second < least || found->second > most)
        refuse_checkpoint(name + " is " + std::to_string(found->second));
    return static_cast<int>(found->second);
}

/// Returns the time step number of this name, or `otherwise` if it is missing. Throws InputError if
/// it is negative or beyond the checkpoint's step.
inline std::int64_t step_of(Checkpoint const& c, std::string const& name, std::int64_t otherwise) {
    auto const found = c.integers.find(name);
    if (found == c.integers.end()) return otherwise;
    if (found->second < 0 || found->second > c.step)
        refuse_checkpoint(name + " is " + std::to_string(found->second));
    return found->second;
}

/// Returns the array of this name; empty if it is missing. Throws InputError unless it has `count`
/// finite numbers that are not negative.
inline std::vector<double> few_numbers_of(Checkpoint const& c, std::string const& name,
                                          std::size_t count) {
    auto const found = c.arrays.find(name);
    if (found == c.arrays.end()) return {};
    if (found->second.size() != count)
        refuse_checkpoint(name + " has " + std::to_string(found->second.size()) + " numbers");
    for (double const value : found->second)
        if (!(value >= 0) || !std::isfinite(value))
            refuse_checkpoint(name + " holds " + std::to_string(value));
    return found->second;
}

}  // namespace catena
