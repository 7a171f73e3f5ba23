#pragma once

#include <cstdint>
#include <span>

namespace catena {

/// Numbers [first, first + values.size()) of an array that ranks have between them.
struct ArrayPart {
    std::int64_t first = 0;
    std::span<double const> values;
};

}  // namespace catena
