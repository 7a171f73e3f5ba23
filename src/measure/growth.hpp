// How strongly a scene's accelerations answer to roundings: its condition number, in the sense that
// the solver's own residual has.
#pragma once

#include "measure/oracle_accelerations.hpp"

namespace catena {

/// What a scene's answer is, to more digits than double has, and what it hangs on.
struct ExactSolution {
    std::string by;                    // "articulated bodies, 113 bits" or "..., 64 bits"
    std::vector<double> acceleration;  // as Solution::acceleration
    double growth = 1;
};

/// growth: the largest difference of accelerations (largest_difference()) per size of `nudges`
/// random changes of the data and of every body's and joint's equations (nudged.hpp), at least 1.
/// It is what a relative residual is to be multiplied by: an O(n) estimate from below, and no
/// larger than 2^48. 113 bits up to `largest_quad` bodies.
ExactSolution exact_solution(Scene const&, Solution const& layout, std::int64_t largest_quad,
                             int nudges);

}  // namespace catena
