// Implements the lines that a run shows first.
#include "page/run_facts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "page/html.hpp"

namespace catena {
namespace {

using Json = nlohmann::ordered_json;

/// Member of an object; null if the object lacks it or is none.
Json const& member(Json const& object, char const* key) {
    static Json const none;
    if (!object.is_object()) return none;
    auto const found = object.find(key);
    return found == object.end() ? none : *found;
}

/// Number of this name; NaN if it is missing or null.
double number(Json const& object, char const* key) {
    Json const& value = member(object, key);
    return value.is_null() ? NAN : value.get<double>();
}

/// Text of this name; empty if it is missing or null.
std::string text(Json const& object, char const* key) {
    Json const& value = member(object, key);
    return value.is_null() ? "" : value.get<std::string>();
}

void add(std::vector<Fact>& facts, char const* name, std::string const& value) {
    if (!value.empty()) facts.push_back({name, value});
}

std::string unit_of(Json const& summary, char const* quantity) {
    return text(member(summary, "units"), quantity);
}

std::string box_text(Json const& summary) {
    Json const& box = member(member(summary, "system"), "box");
    if (!box.is_array()) return "";
    std::string edges;
    for (Json const& edge : box)
        edges += (edges.empty() ? "" : " x ") + readable_number(edge.get<double>());
    return edges + " " + unit_of(summary, "length") + ", periodic";
}

std::string concentration_text(Json const& system) {
    double const mass = number(system, "mass_concentration"),
                 chains = number(system, "chain_concentration");
    if (!std::isfinite(mass)) return "";
    std::string found = fmt::format("{:.4g} mg/ml", mass);
    if (std::isfinite(chains)) found += fmt::format(", {:.4g} mmol/l of chains", 1e3 * chains);
    return found + ", mean over the box";
}

std::string temperature_text(Json const& summary, Json const& run) {
    double const temperature = number(run, "temperature");
    if (!std::isfinite(temperature)) return "";
    return fmt::format("{} K, Langevin thermostat of friction {}/{}", readable_number(temperature),
                       readable_number(number(run, "friction")), unit_of(summary, "time"));
}

std::string integrator_text(Json const& summary, Json const& run) {
    std::string const name = text(run, "integrator");
    if (name.empty()) return "";
    return fmt::format("{}, step {} {}", name, readable_number(number(run, "step")),
                       unit_of(summary, "time"));
}

std::string simulated_text(Json const& summary, Json const& run) {
    double const here = number(run, "simulated_time");
    if (!std::isfinite(here)) return "";
    auto const first = member(run, "first_step").get<std::int64_t>(),
               last = member(run, "last_step").get<std::int64_t>();
    std::string const unit = unit_of(summary, "time");
    std::string found = fmt::format("{} {}, {} steps", readable_number(here), unit, last - first);
    if (first > 0)
        found += fmt::format(", from step {} to {}; {} {} since the scene's start", first, last,
                             readable_number(number(run, "time")), unit);
    return found;
}

/// Decimal place of a number's first digit: 0 for 1 to 9.99, -1 for 0.1 to 0.99.
int first_place(double value) { return static_cast<int>(std::floor(std::log10(std::abs(value)))); }

/// Relative error below which a mean has six digits alone.
constexpr double negligible = 1e-6;

std::string check_text(Json const& check) {
    return fmt::format("{} {:.2g} of {:.2g}", text(check, "name"), number(check, "value"),
                       number(check, "limit"));
}

}  // namespace

std::vector<Fact> system_facts(Json const& summary) {
    Json const &system = member(summary, "system"), &run = member(summary, "run");
    std::vector<Fact> facts;
    add(facts, "system", text(system, "description"));
    add(facts, "forces", text(system, "forces"));
    add(facts, "net charge", text(system, "net_charge"));
    add(facts, "box", box_text(summary));
    add(facts, "concentration", concentration_text(system));
    add(facts, "temperature", temperature_text(summary, run));
    add(facts, "integrator", integrator_text(summary, run));
    add(facts, "simulated time", simulated_text(summary, run));
    return facts;
}

std::vector<ObservableRow> observable_rows(Json const& summary) {
    std::vector<ObservableRow> rows;
    for (auto const& [name, found] : member(summary, "observables").items()) {
        // The energy of a term that the scene does not have is zero in every frame.
        if (name.ends_with("_energy") && number(found, "mean") == 0 &&
            number(found, "standard_error") == 0)
            continue;
        auto [mean, error] = rounded_alike(number(found, "mean"), number(found, "standard_error"));
        Json const& converged = member(found, "converged");
        if (converged.is_boolean() && !converged.get<bool>() && error != "-")
            error = "at least " + error;
        std::string const unit = text(found, "unit");
        rows.push_back({readable_words(name), mean, error, unit == "1" ? "" : unit});
    }
    return rows;
}

std::string equilibration_sentence(Json const& summary) {
    return text(member(summary, "equilibration"), "description");
}

std::vector<Fact> speed_facts(Json const& summary) {
    Json const& speed = member(summary, "speed");
    std::vector<Fact> facts;
    if (double const ns = number(speed, "ns_per_day"); std::isfinite(ns))
        add(facts, "simulated per day", fmt::format("{:.4g} ns", ns));
    if (double const s = number(speed, "simulated_seconds_per_day"); std::isfinite(s))
        add(facts, "simulated per day", fmt::format("{:.4g} s", s));
    if (double const ms = number(speed, "milliseconds_per_step"); std::isfinite(ms)) {
        std::string found =
            fmt::format("{:.4g} ms, {:.4g} steps/s", ms, number(speed, "steps_per_second"));
        if (double const later = number(speed, "steps_per_second_of_second_half");
            std::isfinite(later))
            found += fmt::format(", in the second half {:.4g} steps/s", later);
        add(facts, "time per step", found);
    }
    if (double const seconds = number(speed, "seconds"); std::isfinite(seconds)) {
        std::string found = fmt::format("{:.4g} s", seconds);
        if (double const begun = number(speed, "seconds_to_first_step"); std::isfinite(begun))
            found +=
                fmt::format("; the first step was done {:.3g} s after the program's start", begun);
        add(facts, "duration", found);
    }
    return facts;
}

std::string verdict_reason(Json const& summary) {
    std::string passed;
    Json const& checks = member(member(summary, "verdict"), "checks");
    for (Json const& check : checks.is_array() ? checks : Json::array()) {
        if (!member(check, "passed").get<bool>())
            return fmt::format("{} at step {}: {}", text(check, "name"),
                               member(check, "step").get<std::int64_t>(), text(check, "advice"));
        passed += (passed.empty() ? "" : ", ") + check_text(check);
    }
    return passed.empty() ? "" : "every check is within its limit: " + passed;
}

std::pair<std::string, std::string> rounded_alike(double mean, double standard_error) {
    if (!std::isfinite(mean)) return {"-", "-"};
    if (!std::isfinite(standard_error)) return {readable_number(mean), "-"};
    if (standard_error <= 0) return {readable_number(mean), "0"};
    if (standard_error < negligible * std::abs(mean))
        return {readable_number(mean), fmt::format("{:.1e}", standard_error)};
    int const place = first_place(standard_error) - 1;  // of the error's second digit
    double const size = std::max(std::abs(mean), standard_error);
    if (size >= 1e-4 && size < 1e7) {
        int const decimals = std::max(0, -place);
        return {fmt::format("{:.{}f}", mean, decimals),
                fmt::format("{:.{}f}", standard_error, decimals)};
    }
    int const digits = mean == 0 ? 1 : std::clamp(first_place(mean) - place, 0, 15);
    return {fmt::format("{:.{}e}", mean, digits), fmt::format("{:.1e}", standard_error)};
}

}  // namespace catena
