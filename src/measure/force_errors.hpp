// Work-precision study of OpenMM's forces: error and time for each platform and precision.
#pragma once

#include <string>
#include <vector>

#include "measure/timing.hpp"

namespace catena {

/// Errors and time of the forces on one platform with one precision.
struct ForcePoint {
    std::string platform, precision;  // precision: "double", "single" or "mixed"
    /// Root mean square of the difference from the Reference platform, divided by that of the
    /// forces.
    double error = 0;
    /// Largest difference, divided by the largest force.
    double largest_error = 0;
    /// Bound of both errors: see force_error_bound().
    double bound = 0;
    Spread seconds;  // seconds per evaluation of the forces alone
    bool valid() const { return error <= bound && largest_error <= bound; }
};
/// Returns the largest error that rounding explains.
/// Forces are sums of pair forces that cancel. The pair forces lose digits because positions are
/// rounded within stiff contacts. That is 2^12 units of the precision in which pairs are computed
/// (2^-24 single and mixed, 2^-53 double; Reference is double).
/// GPUs add forces in steps of 2^-32 kJ/mol/nm: 64 of these, divided by the forces' root mean
/// square `rms_force`. They also store the parameters of custom pair forces in single precision on
/// any platform (OpenMM 8, CommonCalcCustomNonbondedForceKernel): 64 times 2^-24.
double force_error_bound(std::string const& platform, std::string const& precision,
                         double rms_force);

/// Errors of one scene's forces on all platforms.
struct ForceStudy {
    std::string title;
    std::int64_t beads = 0;
    std::vector<ForcePoint> points;
};

/// Evaluates the start of a scene with forces.openmm on every available platform. Precondition: one
/// rank.
ForceStudy study_force_errors(Scene const&, Communicator const&, int repeat);

}  // namespace catena
