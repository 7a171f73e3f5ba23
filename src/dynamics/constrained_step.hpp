// One step of RATTLE or g-BAOAB (constrained_integrator.hpp), for whatever does its parts, on the
// host or a GPU.
#pragma once

#include <cmath>
#include <cstdint>

#include "math/host_device.hpp"

namespace catena {

/// v <- keep v + spread M^-1/2 noise, to be projected.
struct Thermostat {
    double keep = 1, spread = 0;
    std::uint64_t seed = 0;
};
/// The variance of velocities tends to kt / M.
inline Thermostat thermostat_of(double keep, double kt, std::uint64_t seed) {
    return {keep, std::sqrt((1.0 - keep * keep) * kt), seed};
}

struct ConstrainedStep {
    bool langevin = false;
    double kick = 0;   // of the forces at its beginning
    double drift = 0;  // of all of it
    int sweeps = 0;    // a drift
    int parts =
        1;  // of a drift, each with its own matrices: geodesic steps (Leimkuhler & Matthews 2016)
    Thermostat thermostat;
    std::uint64_t number = 0;
    int drifts() const { return (langevin ? 2 : 1) * parts; }
    int matrix_sweeps() const { return drifts() - 1; }
    int bias_sweeps() const { return drifts() * (1 + sweeps); }
};

/// From x_n, where configuration, matrices and forces are ready, to x_n+1, where the configuration
/// is.
CATENA_EITHER_SIDE
template <class Parts>
CATENA_HD_IN_PLACE void take_step(Parts&& parts, ConstrainedStep const& s) {
    // One loop, not one part after the other: written out, a GPU would spend its time fetching
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
