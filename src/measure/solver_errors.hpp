// Work-precision of the solver: for each backend and handle kind, how far a scene's accelerations
// are from those of an oracle in extended precision, how well they satisfy the equations, and how
// long they take.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "measure/timing.hpp"

namespace catena {

struct SolverPoint {
    std::string backend, handles;
    int threads = 1;
    double residual = 0, residual_bound = 0;  // backward
    double forward_error = 0;                 // see largest_difference()
    Spread seconds;                           // of one evaluation
    bool valid = false;                       // finite, and the residual is within its bound
};

struct SolverStudy {
    std::string title, file, kind;  // kind: handle kind, several joined by "+"
    std::int64_t bodies = 0;
    int ranks = 1;
    std::string reference;            // "articulated bodies, 113 bits" or "..., 64 bits"
    double oracle_error = 0;          // of the same oracle in double
    Spread oracle_seconds;            // of the same oracle in double, one core
    std::optional<double> condition;  // of the joint-space inertia (beads: the links' matrix), of
                                      // the worst chain, up to `largest_condition` bodies
    std::vector<SolverPoint> points;
    std::vector<std::string> left_out;
};

inline constexpr std::int64_t largest_condition = 300;  // bodies of a scene: O(n^3)
inline constexpr std::int64_t largest_quad =
    20000;  // bodies of a scene: beyond, the reference has 64 bits

/// serial, segments and, where the build has it, openmp.
std::vector<Backend> cpu_backends();

/// Runs the scene once for each of `backends` and `handles`, `repeat` timed evaluations each. The
/// result counts on rank 0. Collective.
SolverStudy study_solver_errors(Scene const&, Communicator const&,
                                std::vector<Backend> const& backends,
                                std::vector<Handles> const& handles, int repeat);

}  // namespace catena
