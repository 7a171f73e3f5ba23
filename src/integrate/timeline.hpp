// StepTimeline: when each phase of one time step ran, for jobs/timeline.py and reports.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "clock.hpp"

namespace catena {

/// One phase of a time step; `lane` is the row of the picture in which it is drawn.
struct Phase {
    std::string name, lane;
    double begin = 0, end = 0;  // seconds since the start of the step
};
/// All phases of one time step.
struct StepTimeline {
    std::int64_t step = 0;
    std::vector<Phase> phases;
};

}  // namespace catena
