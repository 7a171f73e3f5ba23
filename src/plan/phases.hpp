// Phases of an evaluation, and the measurement of each of them on one arrangement of this machine.
#pragma once

#include <array>
#include <string>

#include "integrate/chain_system.hpp"
#include "plan/curve.hpp"
#include "plan/family.hpp"

namespace catena::plan {

/// The backend and the number of threads that compute an evaluation.
struct Arrangement {
    Backend backend = Backend::segments;
    /// Number of threads; for cuda and cuda-levels those of the work left to the host.
    int threads = 1;

    bool operator==(Arrangement const&) const = default;
    /// Returns for example "openmp, 8 threads".
    std::string name() const;
};

/// Phases that are timed. `evaluation` is a whole evaluation, which may take less than the sum of
/// its phases: projected handles compute matrices and biases in one sweep. The times are the
/// shortest of several, because disturbances only make a machine slower. `typical_evaluation` is
/// the median, which shows what several threads achieve if other programs use the cores too.
enum Phase : std::size_t {
    kinematics,
    matrix_sweep,
    bias_sweep,
    evaluation,
    typical_evaluation,
    phases
};
/// Names of the phases in tables and JSON.
inline constexpr std::array<char const*, phases> phase_names{
    "kinematics and loads", "matrix sweep", "bias sweep", "evaluation", "evaluation, median"};
/// Seconds of each phase.
using PhaseSeconds = std::array<double, phases>;
/// Seconds of each phase as functions of the number of bodies.
using PhaseCurve = Curve<phases>;

/// Limits of a measurement: it makes at least `least` and at most `most` evaluations and starts no
/// further one after `seconds`.
struct Effort {
    int least = 3, most = 200;
    double seconds = 0.02;
};

/// Returns the scene with its backend and threads replaced by those of the arrangement.
Scene arranged(Scene, Arrangement const&);
/// Measures the phases of several evaluations of the present state, without external forces such as
/// OpenMM's. Collective.
PhaseSeconds measure_phases(ChainSystem&, Effort const& = {});

}  // namespace catena::plan
