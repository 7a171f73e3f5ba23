// Frames whose steps are evenly spaced.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace catena::analysis {

/// The first frames of a list that follow one another at one interval of steps. The interval is
/// that between the first two. Frames between its multiples, such as the last state of a run, are
/// left out. The list ends at the first multiple that is missing.
struct EvenFrames {
    std::vector<std::size_t> frames;  // indices in the list
    std::int64_t interval = 0;        // steps; 0 for a single frame
    std::size_t between = 0;          // frames left out between multiples
    std::size_t after = 0;  // frames left out after a missing multiple, and that one's end
};
EvenFrames even_frames(std::span<std::int64_t const> steps);

}  // namespace catena::analysis
