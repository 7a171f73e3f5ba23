// Implements the measurement of drifts, projection sweeps and noise.
#include "plan/drift_costs.hpp"

#include <algorithm>
#include <limits>

#include "measure/timing.hpp"

namespace catena::plan {
namespace {

/// Time step of the measured steps, so short that the chains hardly move. A step of zero would give
/// numbers that are not finite.
constexpr double still = 1e-6;
/// Number of projection sweeps that are timed together; their mean is the time of one sweep.
constexpr int sweeps_at_once = 4;

/// Returns the seconds of one step with the given number of projection sweeps.
double time_step(ChainSystem& system, int sweeps) {
    ConstrainedStep step;
    step.kick = step.drift = still;
    step.sweeps = sweeps;
    double const start = seconds_now();
    system.forces_and_matrices(nullptr);
    for (AbsoluteDynamics* const group : system.absolute()) group->step(step);
    system.wait();
    return seconds_now() - start;
}

/// Returns the seconds that the thermostat's noise takes.
double time_noise(ChainSystem& system) {
    double const start = seconds_now();
    for (AbsoluteDynamics* const group : system.absolute()) group->thermalise({}, 0);
    system.wait();
    return seconds_now() - start;
}

}  // namespace

DriftSeconds measure_drifts(ChainSystem& system, Effort const& effort) {
    Communicator const& communicator = system.communicator();
    system.evaluate();
    DriftSeconds least;
    least.fill(std::numeric_limits<double>::infinity());
    double closed = least[closing];
    double const start = seconds_now();
    for (int i = 0; i < effort.most; ++i) {
        bool const enough = i >= effort.least && seconds_now() - start > effort.seconds;
        if (communicator.max(enough ? 1 : 0) > 0) break;
        communicator.barrier();
        least[drift] = std::min(least[drift], communicator.max(time_step(system, 0)));
        closed = std::min(closed, communicator.max(time_step(system, sweeps_at_once)));
        least[noise] = std::min(least[noise], communicator.max(time_noise(system)));
    }
    least[closing] = std::max(0.0, closed - least[drift]) / sweeps_at_once;
    return least;
}

}  // namespace catena::plan
