// Numbers of a small range, known at run time, as template arguments.
#pragma once

#include <type_traits>

#include "math/host_device.hpp"

namespace catena {

/// Returns use(std::integral_constant<int, n>{}), on host and device. A number outside [low, high]
/// counts as `high`. All results have one type.
CATENA_EITHER_SIDE
template <int low, int high, class Use>
CATENA_HD auto with_number(int n, Use const& use) {
    if constexpr (low < high)
        if (n != low) return with_number<low + 1, high>(n, use);
    return use(std::integral_constant<int, low>{});
}

}  // namespace catena
