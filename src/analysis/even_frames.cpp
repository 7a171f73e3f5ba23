// Finds frames whose steps are evenly spaced.
#include "analysis/even_frames.hpp"

namespace catena::analysis {

EvenFrames even_frames(std::span<std::int64_t const> steps) {
    EvenFrames even;
    if (steps.empty()) return even;
    even.frames.push_back(0);
    if (steps.size() == 1) return even;
    even.interval = steps[1] - steps[0];
    std::int64_t expected = steps[1];
    std::size_t waiting = 0;  // frames since the last multiple
    for (std::size_t f = 1; f < steps.size(); ++f) {
        if (steps[f] == expected) {
            even.frames.push_back(f);
            even.between += waiting;
            waiting = 0;
            expected += even.interval;
        } else if (steps[f] < expected) {
            ++waiting;
        } else {
            even.after = steps.size() - f;
            break;
        }
    }
    even.between += waiting;
    return even;
}

}  // namespace catena::analysis
