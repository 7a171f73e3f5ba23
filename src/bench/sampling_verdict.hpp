// Conclusions from the rows of `bench sampling`: biases, the largest usable step of each method,
// differences between methods.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/sampling_rows.hpp"

namespace catena::command {

/// Bias of one quantity in percent, with its standard error.
struct QuantityBias {
    /// Short name, for a heading.
    std::string name;
    double percent = 0, error = 0;
    /// True if the errors have reached their plateau.
    bool known = false;
    /// True if the bias and its error are below 1 %.
    bool allowed() const;
    /// True if the bias stays below 1 % even with two standard errors more.
    bool shown() const;
    /// True if the bias is above 1 % even with two standard errors less.
    bool refuted() const;
};

/// Biases of a row. Those of means are relative to the same method's smallest step: of the radius
/// of gyration and, of dense systems, of what describes all chains. An energy's bias is relative to
/// the sum of the magnitudes of all energies. The bias of the configurational temperature is
/// relative to that of the thermostat.
struct SamplingBias {
    /// The radius of gyration, the configurational temperature, then all of SamplingRow::together.
    /// Biases of means are zero for the smallest step, which is the reference; all are NaN if a row
    /// is not VALID.
    std::vector<QuantityBias> of;
    bool is_reference = false;
    QuantityBias const& gyration() const { return of[0]; }
    QuantityBias const& temperature() const { return of[1]; }
    bool allowed() const;
    bool shown() const;
    /// True if one of the biases is refuted.
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
/// Returns the differences of each method from bonds, and of constraints from rigid, at the
/// methods' smallest steps if those rows are VALID.
std::vector<SamplingDifference> differences_of(std::vector<SamplingMethodVerdict> const&);

}  // namespace catena::command
