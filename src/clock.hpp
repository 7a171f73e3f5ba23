// The time that durations are taken from.
#pragma once

#include <chrono>

namespace catena {

/// Seconds of std::chrono::steady_clock.
inline double seconds_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

}  // namespace catena
