// How long an evaluation takes: warm-up, then many of them, the slowest rank's time of each, and
// the median.
#pragma once

#include <vector>

#include "integrate/chain_system.hpp"

namespace catena {

struct Spread {
    double median = 0, min = 0, max = 0;
    int count = 0;
};
/// Zeros for an empty list.
Spread spread_of(std::vector<double> values);

/// Seconds. A rank's time counts where it is the largest.
struct Timing {
    Spread evaluation;                       // ChainSystem::evaluate(), velocities projected before
    Spread matrix_sweep, bias_sweep;         // one sweep
    int matrix_sweeps = 0, bias_sweeps = 0;  // in one evaluation
    /// Of one evaluation, medians: "matrix sweep", "bias sweep", "exchange of units" (a part of the
    /// sweeps), "other" (kinematics, loads, rates), with cuda-levels "levels on the GPU", "levels
    /// on the host", "transfers" (parts of the sweeps) and, with OpenMM, "forces" (side by side
    /// with the rest on path `host`) and "waiting for forces".
    std::vector<std::pair<std::string, double>> phases;
};

/// Evaluates the present state `repeat` times (at least once) after a warm-up, in which OpenMM also
/// finds its faster path. Collective.
Timing time_evaluations(ChainSystem&, int repeat);

}  // namespace catena
