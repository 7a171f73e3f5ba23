// Sensitivity of a scene's accelerations to rounding: its condition number with respect to the
// perturbations that the solver's residual measures.
#pragma once

#include "measure/oracle_accelerations.hpp"

namespace catena {

/// Accelerations of a scene with more digits than double precision has, and their sensitivity.
struct ExactSolution {
    std::string by;                    // method: "articulated bodies, 113 bits" or "..., 64 bits"
    std::vector<double> acceleration;  // layout of Solution::acceleration
    // see exact_solution()
    double growth = 1;
};

/// Computes the accelerations of a scene, in 113 bits up to `largest_quad` bodies, else in 64 bits.
/// `layout`: a Solution with offsets and OpenMM's forces.
/// `growth` is the largest relative difference of accelerations (largest_difference()) divided by
/// the size of random perturbations. `nudges` perturbations of the data and of every body's and
/// joint's equations (nudged.hpp) are tried. The growth is at least 1 and at most 2^48.
/// The product of a relative residual and the growth is an O(n) estimate of the error from below.
ExactSolution exact_solution(Scene const&, Solution const& layout, std::int64_t largest_quad,
                             int nudges);

}  // namespace catena
