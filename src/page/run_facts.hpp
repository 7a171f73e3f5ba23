// The science of a run in words: what was simulated, what was observed, how fast, and the verdict.
// The terminal and report.html show the same lines.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

namespace catena {

/// Line of a name and its value.
struct Fact {
    std::string name, value;
};

/// Row of the table of observables: mean and standard error are rounded alike.
struct ObservableRow {
    std::string name, mean, standard_error, unit;
};

// The functions below read a run's summary.json (inputs/keys/output.md). What it lacks is left out;
// a value of another type throws nlohmann::json::exception.

/// Returns system, forces, assumed net charge, box, concentration, temperature, integrator and
/// simulated time.
std::vector<Fact> system_facts(nlohmann::ordered_json const& summary);
/// Returns a row for each observable. The standard error is "at least" what blocking yields if it
/// may still grow.
std::vector<ObservableRow> observable_rows(nlohmann::ordered_json const& summary);
/// Returns the sentence on the frames that the means are of; empty if there are none.
std::string equilibration_sentence(nlohmann::ordered_json const& summary);
/// Returns simulated time per day, time per step and duration.
std::vector<Fact> speed_facts(nlohmann::ordered_json const& summary);
/// Returns the first failed check with its advice, else every check with value and limit; empty if
/// there is no verdict.
std::string verdict_reason(nlohmann::ordered_json const& summary);

/// Returns the texts of a mean and of its standard error, which has two digits. Both end at the
/// same decimal place. An error that is zero, not finite or below 1e-6 of the mean leaves six
/// digits of the mean.
std::pair<std::string, std::string> rounded_alike(double mean, double standard_error);

}  // namespace catena
