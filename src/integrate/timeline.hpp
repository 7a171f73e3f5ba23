// When each phase of a step ran, and how much of the matrix sweep was hidden behind the forces.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "clock.hpp"

namespace catena {

struct Phase {
    std::string name, lane;
    double begin = 0, end = 0;  // seconds from the start of the step
};
struct StepTimeline {
    std::int64_t step = 0;
    std::vector<Phase> phases;
};

}  // namespace catena
