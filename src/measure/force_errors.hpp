// Work-precision of OpenMM's forces: what each platform and precision gives, and how long it takes.
#pragma once

#include <string>
#include <vector>

#include "measure/timing.hpp"

namespace catena {

struct ForcePoint {
    std::string platform, precision;  // precision: "double", "single" or "mixed"
    double error = 0;  // root mean square of the difference from the Reference platform, over that
                       // of the forces
    double largest_error = 0;  // largest difference, over the largest force
    double bound = 0;          // of both: see force_error_bound()
    Spread seconds;            // of an evaluation of the forces alone
    bool valid() const { return error <= bound && largest_error <= bound; }
};
/// Forces are sums of pairs that cancel, whose terms lose digits where positions are rounded within
/// stiff contacts: 2^12 units of the precision in which pairs are computed (2^-24 single and mixed,
/// 2^-53 double; against Reference, which is double). GPUs add up in steps of 2^-32 kJ/mol/nm: 64
/// of these over the forces' root mean square. And they keep the parameters of custom pair forces
/// in single precision whatever the platform's (OpenMM 8, CommonCalcCustomNonbondedForceKernel): 64
/// times 2^-24.
double force_error_bound(std::string const& platform, std::string const& precision,
                         double rms_force);

struct ForceStudy {
    std::string title;
    std::int64_t beads = 0;
    std::vector<ForcePoint> points;
};

/// Of a scene with forces.openmm, on every platform present, at its start. One rank.
ForceStudy study_force_errors(Scene const&, Communicator const&, int repeat);

}  // namespace catena
