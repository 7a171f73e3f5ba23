// Implements the part of a report on the solver's errors.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "report/report_parts.hpp"

namespace catena::command {
namespace {

/// Converts a study of the solver to JSON.
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
    return {{"title", study.title},
            {"scene", study.file},
            {"kind", study.kind},
            {"bodies", study.bodies},
            {"condition", study.condition ? Json(*study.condition) : Json()},
            {"reference", study.reference},
            {"oracle",
             {{"name", "articulated bodies, double"},
              {"forward_error", study.oracle_error},
              {"seconds", spread_json(study.oracle_seconds)}}},
            {"points", points}};
}

/// Returns the table of a study.
ReportSection section_of(SolverStudy const& study) {
    Table table({"backend", "handles", "threads", "residual", "bound", "forward error", "time",
                 "ns per body", ""},
                {0, 1, 8});
    auto const a_body = [&](double seconds) {
        return fmt::format("{:.1f}", 1e9 * seconds / static_cast<double>(study.bodies));
    };
    for (SolverPoint const& p : study.points)
        table.add({p.backend, p.handles, std::to_string(p.threads), exponent(p.residual),
                   exponent(p.residual_bound), exponent(p.forward_error),
                   duration_text(p.seconds.median), a_body(p.seconds.median),
                   p.valid ? "VALID" : "INVALID"});
    table.add({"articulated bodies", "(oracle)", "1", "", "", exponent(study.oracle_error),
               duration_text(study.oracle_seconds.median), a_body(study.oracle_seconds.median),
               ""});
    std::string const heading = fmt::format(
        "{} ({}): {} bodies, condition {}; reference: {}", study.title, study.kind, study.bodies,
        study.condition ? exponent(*study.condition) : "not estimated", study.reference);
    return {heading, table, {}};
}

/// Returns the title that chains of several lengths have in common.
std::string series_of(SolverStudy const& study) {
    std::string const length = fmt::format(", {} bodies", study.bodies);
    return study.title.ends_with(length) ? study.title.substr(0, study.title.size() - length.size())
                                         : study.title;
}

/// Returns a picture of an error over the run time, with one curve per backend and kind of handles
/// through all studies of a series.
CurveFamily picture(std::string const& series, std::vector<SolverStudy const*> const& studies,
                    double SolverPoint::* error, std::string const& name) {
    std::map<std::string, NamedCurve> curves;
    NamedCurve oracle{"articulated bodies", {}, {}, true, true};
    for (SolverStudy const* study : studies) {
        for (SolverPoint const& p : study->points) {
            NamedCurve& curve = curves[p.backend + ", " + p.handles];
            curve.x.push_back(p.seconds.median);
            curve.y.push_back(p.*error);
            curve.marked = true;
        }
        oracle.x.push_back(study->oracle_seconds.median);
        oracle.y.push_back(study->oracle_error);
    }
    CurveFamily family{
        fmt::format("{}: {}", series, name), "seconds of an evaluation", "relative " + name, {}};
    for (auto& [label, curve] : curves) {
        curve.name = label;
        family.curves.push_back(curve);
    }
    if (error == &SolverPoint::forward_error) family.curves.push_back(oracle);
    return family;
}

}  // namespace

ReportPart solver_part(std::vector<SolverStudy> const& studies) {
    ReportPart part{
        "studies",
        "solver",
        "Solver error against run time",
        "The time is the median of one evaluation. The residual is the largest local backward "
        "error of any body or joint. The forward error is the largest difference of the joint "
        "accelerations from the reference, relative to the largest acceleration.",
        {},
        Json::array()};
    std::map<std::string, std::vector<SolverStudy const*>> series;
    for (SolverStudy const& study : studies) {
        series[series_of(study)].push_back(&study);
        part.json.push_back(json_of(study));
        part.valid = part.valid && std::all_of(study.points.begin(), study.points.end(),
                                               [](SolverPoint const& p) { return p.valid; });
        part.sections.push_back(section_of(study));
    }
    for (ReportSection& section : part.sections) {
        SolverStudy const& study =
            studies[static_cast<std::size_t>(&section - part.sections.data())];
        auto const& same = series.at(series_of(study));
        if (same.front() != &study) continue;
        section.pictures = {
            picture(series_of(study), same, &SolverPoint::forward_error, "forward error"),
            picture(series_of(study), same, &SolverPoint::residual, "backward error")};
    }
    return part;
}

}  // namespace catena::command
