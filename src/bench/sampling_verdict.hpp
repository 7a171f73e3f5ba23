// What the rows of `bench sampling` say together: biases, the largest usable step of each method,
// differences between methods.
#pragma once

#include <optional>
#include <vector>

#include "bench/sampling_rows.hpp"

namespace catena::command {

/// In percent, with standard errors: of the mean radius of gyration against the same method's
/// smallest step, and of the configurational temperature against the one that the dynamics is
/// given.
struct SamplingBias {
    double gyration = 0,
           gyration_error =
               0;  // zeros for the smallest step itself, the reference; NaN where that is not VALID
    double temperature = 0, temperature_error = 0;
    bool is_reference = false;
    bool errors_known = false;  // all of them at their plateau
    bool allowed() const;       // both below 1 %, and their errors
    bool shown() const;         // so far below that two standard errors more would be, too
    bool refuted() const;       // one is above 1 % even with two standard errors less
    /// "reference", "shown", "not contradicted", "no", "no reference", or "errors too large to
    /// tell".
    char const* word() const;
};

struct SamplingMethodVerdict {
    SamplingMethod method = SamplingMethod::rigid;
    std::vector<SamplingRow const*> rows;  // by step, of every state
    std::vector<SamplingBias> bias;        // one a row; NaN of what is not VALID
    /// Rows of the longest steps that are usable: these and all shorter ones are VALID and their
    /// biases allowed (shown). nullptr: none but the reference is.
    SamplingRow const *allowed = nullptr, *shown = nullptr;
};

/// Methods in the order in which they come. The rows must outlive it.
std::vector<SamplingMethodVerdict> verdicts_of(std::vector<SamplingRow> const&, double temperature);

struct Difference {
    double value = 0, error = 0;  // error: of independent runs. These begin alike: short ones are
                                  // nearer to each other
    double errors() const { return error > 0 ? value / error : NAN; }
};
/// Of one method's row less another's.
struct SamplingDifference {
    SamplingRow const *of = nullptr, *less = nullptr;
    Difference gyration, end_to_end, cosine;
};
/// Each method less bonds, and constraints less rigid, at the methods' smallest steps; where those
/// are VALID.
std::vector<SamplingDifference> differences_of(std::vector<SamplingMethodVerdict> const&);

}  // namespace catena::command
