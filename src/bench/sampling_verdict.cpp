// Implements biases, usable steps and differences.
#include "bench/sampling_verdict.hpp"

#include <algorithm>
#include <cmath>

namespace catena::command {
namespace {

/// Largest allowed bias in percent.
constexpr double allowed_percent = 1;

/// Returns the bias of a row.
SamplingBias bias_of(SamplingRow const& row, SamplingRow const& smallest, double temperature) {
    SamplingBias bias{NAN, NAN, NAN, NAN};
    if (!row.valid()) return bias;
    bias.is_reference = &row == &smallest;
    bias.errors_known = row.temperature.plateau;
    if (bias.is_reference) {
        bias.gyration = bias.gyration_error = 0;
    } else if (smallest.valid()) {
        bias.gyration = 100 * (row.gyration.mean / smallest.gyration.mean - 1);
        bias.gyration_error =
            100 * std::hypot(row.gyration.error, smallest.gyration.error) / smallest.gyration.mean;
        bias.errors_known = bias.errors_known && row.gyration.plateau && smallest.gyration.plateau;
    }
    bias.temperature = 100 * (row.temperature.mean / temperature - 1);
    bias.temperature_error = 100 * row.temperature.error / temperature;
    return bias;
}

/// Returns the difference of two means, with their errors combined.
Difference difference(Blocked const& of, Blocked const& less) {
    return {of.mean - less.mean, std::hypot(of.error, less.error)};
}

}  // namespace

bool SamplingBias::allowed() const {
    bool const can_tell = gyration_error < allowed_percent && temperature_error < allowed_percent;
    return can_tell && std::abs(gyration) < allowed_percent &&
           std::abs(temperature) < allowed_percent;
}

bool SamplingBias::shown() const {
    return errors_known && std::abs(gyration) + 2 * gyration_error < allowed_percent &&
           std::abs(temperature) + 2 * temperature_error < allowed_percent;
}

bool SamplingBias::refuted() const {
    return errors_known && (std::abs(gyration) - 2 * gyration_error >= allowed_percent ||
                            std::abs(temperature) - 2 * temperature_error >= allowed_percent);
}

char const* SamplingBias::word() const {
    if (refuted()) return "no";
    if (is_reference) return "reference";
    if (std::isnan(gyration)) return "no reference";
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
            each.bias.push_back(bias_of(*row, *each.rows.front(), temperature));
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
