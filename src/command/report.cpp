#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>

#include "command/commands.hpp"
#include "command/describe.hpp"
#include "command/picture.hpp"
#include "command/version.hpp"
#include "io/output.hpp"
#include "mpi/first_rank.hpp"
#include "report/solver_errors.hpp"

namespace catena::command {
namespace {

Json spread_json(Spread const& s) { return {{"median", s.median}, {"min", s.min}, {"max", s.max}, {"repeat", s.count}}; }

Json json_of(SolverStudy const& study) {
    Json points = Json::array();
    for (SolverPoint const& p : study.points)
        points.push_back({{"backend", p.backend},
                          {"handles", p.handles},
                          {"threads", p.threads},
                          {"residual", p.residual},
                          {"residual_bound", p.residual_bound},
                          {"forward_error", p.forward_error},
                          {"seconds", spread_json(p.seconds)},
                          {"valid", p.valid}});
    return {
        {"title", study.title},
        {"scene", study.file},
        {"kind", study.kind},
        {"bodies", study.bodies},
        {"condition", study.condition ? Json(*study.condition) : Json()},
        {"reference", study.reference},
        {"oracle",
         {{"name", "articulated bodies, double"}, {"forward_error", study.oracle_error}, {"seconds", spread_json(study.oracle_seconds)}}},
        {"points", points}};
}

std::string text_of(SolverStudy const& study) {
    Text text;
    text.heading(fmt::format("{} ({}): {} bodies, condition {}; reference: {}", study.title, study.kind, study.bodies,
                             study.condition ? fmt::format("{:.1e}", *study.condition) : "not estimated", study.reference));
    Table table({"backend", "handles", "threads", "residual", "bound", "forward error", "time", "ns a body", ""}, {0, 1, 8});
    auto const a_body = [&](double seconds) { return fmt::format("{:.1f}", 1e9 * seconds / static_cast<double>(study.bodies)); };
    for (SolverPoint const& p : study.points)
        table.add({p.backend, p.handles, std::to_string(p.threads), fmt::format("{:.1e}", p.residual),
                   fmt::format("{:.1e}", p.residual_bound), fmt::format("{:.1e}", p.forward_error), duration_text(p.seconds.median),
                   a_body(p.seconds.median), p.valid ? "VALID" : "INVALID"});
    table.add({"articulated bodies", "(oracle)", "1", "", "", fmt::format("{:.1e}", study.oracle_error),
               duration_text(study.oracle_seconds.median), a_body(study.oracle_seconds.median), ""});
    text.add(table);
    return text.str();
}

}  // namespace

Outcome report_scenes(std::vector<Scene> const& scenes, Communicator const& communicator, ReportRequest const& request) {
    on_first_rank(communicator, [&] {
        std::error_code error;
        std::filesystem::create_directories(request.output, error);
        if (error || !std::filesystem::is_directory(request.output))
            throw InputError("the folder cannot be made: " + error.message(), "--output " + request.output, "name another");
    });
    std::vector<Backend> const backends =
        request.backend.empty() || request.backend == "auto" ? cpu_backends() : std::vector{scenes.front().solver.backend};
    std::vector<Handles> const handles =
        request.handles.empty() ? std::vector{Handles::projected, Handles::full} : std::vector{scenes.front().solver.handles};
    Outcome outcome;
    outcome.json = {{"report", "solver error against run time"},
                    {"build", version_json()},
                    {"hardware", hardware_json()},
                    {"ranks", communicator.size()},
                    {"forward_error", "largest difference of the joint accelerations from the reference, relative to the largest"},
                    {"studies", Json::array()}};
    for (Scene const& scene : scenes) {
        SolverStudy const study = study_solver_errors(scene, communicator, backends, handles, request.repeat);
        spdlog::info("{} done", scene.title);
        if (communicator.rank() != 0) continue;
        outcome.valid =
            outcome.valid && std::all_of(study.points.begin(), study.points.end(), [](SolverPoint const& p) { return p.valid; });
        outcome.text += text_of(study);
        outcome.json["studies"].push_back(json_of(study));
    }
    on_first_rank(communicator, [&] {
        std::string const json = request.output + "/report.json", png = request.output + "/report.png";
        outcome.json["valid"] = outcome.valid;
        write_text_file(json, json_text(outcome.json));
        Picture const picture = draw_report(json, png);
        outcome.text += fmt::format("{}, {}\n", hardware_text(), counted(communicator.size(), "rank", "ranks"));
        outcome.text += "wrote " + json + "\n" + (picture.file.empty() ? picture.remark : "drew " + picture.file) + "\n";
        outcome.text += outcome.valid ? "VALID\n" : "INVALID\n";
    });
    return outcome;
}

}  // namespace catena::command
