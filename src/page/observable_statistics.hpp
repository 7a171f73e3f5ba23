// Means and standard errors of the observables of a run.
#pragma once

#include <cmath>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "io/observables_table.hpp"

namespace catena {

/// Splits the name of a column: "total_energy [kJ/mol]" -> {"total_energy", "kJ/mol"}.
std::pair<std::string, std::string> name_and_unit(std::string const& column);

/// Statistics of one observable over the frames that count.
struct ObservableStatistics {
    std::string name, unit;
    /// Mean, and its standard error by blocking (math/blocking.hpp). The error is NaN for fewer
    /// than two frames.
    double mean = NAN, standard_error = NAN;
    /// False if the standard error may still grow with a longer run, so that it is too small.
    bool converged = false;
    std::int64_t samples = 0;
    double last = NAN;  // value of the last frame
    /// Number of replicas whose mean this is, 0: of none; scatter of their own means, divided by
    /// the root of that number. `standard_error` is at least that.
    std::int64_t replicas = 0;
    double between_replicas = NAN;
};

/// Statistics of a run's table, over all frames since the scene's start or the branch.
struct TableStatistics {
    std::size_t frames = 0;
    std::size_t left_out = 0;  // first frames, which are taken for equilibration
    /// Sentence on the frames that count and why.
    std::string says;
    std::vector<ObservableStatistics> observables;
};

/// Frames that count. `equilibrated`: those from equilibrated_from() (math/equilibration.hpp) of
/// the slowest observable on; the constraint error does not decide. `without_thermostat`: all,
/// because nothing makes the run forget its start. `all`: all, for a table of unknown origin.
enum class Frames { equilibrated, without_thermostat, all };
/// `of_replicas`: table of the replicas (Observables::replica_columns()), without columns if there
/// are none. Throws InputError if it has other lines than the table of their means.
TableStatistics statistics_of(ObservablesTable const&, Frames,
                              ObservablesTable const& of_replicas = {});

/// Returns {"observables": {name: {"mean", "standard_error", "unit", "samples", "converged",
/// "last"}}, "equilibration": {"frames", "frames_left_out", "description"}}. A number that is not
/// finite becomes null. Means over replicas have "replicas" and "standard_error_between_replicas".
nlohmann::ordered_json json_of(TableStatistics const&);

}  // namespace catena
