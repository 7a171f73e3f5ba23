// Quotients and roots without branches (cuda/sweeps/branchless_math.cuh) of many numbers, on the
// GPU.
#pragma once

#include <vector>

namespace catena::test {

/// 1 / x, NaN where that is not known.
std::vector<double> quick_inverses(std::vector<double> const& x);
/// 1 / x, which is found another way where that is not known.
std::vector<double> inverses_in_any_case(std::vector<double> const& x);
/// 1 / |(x, 0, 0)|
std::vector<double> quick_inverse_lengths(std::vector<double> const& x);

}  // namespace catena::test
