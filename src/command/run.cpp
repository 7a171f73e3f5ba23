// Implements `catena run` and its summary in the terminal.
#include <fmt/format.h>

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "clock.hpp"
#include "command/commands.hpp"
#include "command/stop_signals.hpp"
#include "integrate/joint_integrators.hpp"
#include "integrate/step_limit.hpp"
#include "measure/forward_error.hpp"
#include "plan/choice.hpp"
#include "plan/describe.hpp"
#include "run/simulation.hpp"
#include "systems/charges.hpp"

namespace catena::command {
namespace {

/// Time at which the program started, in s.
double const program_start = seconds_now();

/// Returns the folder of the run: --output, the checkpoint's folder, or the scene's name with
/// "-run".
std::string output_folder(Scene const& scene, RunRequest const& request) {
    if (!request.output.empty()) return request.output;
    if (request.restart.empty()) return std::filesystem::path(scene.file).stem().string() + "-run";
    std::filesystem::path const folder = std::filesystem::path(request.restart).parent_path();
    return folder.empty() ? "." : folder.string();
}

/// Returns a number of an object; NaN if it is missing.
double number(nlohmann::json const& object, char const* key) {
    auto const found = object.find(key);
    return found == object.end() || !found->is_number() ? NAN : found->get<double>();
}

/// Returns the mean of a list of numbers.
double mean(nlohmann::json const& list) {
    double sum = 0;
    for (auto const& value : list) sum += value.get<double>();
    return sum / static_cast<double>(list.size());
}

/// Describes the ghosts of the domain decomposition.
std::string ghosts_text(nlohmann::json const& ghosts) {
    return fmt::format(
        "{:.4g} for {:.4g} own beads on a rank, lists made {} in {}; {:.3g} messages, {:.4g} bytes "
        "a step and rank",
        mean(ghosts.at("ghosts")), mean(ghosts.at("own_beads")),
        counted(ghosts.at("rebuilds").get<std::int64_t>(), "time", "times"),
        counted(ghosts.at("evaluations").get<std::int64_t>(), "evaluation", "evaluations"),
        mean(ghosts.at("messages_a_step")), mean(ghosts.at("bytes_a_step")));
}

/// Describes the number of bodies of each rank; for many ranks the smallest and the largest.
std::string shares_text(nlohmann::json const& parallel) {
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
std::string relaxed_text(nlohmann::json const& forces) {
    double const potential = number(forces, "potential_energy");
    std::string const energy =
        std::isfinite(potential) ? fmt::format("{:.6g} kJ/mol", potential) : "no finite energy";
    if (!forces.contains("nearest_distance")) return energy;
    return energy +
           fmt::format(" (nearest beads {:.3g} nm apart)", number(forces, "nearest_distance"));
}

/// Adds what was changed in the start that the user gave, and the energy of the start.
void add_start(Text& text, nlohmann::json const& start, char const* unit) {
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

/// Describes the first check that failed, e.g. "energy at step 3000: ..."; empty if none failed.
std::string failure_of(nlohmann::json const& s) {
    for (auto const& check : s.at("verdict").at("checks"))
        if (!check.at("passed").get<bool>())
            return fmt::format("{} at step {}: {}", check.at("name").get<std::string>(),
                               check.at("step").get<std::int64_t>(),
                               check.at("advice").get<std::string>());
    return "";
}

/// Returns the summary of a run for the terminal.
std::string text_of(Scene const& scene, nlohmann::json const& s, std::string const& reason) {
    Text text;
    auto const &run = s.at("run"), &speed = s.at("speed"), &parallel = s.at("parallel");
    text.heading(title_of(scene));
    if (std::string const charges = assumed_charges(scene); !charges.empty())
        text.entry("net charge", charges);
    text.entry("steps",
               fmt::format("{} to {}, {:.6g} {} in all", run.at("first_step").get<std::int64_t>(),
                           run.at("last_step").get<std::int64_t>(), number(run, "time"),
                           time_unit(scene)));
    std::string rate = fmt::format("{}: {:.4g} steps/s", duration_text(number(speed, "seconds")),
                                   number(speed, "steps_per_second"));
    if (speed.contains("ns_per_day"))
        rate += fmt::format(", {:.4g} ns/day", number(speed, "ns_per_day"));
    if (auto const later = speed.find("steps_per_second_of_second_half"); later != speed.end())
        rate += fmt::format(", in the second half {:.4g} steps/s", later->get<double>());
    if (auto const begun = speed.find("seconds_to_first_step"); begun != speed.end())
        rate += fmt::format("; the first one done {} after the program's start",
                            duration_text(begun->get<double>()));
    text.entry("time", rate);
    if (auto const inner = s.find("inner_steps"); inner != s.end())
        text.entry("inner steps", fmt::format("{}, {} rejected, of {:.3g} to {:.3g} {}; {}",
                                              inner->at("taken").get<std::int64_t>(),
                                              inner->at("rejected").get<std::int64_t>(),
                                              number(*inner, "shortest"), number(*inner, "longest"),
                                              time_unit(scene),
                                              counted(inner->at("evaluations").get<std::int64_t>(),
                                                      "evaluation", "evaluations")));
    text.entry(
        "solver",
        fmt::format("{}, {}, {} each", s.at("solver").at("backend").get<std::string>(),
                    counted(parallel.at("ranks").get<std::int64_t>(), "rank", "ranks"),
                    counted(parallel.at("threads").get<std::int64_t>(), "thread", "threads")));
    text.entry("", reason);
    if (auto const shares = parallel.find("shares"); shares != parallel.end())
        text.entry("shares", shares_text(parallel));
    if (parallel.at("ranks").get<std::int64_t>() > 1) {
        text.entry("frames written", parallel.at("frames_written").get<std::string>());
        text.entry("checkpoints", parallel.at("checkpoints_written").get<std::string>());
    }
    if (auto const start = s.find("start"); start != s.end())
        add_start(text, *start, scene.si ? "m" : "nm");
    if (auto const forces = s.find("forces"); forces != s.end()) {
        text.entry("OpenMM",
                   fmt::format("platform {}, path {}", forces->at("platform").get<std::string>(),
                               forces->at("path").get<std::string>()));
        text.entry("matrix sweep hidden",
                   fmt::format("{:.0f} % behind the forces",
                               100 * number(*forces, "matrix_sweep_hidden")));
        if (auto const lists = forces->find("pair_lists"); lists != forces->end())
            text.entry("lists of pairs",
                       fmt::format("made {}, kept at {}",
                                   counted(lists->at("made").get<std::int64_t>(), "time", "times"),
                                   counted(lists->at("kept").get<std::int64_t>(),
                                           "other evaluation", "other evaluations")));
        if (auto const ghosts = forces->find("ghosts"); ghosts != forces->end())
            text.entry("ghosts", ghosts_text(*ghosts));
        for (auto const& line : forces->at("description")) {
            std::string const words = line.get<std::string>();
            if (words.starts_with("warning:") || words.find("not device:") != std::string::npos)
                text.note(words);
        }
    }
    if (!s.contains("constraints"))
        text.entry("constraint error", "none: joint coordinates cannot drift apart");
    else
        text.entry("constraint error", fmt::format("{:.2e}, tolerance {:.0e}",
                                                   number(s.at("constraints"), "largest_error"),
                                                   number(s.at("constraints"), "tolerance")));
    bool first = true;
    if (auto const last = s.find("last_observables"); last != s.end())
        for (auto const& [name, value] : last->items()) {
            if (value.is_number())
                text.entry(first ? "last observables" : "",
                           fmt::format("{} {:.8g}", name, value.get<double>()));
            first = false;
        }
    for (auto const& note : s.value("notes", nlohmann::json::array()))
        text.note(note.get<std::string>());
    first = true;
    for (auto const& [name, path] : s.at("files").items()) {
        text.entry(first ? "files" : "", path.get<std::string>());
        first = false;
    }
    text.heading(s.at("valid").get<bool>() ? "VALID" : "INVALID: " + failure_of(s));
    return text.str();
}

/// Returns the error of a run that is not valid or was stopped; empty for any other.
std::string complaint_of(nlohmann::json const& s, bool whole) {
    nlohmann::json const& run = s.at("run");
    if (std::string const failure = failure_of(s); !failure.empty()) return failure;
    if (whole) return "";
    return fmt::format("stopped by {} at step {} of {}: continue with --restart {}",
                       StopSignals::name_of(run.at("stopped_by").get<int>()),
                       run.at("last_step").get<std::int64_t>(), run.at("steps").get<std::int64_t>(),
                       s.at("files").at("checkpoint.h5").get<std::string>());
}

/// Estimates the error of the first accelerations. Refines articulated handles if they need it. For
/// other handles, and if refinement is impossible, a note states the possible error. Collective.
void look_at_forward_error(Scene& scene, Communicator const& communicator) {
    if (!scene.dynamics.given) return;
    std::optional<double> const error = forward_error_at_start(scene, communicator);
    bool const refinable = is_refined(scene.dynamics.integrator);
    bool const few = scene.bodies() <= most_estimated_of_run;
    bool const unasked = refinable && few && scene.solver.handles == Handles::articulated &&
                         scene.solver.refine == 0;
    if (!error || *error <= (unasked ? refined_beyond : largest_forward_error)) return;
    std::string const found = fmt::format(
        "the first accelerations may have errors of {:.1e}, relative to the largest", *error);
    if (unasked) {
        scene.solver.refine = 2;
        return scene.note(found + ": every solution is refined by two steps (solver.refine)");
    }
    std::string const remedy = remedy_of_forward_error(
        scene, refinable,
        {scene.solver.refine < 2 ? "solver.refine: 2" : "a larger solver.refine",
         "solver.handles: articulated"});
    scene.note(found + (remedy.empty() ? "" : ": use " + remedy));
}

}  // namespace

Outcome run_scene(Scene given, Communicator const& communicator, RunRequest const& request) {
    StopSignals const signals;
    look_at_forward_error(given, communicator);
    if (std::string const note = note_of_step(given, estimate_step_limit(given)); !note.empty())
        given.note(note);
    for (std::string const& note : given.notes) spdlog::warn("{}", note);
    Axes const axes = given.dynamics.given && uses_joint_coordinates(given.dynamics.integrator)
                          ? Axes::joint
                          : Axes::world;
    RunOptions options;
    options.output = output_folder(given, request);
    options.steps = request.steps;
    options.restart = request.restart;
    options.branch = request.branch;
    options.overwrite = request.overwrite;
    options.quiet = request.quiet || communicator.rank() != 0;
    options.command_line = request.command_line;
    options.begun = program_start;
    options.stop = StopSignals::noted;
    Outcome outcome;
    auto const choose = [&](Scene const& scene, std::string const& no_gpu) {
        return plan::choose(scene, axes, communicator, no_gpu);
    };
    plan::with_choice(
        std::move(given), choose, [&](Scene const& scene, plan::Choice const& choice) {
            nlohmann::json const summary = run_simulation(scene, communicator, options);
            outcome.valid = summary.at("valid").get<bool>();
            outcome.whole = !summary.at("run").contains("stopped_by");
            if (communicator.rank() != 0) return;
            outcome.text = text_of(scene, summary, choice.reason);
            outcome.json = summary;
            outcome.complaint = complaint_of(summary, outcome.whole);
        });
    return outcome;
}

}  // namespace catena::command
