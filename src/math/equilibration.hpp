// The part of a time series that still moves from its start to its equilibrium.
#pragma once

#include <cstddef>
#include <vector>

namespace catena {

/// Number of samples from which a series is long enough for equilibrated_from() to say anything.
inline constexpr std::size_t fewest_for_equilibration = 20;

/// Returns the index of the first sample of the series' stationary part: the cut d, at most half of
/// the series, for which the mean of the rest has the smallest standard error. The error is that of
/// independent samples, sqrt(sum_{i>=d} (x_i - mean_d)^2) / (n - d), the marginal standard error
/// rule (K. P. White, Simulation 69, 323, 1997). Of equal cuts the first counts. Returns 0 for
/// fewer than `fewest_for_equilibration` samples, and if a value is not finite.
std::size_t equilibrated_from(std::vector<double> const& series);

}  // namespace catena
