// The PI controller of inner steps.
#include "integrate/step_control.hpp"

#include <algorithm>
#include <cmath>

namespace catena {
namespace {

constexpr double safety = 0.9, least_factor = 0.2, most_factor = 5;
// Smallest error that the controller remembers: one very accurate step must not shorten the next.
constexpr double least_error = 1e-4;
constexpr double slack = 1.01;  // allows a step 1 % longer rather than one step more

/// Returns x^(1/2^times).
double root(double x, int times) {
    for (int i = 0; i < times; ++i) x = std::sqrt(x);
    return x;
}

}  // namespace

double StepControl::length(double left) const {
    double const steps = std::ceil(left / (slack * state_.length));
    return steps <= 1 ? left : left / steps;
}

bool StepControl::accepts(double length, double error) {
    if (!(error <= 1)) {
        double const factor =
            std::isfinite(error) ? safety / (root(error, 3) * root(error, 4)) : 0.0;
        state_.length = length * std::max(factor, least_factor);
        ++counts_.rejected;
        after_rejection_ = true;
        return false;
    }
    double const e = std::max(error, 1e-10);
    double const most = after_rejection_ ? 1.0 : most_factor;
    double const next =
        length * std::clamp(safety * root(state_.previous, 4) / (root(e, 3) * root(e, 5)),
                            least_factor, most);
    // A step far below the proposed length, cut at the end of the interval, is no evidence against
    // that length.
    bool const cut = length < 0.5 * state_.length;
    state_.length = std::min(longest_, cut ? std::max(state_.length, next) : next);
    if (!cut) state_.previous = std::max(error, least_error);
    after_rejection_ = false;
    counts_.shortest = counts_.taken == 0 ? length : std::min(counts_.shortest, length);
    counts_.longest = std::max(counts_.longest, length);
    ++counts_.taken;
    return true;
}

}  // namespace catena
