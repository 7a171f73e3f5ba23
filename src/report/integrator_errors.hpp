// Work-precision of the integrators: how far a scene's bodies are from where they belong after a fixed time, and how well energy is kept,
// over the step; and whether energy drifts over many steps.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/timing.hpp"

namespace catena {

struct IntegratorPoint {
    double step = 0;
    double error = 0;                    // largest difference of a centre of mass (bead) at the end, over the scene's extent there
    std::optional<double> energy_error;  // largest |E - E(0)| at the samples, over the largest kinetic energy there
    Spread seconds;                      // of the whole time
    bool finished = true;                // false: the step is so wide that the run came to no end
};
struct IntegratorCurve {
    std::string name;
    int order = 0;  // nominal
    std::vector<IntegratorPoint> points;
    /// Of the two finest steps whose errors stand well above the reference's own and rounding; nothing where there are none.
    std::optional<double> slope;
    bool exact = false;  // all errors are roundings, and so is the reference's: there is no order to see
    bool as_promised() const { return exact || (slope && *slope > order - 0.1 && *slope < order + 0.1); }
};
struct IntegratorStudy {
    std::string title, reference;
    std::int64_t bodies = 0;
    double time = 0;
    double reference_error = 0;   // how far the reference is from itself at twice its step
    std::string no_energy_error;  // why the energy's change is no error; empty: it is one
    std::vector<IntegratorCurve> curves;
    bool valid() const;
};

/// Empty where the study can be made; else why not: OpenMM, a thermal start, dampers, drag, driven joints, or no integrator for all chains.
std::string why_integrators_cannot_be_compared(Scene const&);

/// Every deterministic integrator of second or fourth order that the scene's chains have, g-baoab at zero friction included, over `time`:
/// steps of time / 2^k, finest for those of second order `finest`. The reference is rk4 where the chains have it, else rattle, at far
/// smaller steps.
IntegratorStudy study_integrator_errors(Scene const&, Communicator const&, double time, int finest, int repeat);

/// Of a scene whose energy is kept. The energy's trend over many steps: the slope of a straight line through means over blocks of them, and
/// its standard error.
struct DriftStudy {
    std::string title, name;
    double step = 0;
    std::int64_t steps = 0;
    double kinetic_energy = 0;                                                      // mean
    double scatter = 0;                                                             // standard deviation of the energy about its mean
    double slope = 0, slope_error = 0;                                              // per unit of time
    bool valid() const { return slope * slope <= 16 * slope_error * slope_error; }  // four standard errors
};
DriftStudy study_drift(Scene const&, Communicator const&, Integrator, double step, std::int64_t steps);

}  // namespace catena
