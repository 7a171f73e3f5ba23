// Implements biases, usable steps and differences.
#include "bench/sampling_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace catena::command {
namespace {

/// Largest allowed bias in percent.
constexpr double allowed_percent = 1;
/// Number of chains from which the scatter of their differences gives an error.
constexpr std::size_t chains_to_compare = 16;
/// Part of the error of independent rows from which chains count as having forgotten the start.
constexpr double forgotten = 0.9;

/// Returns the bias of a mean relative to another, in percent of `scale`.
QuantityBias bias_of(std::string name, Blocked const& mean, Blocked const& reference,
                     double scale) {
    return {std::move(name), 100 * (mean.mean - reference.mean) / scale,
            100 * std::hypot(mean.error, reference.error) / scale,
            mean.plateau && reference.plateau};
}

/// Returns the bias of the radius of gyration. All rows start alike, and chains that are slow to
/// relax remember it: the error is that of the differences chain by chain. It is no final error as
/// long as it is well below that of independent rows, since the bias of such chains has not shown.
QuantityBias bias_of_gyration(SamplingRow const& row, SamplingRow const& smallest) {
    QuantityBias bias = bias_of("Rg", row.gyration, smallest.gyration, smallest.gyration.mean);
    CopySeries differences;
    for (std::size_t c = 0;
         c < std::min(row.gyration_of_chains.size(), smallest.gyration_of_chains.size()); ++c)
        differences.push_back({row.gyration_of_chains[c] - smallest.gyration_of_chains[c]});
    if (differences.size() < chains_to_compare) return bias;
    double const independent = bias.error;
    bias.error = 100 * blocked_mean(differences).error / smallest.gyration.mean;
    bias.known = bias.known && bias.error >= forgotten * independent;
    return bias;
}

/// Returns the sum of the magnitudes of all energies of a row.
double energy_scale(SamplingRow const& row) {
    double sum = 0;
    for (SystemMean const& each : row.together.means)
        if (is_energy(each)) sum += std::abs(each.mean.mean);
    return sum;
}

/// Returns the biases of a row.
SamplingBias biases_of(SamplingRow const& row, SamplingRow const& smallest, double temperature) {
    SamplingBias bias;
    bias.is_reference = &row == &smallest;
    Blocked const thermostat{.mean = temperature, .error = 0, .block = 1, .plateau = true};
    bias.of = {bias_of_gyration(row, smallest),
               bias_of("T conf.", row.temperature, thermostat, temperature)};
    double const energies = energy_scale(smallest);
    for (std::size_t i = 0; i < row.together.means.size() && i < smallest.together.means.size();
         ++i) {
        SystemMean const &mean = row.together.means[i], &reference = smallest.together.means[i];
        bias.of.push_back(bias_of(mean.name, mean.mean, reference.mean,
                                  is_energy(mean) ? energies : std::abs(reference.mean.mean)));
    }
    for (QuantityBias& each : bias.of) {
        bool const of_mean = &each != &bias.of[1];
        if (!row.valid() || (of_mean && !smallest.valid()))
            each.percent = each.error = NAN;
        else if (of_mean && bias.is_reference)
            each.percent = each.error = 0, each.known = true;
    }
    return bias;
}

/// Returns the difference of two means, with their errors combined.
Difference difference(Blocked const& of, Blocked const& less) {
    return {of.mean - less.mean, std::hypot(of.error, less.error)};
}

}  // namespace

bool QuantityBias::allowed() const {
    return error < allowed_percent && std::abs(percent) < allowed_percent;
}

bool QuantityBias::shown() const {
    return known && std::abs(percent) + 2 * error < allowed_percent;
}

bool QuantityBias::refuted() const {
    return known && std::abs(percent) - 2 * error >= allowed_percent;
}

bool SamplingBias::allowed() const {
    return std::all_of(of.begin(), of.end(), [](auto const& each) { return each.allowed(); });
}

bool SamplingBias::shown() const {
    return std::all_of(of.begin(), of.end(), [](auto const& each) { return each.shown(); });
}

bool SamplingBias::refuted() const {
    return std::any_of(of.begin(), of.end(), [](auto const& each) { return each.refuted(); });
}

char const* SamplingBias::word() const {
    if (refuted()) return "no";
    if (is_reference) return "reference";
    if (std::isnan(gyration().percent)) return "no reference";
    return shown() ? "shown" : allowed() ? "not contradicted" : "errors too large to tell";
}

std::vector<SamplingMethodVerdict> verdicts_of(std::vector<SamplingRow> const& rows,
                                               double temperature) {
    std::vector<SamplingMethodVerdict> all;
    for (SamplingRow const& row : rows) {
        auto const same = [&](SamplingMethodVerdict const& each) {
            return each.method == row.method;
        };
        auto found = std::find_if(all.begin(), all.end(), same);
        if (found == all.end())
            found = all.insert(all.end(), {.method = row.method, .rows = {}, .bias = {}});
        found->rows.push_back(&row);
    }
    for (SamplingMethodVerdict& each : all) {
        std::stable_sort(each.rows.begin(), each.rows.end(),
                         [](auto const* a, auto const* b) { return a->step < b->step; });
        for (SamplingRow const* row : each.rows)
            each.bias.push_back(biases_of(*row, *each.rows.front(), temperature));
        bool all_allowed = true, all_shown = true;
        for (std::size_t i = 0; i < each.rows.size(); ++i) {
            all_allowed = all_allowed && each.bias[i].allowed();
            all_shown = all_shown && each.bias[i].shown();
            if (i == 0) continue;
            if (all_allowed) each.allowed = each.rows[i];
            if (all_shown) each.shown = each.rows[i];
        }
    }
    return all;
}

std::vector<SamplingDifference> differences_of(std::vector<SamplingMethodVerdict> const& all) {
    auto const row_of = [&](SamplingMethod method) -> SamplingRow const* {
        for (SamplingMethodVerdict const& each : all)
            if (each.method == method && each.rows.front()->valid()) return each.rows.front();
        return nullptr;
    };
    std::vector<SamplingDifference> found;
    for (auto const& [of, less] : {std::pair{SamplingMethod::rigid, SamplingMethod::bonds},
                                   {SamplingMethod::rigid_fixman, SamplingMethod::bonds},
                                   {SamplingMethod::constraints, SamplingMethod::bonds},
                                   {SamplingMethod::constraints, SamplingMethod::rigid}}) {
        SamplingRow const *a = row_of(of), *b = row_of(less);
        if (a && b)
            found.push_back({a, b, difference(a->gyration, b->gyration),
                             difference(a->end_to_end, b->end_to_end),
                             difference(a->cosine, b->cosine)});
    }
    return found;
}

}  // namespace catena::command
