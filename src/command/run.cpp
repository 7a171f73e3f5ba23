// Implements `catena run` and its summary in the terminal.
#include <fmt/format.h>

#include <spdlog/spdlog.h>

#include <filesystem>
#include <utility>

#include "clock.hpp"
#include "command/commands.hpp"
#include "command/run_text.hpp"
#include "command/stop_signals.hpp"
#include "generate/start_fit.hpp"
#include "integrate/joint_integrators.hpp"
#include "measure/run_start.hpp"
#include "page/run_facts.hpp"
#include "plan/choice.hpp"
#include "plan/host_memory.hpp"
#include "run/simulation.hpp"

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

/// Returns the error of a run that is not valid or was stopped; empty for any other.
std::string complaint_of(Json const& s, bool whole) {
    Json const& run = s.at("run");
    if (!s.at("valid").get<bool>()) return verdict_reason(s);
    if (whole) return "";
    return fmt::format("stopped by {} at step {} of {}: continue with --restart {}",
                       StopSignals::name_of(run.at("stopped_by").get<int>()),
                       run.at("last_step").get<std::int64_t>(), run.at("steps").get<std::int64_t>(),
                       s.at("files").at("checkpoint.h5").get<std::string>());
}

}  // namespace

Outcome run_scene(Scene given, Communicator const& communicator, RunRequest const& request) {
    StopSignals const signals;
    look_before_run(given, communicator);
    if (!request.restart.empty()) scene::forget_fits(given);  // said at the first start
    if (auto const lacking = lacking_memory(given, communicator)) given.note(lacking->note());
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
    plan::with_choice(std::move(given), choose,
                      [&](Scene const& scene, plan::Choice const& choice) {
                          Json const summary = run_simulation(scene, communicator, options);
                          outcome.valid = summary.at("valid").get<bool>();
                          outcome.whole = !summary.at("run").contains("stopped_by");
                          if (communicator.rank() != 0) return;
                          outcome.text = text_of_run(summary, choice.reason);
                          outcome.json = summary;
                          outcome.complaint = complaint_of(summary, outcome.whole);
                      });
    return outcome;
}

}  // namespace catena::command
