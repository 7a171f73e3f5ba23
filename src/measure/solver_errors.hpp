// Work-precision study of the solver. For each backend and handle kind it compares accelerations
// with an oracle in extended precision, and gives residual and time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "measure/timing.hpp"

namespace catena {

/// One backend with one kind of handles.
struct SolverPoint {
    std::string backend, handles;
    int threads = 1;
    double residual = 0, residual_bound = 0;  // backward error and its bound
    double forward_error = 0;                 // relative to the reference; see largest_difference()
    Spread seconds;                           // seconds of one evaluation
    bool valid = false;                       // true if finite and the residual is within its bound
};

/// Results for one scene on all backends and handles.
struct SolverStudy {
    std::string title, file, kind;  // kind: handle kind, several joined by "+"
    std::int64_t bodies = 0;
    int ranks = 1;
    std::string reference;    // method: "articulated bodies, 113 bits" or "..., 64 bits"
    double oracle_error = 0;  // error of the same oracle in double precision
    Spread oracle_seconds;    // seconds of the same oracle in double precision, one core
    /// Condition number of the joint-space inertia (beads: of the links' matrix). It is the largest
    /// of all chains, and absent beyond `largest_condition` bodies.
    std::optional<double> condition;
    std::vector<SolverPoint> points;
    // combinations that were left out, with reasons
    std::vector<std::string> left_out;
};

/// Largest number of bodies for which condition numbers are computed, at a cost of O(n^3).
inline constexpr std::int64_t largest_condition = 300;
/// Largest number of bodies with a reference of 113 bits; beyond, it has 64 bits.
inline constexpr std::int64_t largest_quad = 20000;

/// Returns serial, segments and, if the build has it, openmp.
std::vector<Backend> cpu_backends();

/// Evaluates the scene's start with each of `backends` and `handles`, with `repeat` timed
/// evaluations each. The result is valid on rank 0. Collective.
SolverStudy study_solver_errors(Scene const&, Communicator const&,
                                std::vector<Backend> const& backends,
                                std::vector<Handles> const& handles, int repeat);

}  // namespace catena
