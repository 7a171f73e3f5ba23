// One step of RATTLE or g-BAOAB (constrained_integrator.hpp), composed of parts that a host or GPU
// implementation supplies.
#pragma once

#include <cmath>
#include <cstdint>

#include "math/host_device.hpp"

namespace catena {

/// Parameters of the thermostat v <- keep v + spread M^-1/2 noise, which a projection follows.
struct Thermostat {
    double keep = 1, spread = 0;
    std::uint64_t seed = 0;
};
/// Thermostat under which the variance of velocities tends to kt / M. `keep` is the factor per
/// step, exp(-friction step); kt is in kJ/mol.
inline Thermostat thermostat_of(double keep, double kt, std::uint64_t seed) {
    return {keep, std::sqrt((1.0 - keep * keep) * kt), seed};
}

/// Parameters of one step, as plain data for kernels. Lengths of time are in ps.
struct ConstrainedStep {
    bool langevin = false;
    double kick = 0;   // Duration of the kick by the forces at the start.
    double drift = 0;  // Total duration of all drifts.
    int sweeps = 0;    // Sweeps per drift.
    /// Parts that a drift is divided into, each with its own matrices: geodesic steps (Leimkuhler &
    /// Matthews 2016).
    int parts = 1;
    Thermostat thermostat;
    /// Number of the step, which keys the noise.
    std::uint64_t number = 0;
    /// Number of drifts in the step; two halves under a thermostat, each in `parts` parts.
    int drifts() const { return (langevin ? 2 : 1) * parts; }
    /// Matrix sweeps within the step; the one at its start is made before it.
    int matrix_sweeps() const { return drifts() - 1; }
    /// Bias sweeps within the step: one projection and `sweeps` sweeps per drift.
    int bias_sweeps() const { return drifts() * (1 + sweeps); }
};

/// Takes a step from x_n to x_n+1. At x_n configuration, matrices and forces must be up to date; at
/// x_n+1 only the configuration is.
CATENA_EITHER_SIDE
template <class Parts>
CATENA_HD_IN_PLACE void take_step(Parts&& parts, ConstrainedStep const& s) {
    // One loop instead of straight-line code: written out, a GPU would spend its time fetching
    // instructions.
    int const drifts = (s.langevin ? 2 : 1) * s.parts;
    CATENA_NO_UNROLL
    for (int d = 0; d < drifts; ++d) {
        if (d > 0) {
            parts.update_configuration();
            parts.assemble_matrices();
            if (s.langevin && d == s.parts) parts.thermalise(s.thermostat, s.number);
        }
        parts.kick(d == 0 ? s.kick : 0.0);
        parts.drift(s.drift / drifts, s.sweeps);
    }
    parts.update_configuration();
}

}  // namespace catena
