// One row of `bench sampling`: a way to hold links, a step, and what was sampled with them.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "bench/sampling_copies.hpp"
#include "console/outcome.hpp"
#include "measure/blocking.hpp"
#include "measure/timing.hpp"

namespace catena::command {

/// Catena's g-BAOAB on rigid links, without and with the Fixman potential; OpenMM's LangevinMiddle
/// with harmonic bonds and with constraints.
enum class SamplingMethod { rigid, rigid_fixman, bonds, constraints };
char const* name_of(SamplingMethod);
/// InputError for another name than one of these.
SamplingMethod sampling_method_named(std::string const& option, std::string const& name);
/// What it weighs bonds' directions by.
BondMeasure measure_of(SamplingMethod);

struct SamplingRow {
    SamplingMethod method = SamplingMethod::rigid;
    double step = 0;         // ps
    std::string state, why;  // VALID, INVALID, unstable, failed or "too short"; why it is not VALID
    std::int64_t samples = 0;              // a copy
    double every = 0;                      // ps between them: whole steps
    double time = 0, all = 0;              // sampled: ps a copy, ns of all copies together
    bool cut = false;                      // by --seconds
    Blocked gyration, end_to_end, cosine;  // nm, nm, 1
    Blocked temperature, kinetic;          // K: configurational (measure/chain_sample.hpp), kinetic
    double link_error = 0;                 // largest, relative
    double nearest = INFINITY;             // of two copies, nm
    double spacing = 0;                    // of copies at the start, nm
    double rounding = 0;  // nm: of positions in single precision where the outermost bead may be
    Spread seconds;       // of a step, from blocks between samples
    double stepping = 0, sampling = 0;    // seconds that went into steps and into samples
    std::int64_t steps = 0;               // of those
    std::string backend, platform, path;  // of chains and forces

    bool valid() const { return state == "VALID"; }
    double ns_per_day() const {
        return stepping > 0 ? static_cast<double>(steps) * step * 1e-3 * 86400 / stepping : NAN;
    }
};

/// Runs it. A computation that fails is its state; InputError where it cannot be had at all.
SamplingRow run_sampling_row(SamplingCopies&, BenchRequest const&, Communicator const&, Backend,
                             SamplingMethod, double step);

/// Moves the copies' start by so many ps on rigid links, with the scene's own step.
void equilibrate(SamplingCopies&, BenchRequest const&, Communicator const&, Backend, double time);

}  // namespace catena::command
