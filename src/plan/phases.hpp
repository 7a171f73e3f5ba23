// What an evaluation is made of, and how long each part takes on one arrangement of this machine.
#pragma once

#include <array>
#include <string>

#include "integrate/chain_system.hpp"
#include "plan/curve.hpp"
#include "plan/family.hpp"

namespace catena::plan {

/// Where an evaluation runs.
struct Arrangement {
    Backend backend = Backend::segments;
    int threads = 1;  // of cuda and cuda-levels: what they leave to the host

    bool operator==(Arrangement const&) const = default;
    /// "openmp, 8 threads"
    std::string name() const;
};

/// `evaluation` is the whole of it, which may be less than its phases: projected handles have
/// matrices and biases in one sweep. What disturbs a machine makes it slower, never faster: these
/// are the shortest of several; `typical_evaluation` is their median, which says what several
/// threads really come to where others use the cores too.
enum Phase : std::size_t {
    kinematics,
    matrix_sweep,
    bias_sweep,
    evaluation,
    typical_evaluation,
    phases
};
inline constexpr std::array<char const*, phases> phase_names{
    "kinematics and loads", "matrix sweep", "bias sweep", "evaluation", "evaluation, median"};
using PhaseSeconds = std::array<double, phases>;
using PhaseCurve = Curve<phases>;

/// How much a measurement may cost: evaluations, and seconds after which no more are begun (`least`
/// are made in any case).
struct Effort {
    int least = 3, most = 200;
    double seconds = 0.02;
};

/// The scene with the arrangement in the place of its own.
Scene arranged(Scene, Arrangement const&);
/// Over several evaluations of the present state; forces from outside do not count. Collective.
PhaseSeconds measure_phases(ChainSystem&, Effort const& = {});

}  // namespace catena::plan
