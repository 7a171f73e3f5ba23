// Implements `bench sampling`: what a chain samples on rigid links, harmonic bonds and constraints,
// up to which time step, and how fast.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench/benchmarks.hpp"
#include "bench/dense_chains.hpp"
#include "bench/sampling_copies.hpp"
#include "bench/sampling_verdict.hpp"
#include "bench/step_makers.hpp"
#include "console/text.hpp"
#include "io/output.hpp"
#include "measure/hardware.hpp"
#include "report/version.hpp"

namespace catena::command {
namespace {

/// Converts a mean with its error to JSON.
Json json_of(Blocked const& b, char const* unit) {
    return {{"mean", b.mean},
            {"error", b.error},
            {"unit", unit},
            {"block", b.block},
            {"plateau", b.plateau}};
}

/// Converts means of all chains together to JSON.
Json json_of(std::vector<SystemMean> const& means) {
    Json json = Json::object();
    for (SystemMean const& each : means) json[each.name] = json_of(each.mean, each.unit.c_str());
    return json;
}

/// Converts a row to JSON.
Json json_of(SamplingRow const& row, std::int64_t copies) {
    return {{"method", name_of(row.method)},
            {"step_ps", row.step},
            {"state", row.state},
            {"why", row.why},
            {"backend", row.engine.backend},
            {"platform", row.engine.platform},
            {"path", row.engine.path},
            {"samples_per_copy", row.samples},
            {"every_ps", row.every},
            {"ps_per_copy", row.time},
            {"total_ns", row.all},
            {"cut_by_seconds", row.cut},
            {"radius_of_gyration", json_of(row.gyration, "nm")},
            {"end_to_end_distance", json_of(row.end_to_end, "nm")},
            {"cosine", json_of(row.cosine, "1")},
            {"configurational_temperature", json_of(row.temperature, "K")},
            {"kinetic_temperature", json_of(row.kinetic, "K")},
            {"system", json_of(row.together.means)},
            {"diffusion_of_chains", json_of(row.together.diffusion, "nm^2/ns")},
            {"largest_link_error", row.link_error},
            {"copies_spacing_nm", row.distances.spacing},
            {"copies_apart_nm", row.distances.nearest},
            {"rounding_of_positions_nm", row.distances.rounding},
            {"steps_timed", row.times.steps},
            {"seconds_in_steps", row.times.stepping},
            {"seconds_in_samples", row.times.sampling},
            {"seconds_per_step",
             {{"mean", row.times.stepping / static_cast<double>(row.times.steps)},
              {"median", row.times.seconds.median},
              {"min", row.times.seconds.min},
              {"max", row.times.seconds.max},
              {"blocks", row.times.seconds.count}}},
            {"ns_per_day", row.ns_per_day()},
            {"ns_per_day_of_all_copies", row.ns_per_day() * static_cast<double>(copies)},
            {"valid", row.valid()}};
}

/// Converts time step and speed of a row to JSON; null if there is none.
Json json_of(SamplingRow const* row) {
    if (!row) return nullptr;
    return {{"step_ps", row->step}, {"ns_per_day", row->ns_per_day()}};
}

/// Converts a bias to JSON.
Json json_of(QuantityBias const& bias) {
    return {{"percent", bias.percent}, {"error", bias.error}, {"plateau", bias.known}};
}

/// Converts the verdict on a method to JSON.
Json json_of(SamplingMethodVerdict const& verdict) {
    Json biases = Json::array();
    for (std::size_t i = 0; i < verdict.rows.size(); ++i) {
        SamplingBias const& b = verdict.bias[i];
        SamplingRow const& row = *verdict.rows[i];
        Json json = {{"step_ps", row.step},
                     {"usable", row.valid() ? std::string(b.word()) : row.state},
                     {"radius_of_gyration", json_of(b.gyration())},
                     {"configurational_temperature", json_of(b.temperature())}};
        for (std::size_t k = 2; k < b.of.size(); ++k) json[b.of[k].name] = json_of(b.of[k]);
        biases.push_back(std::move(json));
    }
    return {{"method", name_of(verdict.method)},
            {"biases", biases},
            {"usable_shown", json_of(verdict.shown)},
            {"usable_not_contradicted", json_of(verdict.allowed)}};
}

/// Converts a difference to JSON.
Json json_of(Difference const& d) {
    return {{"value", d.value}, {"error", d.error}, {"errors", d.errors()}};
}

/// Formats a difference with its error and their ratio.
std::string sign_text(Difference const& d, int digits) {
    if (!std::isfinite(d.errors())) return fmt::format("{:+.{}f} +- ?", d.value, digits);
    return fmt::format("{:+.{}f} +- {:.{}f} ({:+.1f} errors)", d.value, digits, d.error, digits,
                       d.errors());
}

/// Returns for example "2.98 +- 0.01"; a star marks an error that had not reached its plateau.
std::string text_of(Blocked const& b, int digits) {
    if (!std::isfinite(b.mean)) return "-";
    if (!std::isfinite(b.error)) return fmt::format("{:.{}f} +- ?", b.mean, digits);
    return fmt::format("{:.{}f} +- {:.{}f}{}", b.mean, digits, b.error, digits,
                       b.plateau ? "" : "*");
}

/// Formats a time step in fs.
std::string femtoseconds(double ps) { return fmt::format("{:.4g}", 1e3 * ps); }
std::string rate_text(double ns_per_day) {
    return std::isfinite(ns_per_day) ? fmt::format("{:.4g}", ns_per_day) : "-";
}

/// Returns the table of all rows.
std::string table_of(std::vector<SamplingRow> const& rows) {
    Table table({"links", "step fs", "total ns", "Rg nm", "Ree nm", "cosine", "T conf. K",
                 "T kin. K", "link error", "per step", "ns/day", ""},
                {0, 11});
    for (SamplingRow const& row : rows) {
        if (row.state != "VALID" && row.state != "INVALID") {
            table.add({name_of(row.method), femtoseconds(row.step), "-", "-", "-", "-", "-", "-",
                       fmt::format("{:.1e}", row.link_error), "-", "-", row.state});
            continue;
        }
        table.add({name_of(row.method), femtoseconds(row.step), fmt::format("{:.4g}", row.all),
                   text_of(row.gyration, 4), text_of(row.end_to_end, 3), text_of(row.cosine, 5),
                   text_of(row.temperature, 2), text_of(row.kinetic, 2),
                   fmt::format("{:.1e}", row.link_error),
                   row.times.steps > 0 ? duration_text(row.times.seconds.median) : "-",
                   rate_text(row.ns_per_day()), row.state});
    }
    return table.text();
}

/// Returns the table of what describes all chains together; nothing if there is no such number.
std::string system_table(std::vector<SamplingRow> const& rows) {
    auto const full = std::find_if(rows.begin(), rows.end(), [](SamplingRow const& row) {
        return !row.together.means.empty();
    });
    if (full == rows.end()) return {};
    std::vector<std::string> heads{"links", "step fs"};
    for (SystemMean const& each : full->together.means)
        heads.push_back(fmt::format("{}, {}", each.name, each.unit));
    heads.emplace_back("diffusion of chains, nm^2/ns");
    Table table(heads, {0});
    for (SamplingRow const& row : rows) {
        if (row.together.means.empty()) continue;
        std::vector<std::string> cells{name_of(row.method), femtoseconds(row.step)};
        for (SystemMean const& each : row.together.means) cells.push_back(text_of(each.mean, 4));
        cells.push_back(text_of(row.together.diffusion, 3));
        table.add(cells);
    }
    return table.text();
}

/// Returns a bias with its error in percent.
std::string text_of(QuantityBias const& bias) {
    if (!std::isfinite(bias.percent)) return "-";
    return std::isfinite(bias.error) ? fmt::format("{:+.2f} +- {:.2f}", bias.percent, bias.error)
                                     : fmt::format("{:+.2f} +- ?", bias.percent);
}

/// Returns the table of biases.
std::string bias_table(std::vector<SamplingMethodVerdict> const& verdicts) {
    std::vector<QuantityBias> longest;
    for (SamplingMethodVerdict const& each : verdicts)
        for (SamplingBias const& b : each.bias)
            if (b.of.size() > longest.size()) longest = b.of;
    std::vector<std::string> heads{"links", "step fs"};
    for (QuantityBias const& each : longest) heads.push_back(each.name + " %");
    heads.emplace_back("usable"), heads.emplace_back("ns/day");
    Table table(heads, {0, heads.size() - 2});
    for (SamplingMethodVerdict const& each : verdicts)
        for (std::size_t i = 0; i < each.rows.size(); ++i) {
            SamplingRow const& row = *each.rows[i];
            std::vector<std::string> cells{name_of(each.method), femtoseconds(row.step)};
            for (std::size_t k = 0; k < longest.size(); ++k) {
                bool const is_reference = each.bias[i].is_reference && row.valid() && k != 1;
                cells.push_back(is_reference                 ? "reference"
                                : k < each.bias[i].of.size() ? text_of(each.bias[i].of[k])
                                                             : "-");
            }
            cells.push_back(row.valid() ? each.bias[i].word() : row.state);
            cells.push_back(row.valid() ? rate_text(row.ns_per_day()) : "-");
            table.add(cells);
        }
    return table.text();
}

/// Returns the table of biases and the largest usable step of each method.
std::string usable_text(std::vector<SamplingMethodVerdict> const& verdicts) {
    bool const dense = verdicts.front().bias.front().of.size() > 2;
    std::string text = fmt::format(
        "Biases relative to the same method's smallest step{}; that of the configurational "
        "temperature relative to the thermostat's. Usable: all of them and their errors are below "
        "1 %; shown: even with two standard errors more.\n{}",
        dense ? " (of energies in percent of the magnitudes of all energies)" : "",
        bias_table(verdicts));
    for (SamplingMethodVerdict const& each : verdicts) {
        if (each.rows.size() == 1) continue;
        text += fmt::format("  {}: largest usable step ", name_of(each.method));
        if (!each.allowed) {
            bool const refuted = !each.rows[1]->valid() || each.bias[1].refuted();
            text += refuted ? "only the reference\n" : "unknown: sample longer\n";
            continue;
        }
        text += fmt::format("{} fs ({}), {} ns/day", femtoseconds(each.allowed->step),
                            each.shown == each.allowed ? "shown" : "not contradicted",
                            rate_text(each.allowed->ns_per_day()));
        if (each.shown && each.shown != each.allowed)
            text += fmt::format("; shown up to {} fs, {} ns/day", femtoseconds(each.shown->step),
                                rate_text(each.shown->ns_per_day()));
        text += "\n";
    }
    return text;
}

/// Returns the differences between methods, one line each.
std::string difference_text(std::vector<SamplingDifference> const& differences) {
    std::string text;
    for (SamplingDifference const& d : differences)
        text += fmt::format(
            "{} ({} fs) minus {} ({} fs): Rg {} nm, Ree {} nm, cosine {}\n", name_of(d.of->method),
            femtoseconds(d.of->step), name_of(d.less->method), femtoseconds(d.less->step),
            sign_text(d.gyration, 4), sign_text(d.end_to_end, 3), sign_text(d.cosine, 5));
    return text;
}

/// Returns the conditions that all rows share.
std::string heading(SampledChains const& chains, SamplingOptions const& options) {
    Scene const& scene = chains.model();
    return fmt::format(
        "{}; {} K, friction {}/ps; {} ps discarded, a sample every {} ps, after {} ps on rigid "
        "links.\nCatena's g-BAOAB on rigid links (rigid-fixman: with the Fixman potential, its "
        "chains on the host), {}'s LangevinMiddle with harmonic bonds and constraints. {}\nErrors "
        "are standard errors by blocking over all {} (*: no plateau). ns/day is that of {}, "
        "without "
        "sampling{}\n",
        chains.description(), scene.dynamics.temperature, scene.dynamics.friction, options.discard,
        options.every, options.equilibration, openmm_version(), hardware_text(),
        options.dense ? "chains" : "copies",
        options.dense ? "the whole system" : "copies run side by side",
        options.dense ? "." : "; \"total ns\" is the sum over copies.");
}

/// Returns the smallest distance between copies and the largest rounding of positions in all rows.
std::string distances_text(std::vector<SamplingRow> const& rows) {
    double nearest = INFINITY, rounding = 0;
    for (SamplingRow const& row : rows) {
        if (row.valid()) nearest = std::min(nearest, row.distances.nearest);
        rounding = std::max(rounding, row.distances.rounding);
    }
    std::string const far = fmt::format(
        "Single precision, if OpenMM uses it, rounds positions by at most {:.0e} nm.\n", rounding);
    if (!std::isfinite(nearest)) return far;
    return fmt::format("Copies stayed at least {:.4g} nm apart; forces reach {} nm. ", nearest,
                       longest_cutoff()) +
           far;
}

/// Sets the text and the JSON of the outcome from the rows so far.
void conclude(Outcome& outcome, SampledChains const& chains, SamplingOptions const& options,
              std::vector<SamplingRow> const& rows) {
    auto const verdicts = verdicts_of(rows, chains.model().dynamics.temperature);
    auto const differences = differences_of(verdicts);
    outcome.json["results"] = Json::array();
    outcome.json["verdicts"] = Json::array();
    outcome.json["differences"] = Json::array();
    outcome.valid = true;
    std::string remarks;
    for (SamplingRow const& row : rows) {
        outcome.json["results"].push_back(json_of(row, chains.copies()));
        outcome.valid = outcome.valid && row.state != "INVALID" && row.state != "failed";
        if (!row.valid())
            remarks += fmt::format("  {}, {} fs: {}: {}\n", name_of(row.method),
                                   femtoseconds(row.step), row.state, row.why);
        if (row.cut && row.valid())
            remarks +=
                fmt::format("  {}, {} fs: ended after {} s with {:.4g} ps of each copy\n",
                            name_of(row.method), femtoseconds(row.step), options.seconds, row.time);
    }
    for (SamplingMethodVerdict const& each : verdicts) {
        outcome.json["verdicts"].push_back(json_of(each));
        // A longer step that turns out too long is a finding, not a failure.
        outcome.valid = outcome.valid && each.rows.front()->valid();
    }
    for (SamplingDifference const& d : differences)
        outcome.json["differences"].push_back({{"of", name_of(d.of->method)},
                                               {"less", name_of(d.less->method)},
                                               {"steps_ps", {d.of->step, d.less->step}},
                                               {"radius_of_gyration_nm", json_of(d.gyration)},
                                               {"end_to_end_distance_nm", json_of(d.end_to_end)},
                                               {"cosine", json_of(d.cosine)}});
    outcome.json["valid"] = outcome.valid;
    for (std::string const& note : chains.model().notes) remarks += "  - " + note + "\n";
    outcome.text = heading(chains, options) + table_of(rows) + system_table(rows) + remarks +
                   distances_text(rows) + usable_text(verdicts) + difference_text(differences);
}

/// Returns the head of the JSON.
Json head(SampledChains const& chains, SamplingOptions const& options,
          CommonOptions const& common) {
    Scene const& scene = chains.model();
    return {{"bench", "sampling"},
            {"command", common.command_line},
            {"build", version_json()},
            {"hardware", hardware_json()},
            {"openmm", openmm_version()},
            {"scene", scene.file},
            {"copies", chains.copies()},
            {"dense", options.dense},
            {"beads_per_copy", chains.beads().size() / chains.copies()},
            {"temperature", scene.dynamics.temperature},
            {"friction", scene.dynamics.friction},
            {"seed", scene.dynamics.seed},
            {"discard_ps", options.discard},
            {"every_ps", options.every},
            {"equilibrate_ps", options.equilibration},
            {"platform_of_samples", chains.platform()},
            {"notes", scene.notes}};
}

/// Returns the chains that are sampled.
std::unique_ptr<SampledChains> make_chains(BenchRequest const& request,
                                           Communicator const& communicator, Backend backend) {
    if (request.sampling.dense)
        return std::make_unique<DenseChains>(request, communicator, backend);
    return std::make_unique<SamplingCopies>(request, communicator, backend);
}

}  // namespace

Outcome bench_sampling(Communicator const& communicator, BenchRequest const& request) {
    need_one_rank(communicator, "sampling");
    SamplingOptions const& options = request.sampling;
    Backend const backend = backend_of(request);
    std::unique_ptr<SampledChains> const sampled = make_chains(request, communicator, backend);
    SampledChains& chains = *sampled;
    Outcome outcome;
    outcome.json = head(chains, options, request);
    outcome.complaint =
        "link errors above their tolerance, copies that met, means that are not finite, or a "
        "method without samples at its smallest step: see the results";
    auto const say = [&](std::string const& line) {
        if (!request.quiet) std::fputs((line + "\n").c_str(), stderr);
    };
    if (options.equilibration > 0) say(fmt::format("{} ps on rigid links", options.equilibration));
    equilibrate(chains, request, communicator, backend, options.equilibration);
    std::vector<SamplingRow> rows;
    std::string const at_most =
        options.seconds > 0 ? fmt::format(", {} s at most", options.seconds) : "";
    for (double const step :
         options.steps)  // all methods at the first step, in case that time is up
        for (std::string const& method : options.methods) {
            say(fmt::format("{}, {} fs{}", method, femtoseconds(step), at_most));
            rows.push_back(run_sampling_row(chains, request, communicator, backend,
                                            sampling_method_named("--methods", method), step));
            conclude(outcome, chains, options, rows);
            if (!request.json.empty() && request.json != "-")
                write_text_file(request.json, json_text(outcome.json));
        }
    return outcome;
}

}  // namespace catena::command
