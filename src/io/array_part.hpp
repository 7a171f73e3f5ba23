#pragma once

#include <cstdint>
#include <span>

namespace catena {

/// Consecutive elements [first, first + values.size()) of an array that is distributed over ranks.
struct ArrayPart {
    std::int64_t first = 0;  // global index of values[0]
    std::span<double const> values;
};

}  // namespace catena
