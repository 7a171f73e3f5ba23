// Work-precision of OpenMM's forces: what each platform and precision gives, and how long it takes.
#pragma once

#include <string>
#include <vector>

#include "report/timing.hpp"

namespace catena {

struct ForcePoint {
    std::string platform, precision;  // precision: "double", "single" or "mixed"
    double error = 0;                 // root mean square of the difference from the Reference platform, over that of the forces
    double largest_error = 0;         // largest difference, over the largest force
    Spread seconds;                   // of an evaluation of the forces alone
};
struct ForceStudy {
    std::string title;
    std::int64_t beads = 0;
    std::vector<ForcePoint> points;
};

/// Of a scene with forces.openmm, on every platform present, at its start. One rank.
ForceStudy study_force_errors(Scene const&, Communicator const&, int repeat);

}  // namespace catena
