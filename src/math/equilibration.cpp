// Implements the marginal standard error rule.
#include "math/equilibration.hpp"

#include <cmath>

namespace catena {

/// Suffixes grow from the end, so that one pass with Welford's updates gives every cut's error.
std::size_t equilibrated_from(std::vector<double> const& series) {
    std::size_t const n = series.size();
    if (n < fewest_for_equilibration) return 0;
    std::size_t best = 0;
    double least = INFINITY, mean = 0, squares = 0;
    for (std::size_t count = 1; count <= n; ++count) {
        double const value = series[n - count], before = value - mean;
        if (!std::isfinite(value)) return 0;
        mean += before / static_cast<double>(count);
        squares += before * (value - mean);
        if (2 * count < n) continue;
        double const error = squares / (static_cast<double>(count) * static_cast<double>(count));
        if (error > least) continue;
        least = error;
        best = n - count;
    }
    return best;
}

}  // namespace catena
