// Implements the predictions of `catena plan` and their tables.
#include "plan/predictions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catena::command {

std::string cell(double seconds) { return std::isfinite(seconds) ? duration_text(seconds) : "-"; }

namespace {

/// Converts times to JSON, in seconds by name of the phase.
Json json_of(plan::PhaseSeconds const& seconds) {
    Json json = Json::object();
    for (std::size_t p = 0; p < plan::phases; ++p) json[plan::phase_names[p]] = seconds[p];
    return json;
}

/// Adds the table of levels of the pairwise tree.
void add_levels(Text& text, Json& json, plan::LevelPlan const& levels) {
    GpuLevels const best = levels.best();
    text.heading(
        fmt::format("levels of cuda-levels; quickest with {},{} on the GPU: {}, all: {}, none: {}",
                    best.up, best.down, duration_text(levels.seconds(best)),
                    duration_text(levels.seconds({})), duration_text(levels.seconds({0, 0}))));
    Table table({"", "items", "assembly: host", "GPU", "transfer above", "disassembly: host", "GPU",
                 "transfer above"});
    Json& list = json["levels"] = Json::array();
    for (std::size_t l = 0; l < levels.rows().size(); ++l) {
        plan::LevelRow const& row = levels.rows()[l];
        table.add({l == 0 ? "bodies" : "level " + std::to_string(l), std::to_string(row.items),
                   cell(row.host_up), cell(row.gpu_up), l == 0 ? "-" : cell(row.cut_up),
                   cell(row.host_down), cell(row.gpu_down), l == 0 ? "-" : cell(row.cut_down)});
        list.push_back(
            {{"items", row.items},
             {"up", {{"host", row.host_up}, {"gpu", row.gpu_up}, {"transfer_above", row.cut_up}}},
             {"down",
              {{"host", row.host_down}, {"gpu", row.gpu_down}, {"transfer_above", row.cut_down}}}});
    }
    text.add(table);
    json["gpu_levels"] = {
        {"up", best.up}, {"down", best.down}, {"predicted", levels.seconds(best)}};
}

}  // namespace

Predictions predict(plan::Planner& planner, Scene const& scene, Axes axes, int ranks) {
    std::vector<plan::Share> const shares = plan::shares_of(scene, axes, ranks);
    Predictions found;
    found.all = planner.predict(shares);
    found.no_gpu = planner.machine().no_gpu;
    found.machine = planner.machine().identity;
    if (found.no_gpu.empty()) {
        found.levels = planner.plan_levels(shares);
        bool const given =
            scene.solver.backend == Backend::cuda_levels && !plan::leaves_open(scene);
        found.all.push_back(planner.predict(
            shares, *found.levels, given ? scene.solver.levels_on_gpu() : found.levels->best()));
    }
    for (plan::Share const& share : shares)
        found.gpu_memory += planner.machine().gpu_memory(share.family, share.bodies);
    found.choice = plan::choose(scene, axes, planner, ranks);
    return found;
}

plan::Prediction const* prediction_of(Predictions const& predictions,
                                      plan::Arrangement const& arrangement) {
    auto const same = [&](plan::Prediction const& p) {
        return p.unusable.empty() && p.arrangement == arrangement;
    };
    auto const found = std::find_if(predictions.all.begin(), predictions.all.end(), same);
    return found == predictions.all.end() ? nullptr : &*found;
}

void add_predictions(Text& text, Json& json, Predictions const& predictions) {
    text.heading(
        "predicted times of one evaluation on the largest rank (from times measured on this "
        "machine; without messages and OpenMM)");
    std::vector<std::string> header{""};
    for (plan::Prediction const& p : predictions.all)
        header.push_back(p.arrangement.name() + (p.alike ? "" : " *"));
    Table table(header);
    for (std::size_t phase = 0; phase < plan::phases; ++phase) {
        std::vector<std::string> row{plan::phase_names[phase]};
        for (plan::Prediction const& p : predictions.all)
            row.push_back(p.unusable.empty() ? cell(p.seconds[phase]) : "-");
        table.add(row);
    }
    text.add(table);
    text.note("* uses another tree and gives other last bits: only on request");
    json["predicted_seconds"] = Json::object();
    for (plan::Prediction const& p : predictions.all) {
        if (p.unusable.empty())
            json["predicted_seconds"][p.arrangement.name()] = json_of(p.seconds);
        else
            text.note(p.arrangement.name() + " cannot be used: " + p.unusable);
    }
    if (predictions.levels) add_levels(text, json, *predictions.levels);
}

void add_measured(Text& text, Json& json, Predictions const& predictions,
                  plan::PhaseSeconds const& measured) {
    plan::Prediction const* const predicted =
        prediction_of(predictions, predictions.choice.arrangement);
    text.heading("predicted and measured, " + predictions.choice.arrangement.name() +
                 " (the shortest of several)");
    Table table({"", "predicted", "measured", "ratio"});
    Json& phases = json["measured_seconds"] = json_of(measured);
    phases["ratio"] = nullptr;
    for (std::size_t p = 0; p < plan::phases; ++p) {
        double const seconds = predicted ? predicted->seconds[p] : std::nan("");
        table.add({plan::phase_names[p], cell(seconds), cell(measured[p]),
                   std::isfinite(seconds) ? fmt::format("{:.2f}", seconds / measured[p]) : "-"});
        if (p == plan::evaluation && std::isfinite(seconds))
            phases["ratio"] = seconds / measured[p];
    }
    text.add(table);
}

}  // namespace catena::command
