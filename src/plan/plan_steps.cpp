// Implements the prediction of step times on many ranks.
#include "plan/plan_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dynamics/joint/joint_dynamics.hpp"
#include "integrate/joint_integrators.hpp"
#include "tree/tree.hpp"

namespace catena::command {
namespace {

/// Projection sweeps of a drift at a time step of 10 fs (src/integrate/README.md).
constexpr int usual_drift_sweeps = 4;

/// Returns notes on what the predicted numbers mean and what they leave out.
std::vector<std::string> notes_on(Scene const& scene,
                                  std::vector<plan::StepPrediction> const& steps) {
    DynamicsSpec const& d = scene.dynamics;
    auto const any = [&](auto const& condition) {
        return std::any_of(steps.begin(), steps.end(), condition);
    };
    std::vector<std::string> notes{
        "computing is that of the largest rank, from times measured on this machine (the shortest "
        "of several); every rank is assumed to be like this one, with memory of its own",
        "messages are assumed to follow all computing",
        fmt::format(
            "left out: the tree above the units (at most {} per chain), which every rank "
            "computes{}",
            dca::max_units,
            uses_joint_coordinates(d.integrator) ? ", and loops that update the state" : "")};
    if (any([](plan::StepPrediction const& s) { return uses_gpu(s.arrangement.backend); }))
        notes[1] +=
            ", from host to host, even if GPUs of one host can write into each other's memory; "
            "copies between GPU and host are not included";
    if (scene.forces.openmm)
        notes.emplace_back(
            "OpenMM's forces are not predicted, only the chains' own work and messages");
    if (d.fixman) notes.emplace_back("forces of the Fixman potential are not predicted");
    if (scene.solver.refine > 0)
        notes.emplace_back("residuals that refinement computes on the host are not predicted");
    if (d.tolerance > 0)
        notes.emplace_back(
            "times are per inner step; dynamics.tolerance determines the number of inner steps");
    if (is_implicit(d.integrator) && !uses_joint_coordinates(d.integrator))
        notes.emplace_back("drifts are predicted in one part; a run may use more");
    for (plan::StepPrediction const& s : steps)
        if (!s.unusable.empty())
            notes.push_back(fmt::format("{} on {} cannot be used: {}", s.arrangement.name(),
                                        counted(s.ranks, "rank", "ranks"), s.unusable));
    if (any([](plan::StepPrediction const& s) {
            return s.unusable.empty() && !std::isfinite(s.seconds);
        }))
        notes.push_back(
            fmt::format("the sweeps of {} are measured together, so only steps that consist of "
                        "evaluations are predicted",
                        steps.front().arrangement.name()));
    return notes;
}

/// Describes the work of a step, e.g. "1 drift with its matrix sweep and kick, 4 bias sweeps that
/// close joints".
std::string text_of(plan::StepWork const& work, Scene const& scene) {
    std::vector<std::string> parts;
    auto const add = [&](int times, char const* one, char const* many) {
        if (times > 0) parts.push_back(counted(times, one, many));
    };
    add(work.evaluations, "evaluation", "evaluations");
    add(work.kinematics, "pass of the kinematics", "passes of the kinematics");
    add(work.matrix_sweeps, "matrix sweep", "matrix sweeps");
    add(work.bias_sweeps, "bias sweep", "bias sweeps");
    add(work.drifts, "drift with its matrix sweep and kick",
        "drifts with a matrix sweep and a kick each");
    add(work.closings, "projection sweep", "projection sweeps");
    add(work.noises, "thermostat noise", "thermostat noises");
    std::string const text = fmt::format("{}", fmt::join(parts, ", "));
    return has_closures(scene) && !work.absolute()
               ? text + fmt::format("; {} corrections of jointed tips and loops",
                                    usual_sweeps(scene.dynamics))
               : text;
}
/// Converts the work of a step to JSON.
Json json_of(plan::StepWork const& work) {
    return {{"evaluations", work.evaluations},
            {"kinematics", work.kinematics},
            {"matrix_sweeps", work.matrix_sweeps},
            {"bias_sweeps", work.bias_sweeps},
            {"drifts", work.drifts},
            {"closings", work.closings},
            {"noises", work.noises}};
}

/// Returns the JSON of one row: computing, messages, and the speed-up over one rank.
Json row_of(MessagesOnRanks const& messages, plan::StepPrediction const& computing,
            double one_rank) {
    double const step = computing.seconds + messages.seconds, speed_up = one_rank / step;
    Json row = {{"ranks", messages.ranks},
                {"hosts", messages.hosts},
                {"bodies_a_rank", computing.bodies},
                {"arrangement", computing.arrangement.name()},
                {"computing_seconds", computing.seconds},
                {"message_seconds", messages.seconds},
                {"step_seconds", step},
                {"speed_up", speed_up},
                {"efficiency", speed_up / static_cast<double>(messages.ranks)},
                {"stages", messages.stages}};
    messages.traffic.for_each([&](char const* name, std::int64_t count) { row[name] = count; });
    return row;
}

}  // namespace

int usual_sweeps(DynamicsSpec const& dynamics) {
    return uses_joint_coordinates(dynamics.integrator) ? JointDynamics::usual_corrections
                                                       : usual_drift_sweeps;
}

std::vector<int> numbers_of_ranks(std::int64_t most) {
    std::vector<int> numbers;
    for (std::int64_t ranks = 1; ranks < most; ranks *= 2)
        numbers.push_back(static_cast<int>(ranks));
    numbers.push_back(static_cast<int>(most));
    return numbers;
}

void predict_steps(Predictions& predictions, plan::Planner& planner, Scene const& scene, Axes axes,
                   std::int64_t most_ranks) {
    predictions.work = plan::work_of_step(scene, usual_sweeps(scene.dynamics));
    for (int const ranks : numbers_of_ranks(most_ranks))
        predictions.steps.push_back(
            plan::predict_step(planner, scene, axes, predictions.work, ranks));
}

void add_steps(Text& text, Json& json, Scene const& scene,
               std::vector<MessagesOnRanks> const& messages, Predictions const& predictions) {
    Table times({"ranks", "hosts", "bodies per rank", "computed by", "computing", "messages",
                 "per step", "speed-up", "efficiency"},
                {0, 3});
    Table counts(
        {"ranks", "hosts", "stages", "gathers", "bytes", "exchanges", "bytes sent", "messages"});
    Json rows = Json::array();
    double const one_rank = predictions.steps.front().seconds + messages.front().seconds;
    for (std::size_t i = 0; i < messages.size(); ++i) {
        MessagesOnRanks const& m = messages[i];
        plan::StepPrediction const& computing = predictions.steps[i];
        Json const row = row_of(m, computing, one_rank);
        double const speed_up = row.at("speed_up").get<double>();
        bool const known = std::isfinite(speed_up);
        std::string const ranks = std::to_string(m.ranks), hosts = std::to_string(m.hosts);
        times.add(
            {ranks, hosts, std::to_string(computing.bodies), computing.arrangement.name(),
             cell(computing.seconds), cell(m.seconds), cell(row.at("step_seconds").get<double>()),
             known ? fmt::format("{:.4g}", speed_up) : "-",
             known ? fmt::format("{:.3g} %", 100 * row.at("efficiency").get<double>()) : "-"});
        Traffic const& t = m.traffic;
        counts.add({ranks, hosts, std::to_string(m.stages), std::to_string(t.gathers),
                    std::to_string(t.gathered_bytes), std::to_string(t.exchanges),
                    std::to_string(t.sent_bytes), cell(m.seconds)});
        rows.push_back(row);
    }
    std::vector<std::string> const notes = notes_on(scene, predictions.steps);
    text.heading("predicted time per step");
    text.entry("per step", text_of(predictions.work, scene));
    text.add(times);
    for (std::string const& note : notes) text.note(note);
    text.heading("predicted messages per step");
    text.add(counts);
    json["network"].update({{"sweeps", usual_sweeps(scene.dynamics)},
                            {"work", json_of(predictions.work)},
                            {"machine", predictions.machine},
                            {"predicted", rows},
                            {"notes", notes}});
}

}  // namespace catena::command
