// Means of correlated time series, with standard errors by blocking (Flyvbjerg & Petersen, J. Chem.
// Phys. 91, 461, 1989).
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

namespace catena {

/// One time series per statistically independent copy of the sampled system, all of one length.
using CopySeries = std::vector<std::vector<double>>;

/// A mean with its standard error. Both are NaN if there are no data.
struct Blocked {
    /// Mean, and its standard error, which is NaN if there are too few data.
    double mean = NAN, error = NAN;
    std::int64_t block = 0;  // samples per block for which the error was computed
    /// False if the error may still grow with longer blocks than the series allow, so that it is
    /// too small.
    bool plateau = false;
};

/// Returns the mean over all copies and its standard error.
/// Each copy's series is cut into blocks of 1, 2, 4, ... samples, and at last into one. For each
/// length, the scatter of all copies' blocks around the common mean gives an error.
/// The last length is the shortest block B with B^3 > 2 n (error_B / error_1)^4, n all samples (R.
/// M. Lee et al., Phys. Rev. E 83, 066706, 2011). The correlations that B neglects are then smaller
/// than the uncertainty due to the number of blocks. If no B with 16 blocks is that long, there is
/// no plateau. With 16 copies there is one, because the copies themselves are enough blocks.
/// The result is the largest error up to that length. The condition depends on the same error, and
/// would stop too early if chance made that error small.
Blocked blocked_mean(CopySeries const&);

/// Returns mean(above) / mean(below) and its standard error to first order, which is that of
/// mean(above - ratio below) / mean(below). Precondition: both have the same shape.
Blocked blocked_ratio(CopySeries const& above, CopySeries const& below);

}  // namespace catena
