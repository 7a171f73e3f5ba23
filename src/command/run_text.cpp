// Implements the summary of a run for the terminal.
#include "command/run_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "console/text.hpp"
#include "page/run_facts.hpp"

namespace catena::command {
namespace {

/// Returns a number of an object; NaN if it is missing.
double number(Json const& object, char const* key) {
    auto const found = object.find(key);
    return found == object.end() || !found->is_number() ? NAN : found->get<double>();
}

/// Returns the mean of a list of numbers.
double mean(Json const& list) {
    double sum = 0;
    for (auto const& value : list) sum += value.get<double>();
    return sum / static_cast<double>(list.size());
}

/// Describes the ghosts of the domain decomposition.
std::string ghosts_text(Json const& ghosts) {
    return fmt::format(
        "{:.4g} for {:.4g} own beads on a rank, lists made {} in {}; {:.3g} messages, {:.4g} bytes "
        "a step and rank",
        mean(ghosts.at("ghosts")), mean(ghosts.at("own_beads")),
        counted(ghosts.at("rebuilds").get<std::int64_t>(), "time", "times"),
        counted(ghosts.at("evaluations").get<std::int64_t>(), "evaluation", "evaluations"),
        mean(ghosts.at("messages_a_step")), mean(ghosts.at("bytes_a_step")));
}

/// Describes the number of bodies of each rank; for many ranks the smallest and the largest.
std::string shares_text(Json const& parallel) {
    auto const bodies = parallel.at("bodies_of_rank").get<std::vector<std::int64_t>>();
    auto const [least, most] = std::minmax_element(bodies.begin(), bodies.end());
    std::string const numbers =
        bodies.size() <= 8 ? fmt::format("{}", fmt::join(bodies, ", "))
                           : fmt::format("{} to {} on {} ranks", *least, *most, bodies.size());
    return numbers + " bodies, by " +
           (parallel.at("shares_from") == "checkpoint"
                ? "the checkpoint's shares"
                : "the ranks' speeds, as measured at the start");
}

/// Describes the energy before or after relaxation.
std::string relaxed_text(Json const& forces) {
    double const potential = number(forces, "potential_energy");
    std::string const energy =
        std::isfinite(potential) ? fmt::format("{:.6g} kJ/mol", potential) : "no finite energy";
    if (!forces.contains("nearest_distance")) return energy;
    return energy +
           fmt::format(" (nearest beads {:.3g} nm apart)", number(forces, "nearest_distance"));
}

/// Adds what was changed in the start that the user gave, and the energy of the start.
void add_start(Text& text, Json const& start, std::string const& unit) {
    if (double const change = number(start, "largest_link_change"); change > 0)
        text.entry(
            "start",
            fmt::format("links changed by up to {:.3g} {} ({}), positions by up to {:.3g} {} ({})",
                        change, unit, start.at("link").get<std::string>(),
                        number(start, "largest_displacement"), unit,
                        start.at("bead").get<std::string>()));
    if (auto const relaxed = start.find("relaxation"); relaxed != start.end()) {
        auto const &from = relaxed->at("from"), &to = relaxed->at("to");
        text.entry("relaxation",
                   fmt::format("{} evaluations, beads moved by up to {:.3g} nm: {} to {}",
                               relaxed->at("steps").get<std::int64_t>(),
                               number(*relaxed, "largest_displacement"), relaxed_text(from),
                               relaxed_text(to)));
    }
    if (start.contains("potential_energy"))
        text.entry("energy at the start",
                   fmt::format("{:.6g} kJ/mol, {:.3g} times the kinetic energy at {:.6g} K",
                               number(start, "potential_energy"),
                               number(start, "potential_energy") / number(start, "thermal_energy"),
                               number(start, "temperature")));
}

void add_facts(Text& text, std::vector<Fact> const& facts) {
    for (Fact const& fact : facts) text.entry(fact.name, fact.value);
}

/// Adds the table of means with their standard errors, and the sentence on the frames that count.
void add_observables(Text& text, Json const& summary) {
    Table table({"observable", "mean", "standard error", "unit"}, {0, 3});
    std::vector<ObservableRow> const rows = observable_rows(summary);
    for (ObservableRow const& row : rows)
        table.add({row.name, row.mean, row.standard_error, row.unit});
    if (rows.empty()) return;
    text.add(table);
    text.note(equilibration_sentence(summary));
}

/// Adds the counts of an adaptive integrator.
void add_inner_steps(Text& text, Json const& inner, std::string const& time_unit) {
    text.entry(
        "inner steps",
        fmt::format(
            "{}, {} rejected, of {:.3g} to {:.3g} {}; {}", inner.at("taken").get<std::int64_t>(),
            inner.at("rejected").get<std::int64_t>(), number(inner, "shortest"),
            number(inner, "longest"), time_unit,
            counted(inner.at("evaluations").get<std::int64_t>(), "evaluation", "evaluations")));
}

/// Adds backend, ranks and threads, shares, and who wrote.
void add_parallel(Text& text, Json const& summary, std::string const& reason) {
    Json const& parallel = summary.at("parallel");
    text.entry(
        "solver",
        fmt::format("{}, {}, {} each", summary.at("solver").at("backend").get<std::string>(),
                    counted(parallel.at("ranks").get<std::int64_t>(), "rank", "ranks"),
                    counted(parallel.at("threads").get<std::int64_t>(), "thread", "threads")));
    text.entry("", reason);
    if (parallel.contains("shares")) text.entry("shares", shares_text(parallel));
    if (parallel.at("ranks").get<std::int64_t>() > 1) {
        text.entry("frames written", parallel.at("frames_written").get<std::string>());
        text.entry("checkpoints", parallel.at("checkpoints_written").get<std::string>());
    }
}

/// Says how often OpenMM's lists of pairs were made and kept.
std::string text_of_lists(Json const& lists) {
    return fmt::format(
        "made {}, kept at {}", counted(lists.at("made").get<std::int64_t>(), "time", "times"),
        counted(lists.at("kept").get<std::int64_t>(), "other evaluation", "other evaluations"));
}

/// Adds platform, overlap, lists and warnings of OpenMM.
void add_forces(Text& text, Json const& forces) {
    text.entry("OpenMM",
               fmt::format("platform {}, path {}", forces.at("platform").get<std::string>(),
                           forces.at("path").get<std::string>()));
    text.entry("matrix sweep hidden", fmt::format("{:.0f} % behind the forces",
                                                  100 * number(forces, "matrix_sweep_hidden")));
    if (auto const lists = forces.find("pair_lists"); lists != forces.end())
        text.entry("lists of pairs", text_of_lists(*lists));
    for (Json const& lists : forces.value("pair_lists_of_layers", Json::array()))
        text.entry("of a layer", text_of_lists(lists));
    if (auto const ghosts = forces.find("ghosts"); ghosts != forces.end())
        text.entry("ghosts", ghosts_text(*ghosts));
    for (auto const& line : forces.at("description")) {
        std::string const words = line.get<std::string>();
        if (words.starts_with("warning:") || words.find("not device:") != std::string::npos)
            text.note(words);
    }
}

/// Adds the largest constraint error, or why there is none.
void add_constraints(Text& text, Json const& summary) {
    auto const found = summary.find("constraints");
    text.entry("constraint error",
               found == summary.end()
                   ? "none: joint coordinates cannot drift apart"
                   : fmt::format("{:.2e}, tolerance {:.0e}", number(*found, "largest_error"),
                                 number(*found, "tolerance")));
}

void add_files(Text& text, Json const& files) {
    bool first = true;
    for (auto const& [name, path] : files.items()) {
        text.entry(first ? "files" : "", path.get<std::string>());
        first = false;
    }
}

/// Returns "VALID", or "INVALID: " with the reason.
std::string verdict_line(Json const& summary) {
    return summary.at("valid").get<bool>() ? "VALID" : "INVALID: " + verdict_reason(summary);
}

}  // namespace

std::string text_of_run(Json const& summary, std::string const& solver_reason) {
    Json const& units = summary.at("units");
    Text text;
    text.heading(fmt::format("{} ({})", summary.at("title").get<std::string>(),
                             summary.at("scene").get<std::string>()));
    add_facts(text, system_facts(summary));
    text.heading("Observables");
    add_observables(text, summary);
    text.heading("Speed");
    add_facts(text, speed_facts(summary));
    text.heading("Verdict");
    text.entry(summary.at("valid").get<bool>() ? "valid" : "invalid", verdict_reason(summary));
    for (auto const& note : summary.at("notes")) text.note(note.get<std::string>());
    text.heading("Solver and files");
    add_parallel(text, summary, solver_reason);
    if (auto const inner = summary.find("inner_steps"); inner != summary.end())
        add_inner_steps(text, *inner, units.at("time").get<std::string>());
    if (auto const start = summary.find("start"); start != summary.end())
        add_start(text, *start, units.at("length").get<std::string>());
    if (auto const forces = summary.find("forces"); forces != summary.end())
        add_forces(text, *forces);
    add_constraints(text, summary);
    add_files(text, summary.at("files"));
    text.heading(verdict_line(summary));
    return text.str();
}

}  // namespace catena::command
