// Time of one evaluation: median over many evaluations after a warm-up, each with the time of the
// slowest rank.
#pragma once

#include <vector>

#include "integrate/chain_system.hpp"

namespace catena {

/// Median and range of repeated measurements.
struct Spread {
    double median = 0, min = 0, max = 0;
    int count = 0;
};
/// Returns the spread of `values`; zeros for an empty list.
Spread spread_of(std::vector<double> values);

/// Times of one evaluation, in seconds. A rank's time counts if it is the largest.
struct Timing {
    Spread evaluation;                // ChainSystem::evaluate(); velocities were projected before
    Spread matrix_sweep, bias_sweep;  // one sweep each
    int matrix_sweeps = 0, bias_sweeps = 0;  // sweeps per evaluation
    /// Medians of the phases of one evaluation. They are "matrix sweep", "bias sweep", "exchange of
    /// units" (a part of the sweeps) and "other" (kinematics, loads, rates).
    /// cuda-levels adds "levels on the GPU", "levels on the host" and "transfers" (parts of the
    /// sweeps). OpenMM adds "forces" (concurrent with the rest on path `host`) and "waiting for
    /// forces".
    std::vector<std::pair<std::string, double>> phases;
};

/// Evaluates the present state `repeat` times (at least once) after a warm-up, in which OpenMM also
/// chooses its faster path. Collective.
Timing time_evaluations(ChainSystem&, int repeat);

}  // namespace catena
