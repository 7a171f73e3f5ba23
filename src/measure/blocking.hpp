// Means of time series whose neighbours are alike, with errors by blocking (Flyvbjerg & Petersen,
// J. Chem. Phys. 91, 461, 1989).
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

namespace catena {

/// One series a copy of what was sampled; the copies have nothing to do with each other. All of one
/// length.
using CopySeries = std::vector<std::vector<double>>;

struct Blocked {
    double mean = NAN,
           error = NAN;      // standard error of the mean; NaN where there is too little to tell
    std::int64_t block = 0;  // samples of the block whose error was taken
    bool plateau =
        false;  // false: the errors may still grow where the series ended, and is too small
};

/// Each copy's series is cut into blocks of 1, 2, 4, ... samples and at last into one; of every
/// length, blocks of all copies are pooled and their scatter around the mean of all gives an error.
/// The last is that of the shortest block B with B^3 > 2 n (error_B / error_1)^4, n all samples (R.
/// M. Lee et al., Phys. Rev. E 83, 066706, 2011): what B leaves out of the correlations is then
/// less than what the number of blocks leaves uncertain. Where no B with 16 blocks is that long,
/// there is no plateau, but of 16 copies, which are blocks enough by themselves. Taken is the
/// largest error up to there: the condition asks for that very error, and would end too often where
/// chance has made it small.
Blocked blocked_mean(CopySeries const&);

/// mean(above) / mean(below), and its error to first order: that of mean(above - ratio below) /
/// mean(below). Both of one shape.
Blocked blocked_ratio(CopySeries const& above, CopySeries const& below);

}  // namespace catena
