// One row of `bench sampling`: a method to keep links, a time step, and what was sampled with them.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "bench/sampled_chains.hpp"
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

/// Mean of a number that describes all chains (SystemValue).
struct SystemMean {
    std::string name, unit;
    Blocked mean;
};
/// True if the number is an energy of a term.
bool is_energy(SystemMean const&);

/// Numbers that describe all chains of a row together.
struct ChainsTogether {
    /// Means; none for copies that never meet.
    std::vector<SystemMean> means;
    /// Displacement of the chains' centres of mass from the first sample to the last,
    /// <|dx|^2> / (6 t), nm^2/ns, with the standard error over chains; NaN with one sample.
    Blocked diffusion;
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

/// Programs behind a row: backend of the chains, platform and path of the forces.
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
    /// Mean radius of gyration of each chain, nm.
    std::vector<double> gyration_of_chains;
    /// Configurational (measure/chain_sample.hpp) and kinetic temperature, K.
    Blocked temperature, kinetic;
    ChainsTogether together;
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
SamplingRow run_sampling_row(SampledChains&, BenchRequest const&, Communicator const&, Backend,
                             SamplingMethod, double step);

/// Moves the start of the chains by this many ps on rigid links, with the scene's own time step.
void equilibrate(SampledChains&, BenchRequest const&, Communicator const&, Backend, double time);

}  // namespace catena::command
