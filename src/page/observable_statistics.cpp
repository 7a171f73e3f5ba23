// Implements the statistics of a run's table.
#include "page/observable_statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "error.hpp"
#include "math/blocking.hpp"
#include "math/equilibration.hpp"
#include "page/html.hpp"

namespace catena {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t first_observable = 2;  // step and time stand before the observables

/// Latest first frame of the stationary part, and the observable that needs it.
struct Equilibration {
    std::size_t frame = 0;
    std::string observable;
};

Equilibration equilibration_of(ObservablesTable const& table) {
    Equilibration latest;
    for (std::size_t k = first_observable; k < table.names.size(); ++k) {
        std::string const name = name_and_unit(table.names[k]).first;
        if (name == "constraint_error") continue;
        std::size_t const frame = equilibrated_from(table.columns[k]);
        if (frame > latest.frame) latest = {frame, name};
    }
    return latest;
}

/// "All 30 frames count", or what holds for a single one.
std::string all_count(std::size_t frames) {
    return frames == 1 ? "The only frame counts" : fmt::format("All {} frames count", frames);
}

/// Sentence on the frames that count where a thermostat lets the start be forgotten.
std::string sentence_on(Equilibration const& start, ObservablesTable const& table) {
    std::size_t const frames = table.columns[0].size();
    if (frames < fewest_for_equilibration)
        return fmt::format(
            "{}, equilibration included: fewer than {} frames do not show where it "
            "ends.",
            all_count(frames), fewest_for_equilibration);
    if (start.frame == 0) return all_count(frames) + ": no equilibration is recognised.";
    std::string text = fmt::format(
        "The first {} of {} frames, before step {:.0f}, are left out as equilibration of the {}.",
        start.frame, frames, table.columns[0][start.frame], readable_words(start.observable));
    if (2 * start.frame + 1 >= frames)
        text += " That is the most that is left out: the run may not have reached equilibrium.";
    return text;
}

ObservableStatistics statistics_of_column(ObservablesTable const& table, std::size_t k,
                                          std::size_t left_out) {
    auto const [name, unit] = name_and_unit(table.names[k]);
    std::vector<double> const& all = table.columns[k];
    std::vector<double> const rest(all.begin() + static_cast<std::ptrdiff_t>(left_out), all.end());
    Blocked const found = blocked_mean({rest});
    return {.name = name,
            .unit = unit,
            .mean = found.mean,
            .standard_error = found.error,
            .converged = found.plateau,
            .samples = std::ssize(rest),
            .last = all.back()};
}

/// Series of the replicas of each mean over them, from frame `left_out` on.
std::vector<CopySeries> series_of(ObservablesTable const& of_replicas, std::size_t means,
                                  std::size_t left_out) {
    std::size_t const replicas = (of_replicas.names.size() - first_observable) / means;
    std::vector<CopySeries> all(means);
    for (std::size_t k = 0; k < means * replicas; ++k) {
        std::vector<double> const& column = of_replicas.columns[first_observable + k];
        all[k / replicas].emplace_back(column.begin() + static_cast<std::ptrdiff_t>(left_out),
                                       column.end());
    }
    return all;
}

double mean_of(std::vector<double> const& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Sum of the squared deviations from the mean.
double squares_of(std::vector<double> const& values) {
    double const mean = mean_of(values);
    double squares = 0;
    for (double const each : values) squares += (each - mean) * (each - mean);
    return squares;
}

/// Variance between replicas, mean over frames [first, last).
double spread_of(CopySeries const& series, std::size_t first, std::size_t last) {
    double sum = 0;
    std::vector<double> values(series.size());
    for (std::size_t f = first; f < last; ++f) {
        for (std::size_t r = 0; r < series.size(); ++r) values[r] = series[r][f];
        sum += squares_of(values) / static_cast<double>(series.size() - 1);
    }
    return sum / static_cast<double>(last - first);
}

/// True if replicas differ more in the second half of their frames than in the first, by three
/// times the uncertainty of variances: they still remember a common start.
bool still_spreads(CopySeries const& series) {
    std::size_t const frames = series.front().size();
    if (frames < 2) return true;
    double const before = spread_of(series, 0, frames / 2),
                 after = spread_of(series, frames / 2, frames);
    return after > before * (1 + 6 / std::sqrt(static_cast<double>(series.size() - 1)));
}

/// Makes the error of a mean over replicas that of independent series. Replicas forget their start
/// separately, so that one of them may say more of the error than the mean's time series.
void count_replicas(ObservableStatistics& of, CopySeries const& series) {
    std::vector<double> means;
    for (auto const& replica : series) means.push_back(mean_of(replica));
    auto const count = static_cast<double>(means.size());
    Blocked const found = blocked_mean(series);
    of.replicas = std::ssize(series);
    of.between_replicas = std::sqrt(squares_of(means) / (count * (count - 1)));
    of.standard_error = std::max(found.error, of.between_replicas);
    of.converged = found.plateau && !still_spreads(series);
}

/// Counts the replicas of all means over them.
void count_replicas(TableStatistics& found, ObservablesTable const& table,
                    ObservablesTable const& of_replicas) {
    if (of_replicas.names.size() <= first_observable) return;
    if (of_replicas.columns[0] != table.columns[0])
        throw InputError("the lines of replicas.csv and observables.csv are of different steps",
                         "replicas.csv", "run the scene again");
    std::vector<ObservableStatistics*> means;
    for (ObservableStatistics& each : found.observables)
        if (each.name.starts_with("mean_")) means.push_back(&each);
    auto const series = series_of(of_replicas, means.size(), found.left_out);
    bool spreads = false;
    for (std::size_t k = 0; k < means.size(); ++k) {
        count_replicas(*means[k], series[k]);
        spreads = spreads || still_spreads(series[k]);
    }
    found.says += fmt::format(
        " Errors of means over {} replicas are those of independent series, and at least the "
        "scatter of the replicas' own means.",
        means.empty() ? 0 : means[0]->replicas);
    if (spreads)
        found.says +=
            " Replicas still spread: they have not forgotten their start, and means may be off.";
}

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

}  // namespace

std::pair<std::string, std::string> name_and_unit(std::string const& column) {
    auto const open = column.rfind(" [");
    if (open == std::string::npos || column.back() != ']') return {column, ""};
    return {column.substr(0, open), column.substr(open + 2, column.size() - open - 3)};
}

TableStatistics statistics_of(ObservablesTable const& table, Frames which,
                              ObservablesTable const& of_replicas) {
    TableStatistics found;
    found.frames = table.columns.empty() ? 0 : table.columns[0].size();
    if (found.frames == 0) return found;
    found.says = all_count(found.frames);
    if (which == Frames::equilibrated) {
        Equilibration const start = equilibration_of(table);
        found.left_out = start.frame;
        found.says = sentence_on(start, table);
    } else {
        found.says += which == Frames::all
                          ? "."
                          : ": there is no thermostat, so no equilibration is left out.";
    }
    for (std::size_t k = first_observable; k < table.names.size(); ++k)
        found.observables.push_back(statistics_of_column(table, k, found.left_out));
    count_replicas(found, table, of_replicas);
    return found;
}

Json json_of(TableStatistics const& statistics) {
    Json observables = Json::object();
    for (ObservableStatistics const& each : statistics.observables) {
        observables[each.name] = {{"mean", finite_or_null(each.mean)},
                                  {"standard_error", finite_or_null(each.standard_error)},
                                  {"unit", each.unit},
                                  {"samples", each.samples},
                                  {"converged", each.converged},
                                  {"last", finite_or_null(each.last)}};
        if (each.replicas > 0)
            observables[each.name].update(
                {{"replicas", each.replicas},
                 {"standard_error_between_replicas", finite_or_null(each.between_replicas)}});
    }
    return {{"observables", observables},
            {"equilibration",
             {{"frames", statistics.frames},
              {"frames_left_out", statistics.left_out},
              {"description", statistics.says}}}};
}

}  // namespace catena
