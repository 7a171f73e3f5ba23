// One row of `bench sampling`: a method to keep links, a time step, and what was sampled with them.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "bench/sampling_copies.hpp"
#include "console/outcome.hpp"
#include "math/blocking.hpp"
#include "measure/timing.hpp"

namespace catena::command {

/// Methods: Catena's g-BAOAB on rigid links, without and with the Fixman potential; OpenMM's
/// LangevinMiddle with harmonic bonds and with constraints.
enum class SamplingMethod { rigid, rigid_fixman, bonds, constraints };
char const* name_of(SamplingMethod);
/// Returns the method of a name. Throws InputError for an unknown name.
SamplingMethod sampling_method_named(std::string const& option, std::string const& name);
/// Returns the measure of bond directions that the method samples.
BondMeasure measure_of(SamplingMethod);

/// Distances of the copies of a row, nm.
struct CopyDistances {
    /// Smallest distance of two copies at any sample.
    double nearest = INFINITY;
    /// Distance of the copies at the start.
    double spacing = 0;
    /// Rounding of positions in single precision at the outermost possible bead.
    double rounding = 0;
};

/// Wall time of the steps and samples of a row.
struct SamplingTimes {
    /// Seconds per step, from the blocks between samples.
    Spread seconds;
    /// Seconds spent in steps and in samples.
    double stepping = 0, sampling = 0;
    /// Number of these steps.
    std::int64_t steps = 0;
};

/// What computes a row: backend of the chains, platform and path of the forces.
struct SamplingEngine {
    std::string backend, platform, path;
};

/// Conditions and results of a row. Means have standard errors by blocking.
struct SamplingRow {
    SamplingMethod method = SamplingMethod::rigid;
    /// Time step, ps.
    double step = 0;
    /// State of the row, VALID, INVALID, unstable, failed or "too short", and why it is not VALID.
    std::string state, why;
    /// Number of samples per copy.
    std::int64_t samples = 0;
    /// Time between samples in whole steps, ps.
    double every = 0;
    /// Sampled time: ps per copy, ns of all copies together.
    double time = 0, all = 0;
    /// True if --seconds ended the row.
    bool cut = false;
    /// Means: nm, nm, 1.
    Blocked gyration, end_to_end, cosine;
    /// Configurational (measure/chain_sample.hpp) and kinetic temperature, K.
    Blocked temperature, kinetic;
    /// Largest relative error of a link.
    double link_error = 0;
    CopyDistances distances;
    SamplingTimes times;
    SamplingEngine engine;

    bool valid() const { return state == "VALID"; }
    double ns_per_day() const {
        return times.stepping > 0
                   ? static_cast<double>(times.steps) * step * 1e-3 * 86400 / times.stepping
                   : NAN;
    }
};

/// Runs a row. A failed computation becomes its state. Throws InputError if the row cannot run at
/// all.
SamplingRow run_sampling_row(SamplingCopies&, BenchRequest const&, Communicator const&, Backend,
                             SamplingMethod, double step);

/// Moves the start of the copies by this many ps on rigid links, with the scene's own time step.
void equilibrate(SamplingCopies&, BenchRequest const&, Communicator const&, Backend, double time);

}  // namespace catena::command
