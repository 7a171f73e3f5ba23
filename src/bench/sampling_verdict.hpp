// Conclusions from the rows of `bench sampling`: biases, the largest usable step of each method,
// differences between methods.
#pragma once

#include <optional>
#include <vector>

#include "bench/sampling_rows.hpp"

namespace catena::command {

/// Biases in percent with standard errors: of the mean radius of gyration relative to the same
/// method's smallest step, and of the configurational temperature relative to that of the
/// thermostat.
struct SamplingBias {
    /// Zero for the smallest step, which is the reference; NaN if that row is not VALID.
    double gyration = 0, gyration_error = 0;
    double temperature = 0, temperature_error = 0;
    bool is_reference = false;
    /// True if all errors have reached their plateau.
    bool errors_known = false;
    /// True if both biases and their errors are below 1 %.
    bool allowed() const;
    /// True if both stay below 1 % even with two standard errors more.
    bool shown() const;
    /// True if one is above 1 % even with two standard errors less.
    bool refuted() const;
    /// Returns "reference", "shown", "not contradicted", "no", "no reference", or "errors too large
    /// to tell".
    char const* word() const;
};

/// Rows and biases of one method.
struct SamplingMethodVerdict {
    SamplingMethod method = SamplingMethod::rigid;
    /// Rows of every state, sorted by time step.
    std::vector<SamplingRow const*> rows;
    /// Biases, one per row; NaN for rows that are not VALID.
    std::vector<SamplingBias> bias;
    /// Rows of the longest usable steps: these and all shorter ones are VALID and their biases
    /// allowed (shown). nullptr if only the reference is usable.
    SamplingRow const *allowed = nullptr, *shown = nullptr;
};

/// Returns the verdicts of all methods in the order in which they occur. The rows must outlive the
/// result.
std::vector<SamplingMethodVerdict> verdicts_of(std::vector<SamplingRow> const&, double temperature);

/// A difference with its error.
struct Difference {
    /// The error is that of independent runs. The runs here start alike, so that short ones are
    /// closer to each other.
    double value = 0, error = 0;
    double errors() const { return error > 0 ? value / error : NAN; }
};
/// Differences of one method's row from another's.
struct SamplingDifference {
    SamplingRow const *of = nullptr, *less = nullptr;
    Difference gyration, end_to_end, cosine;
};
/// Each method less bonds, and constraints less rigid, at the methods' smallest steps; where those
/// Returns the differences of each method from bonds, and of constraints from rigid, at the
/// methods' smallest steps if those rows are VALID.
std::vector<SamplingDifference> differences_of(std::vector<SamplingMethodVerdict> const&);

}  // namespace catena::command
