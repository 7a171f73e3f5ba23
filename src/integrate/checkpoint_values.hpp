// What a run takes from a checkpoint beside its bodies' arrays: whatever the file holds, only what
// a run can have written goes on.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "error.hpp"
#include "io/output.hpp"

namespace catena {

[[noreturn]] inline void refuse_checkpoint(std::string const& what) {
    throw InputError("the checkpoint is damaged, " + what, "--restart",
                     "use checkpoint.previous.h5, or start anew");
}

/// The counter of this name; InputError where it is missing or not between these two, both
/// included.
inline int counter_of(Checkpoint const& c, std::string const& name, int least, int most) {
    auto const found = c.integers.find(name);
    if (found == c.integers.end()) refuse_checkpoint(name + " is missing");
    if (found->second < least || found->second > most)
        refuse_checkpoint(name + " is " + std::to_string(found->second));
    return static_cast<int>(found->second);
}

/// The step of this name, `otherwise` where it is missing; InputError where it is not one of the
/// run so far.
inline std::int64_t step_of(Checkpoint const& c, std::string const& name, std::int64_t otherwise) {
    auto const found = c.integers.find(name);
    if (found == c.integers.end()) return otherwise;
    if (found->second < 0 || found->second > c.step)
        refuse_checkpoint(name + " is " + std::to_string(found->second));
    return found->second;
}

/// The array of this name, none where it is missing; InputError where it is not of so many finite
/// numbers from 0 on.
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
