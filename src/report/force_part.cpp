// Implements the part of a report on the errors of OpenMM's forces.
#include <fmt/format.h>

#include <algorithm>

#include "report/report_parts.hpp"

namespace catena::command {
namespace {

/// Converts a study of forces to JSON.
Json json_of(ForceStudy const& study) {
    Json points = Json::array();
    for (ForcePoint const& p : study.points)
        points.push_back({{"platform", p.platform},
                          {"precision", p.precision},
                          {"error", p.error},
                          {"largest_error", p.largest_error},
                          {"error_bound", p.bound},
                          {"seconds", spread_json(p.seconds)},
                          {"valid", p.valid()}});
    return {{"title", study.title}, {"beads", study.beads}, {"points", points}};
}

/// Returns the table and the picture of a study.
ReportSection section_of(ForceStudy const& study) {
    Table table({"platform", "precision", "rms error", "largest error", "bound", "time", ""},
                {0, 1, 6});
    CurveFamily family{
        study.title + ": forces", "seconds of an evaluation", "relative error (rms)", {}};
    for (ForcePoint const& p : study.points) {
        table.add({p.platform, p.precision, exponent(p.error), exponent(p.largest_error),
                   exponent(p.bound), duration_text(p.seconds.median),
                   p.valid() ? "VALID" : "INVALID"});
        family.curves.push_back(
            {p.platform + ", " + p.precision, {p.seconds.median}, {p.error}, false, true});
    }
    return {fmt::format("{}: {} beads", study.title, study.beads), table, {family}};
}

}  // namespace

ReportPart force_part(std::vector<ForceStudy> const& studies) {
    ReportPart part{
        "forces",
        "forces",
        "Error of OpenMM's forces against run time",
        "Differences from OpenMM's Reference platform (double precision), relative to the root "
        "mean square and the largest of the forces. The time is the median of evaluations of the "
        "forces alone. The bound of both errors is 2^12 units of the precision of pair forces "
        "(2^-24, double 2^-53). On GPUs it includes 64 steps of 2^-32 kJ/mol/nm, in which forces "
        "are summed, and 64 times 2^-24, the precision of parameters.",
        {},
        Json::array()};
    for (ForceStudy const& study : studies) {
        part.json.push_back(json_of(study));
        part.valid = part.valid && std::all_of(study.points.begin(), study.points.end(),
                                               [](ForcePoint const& p) { return p.valid(); });
        part.sections.push_back(section_of(study));
    }
    return part;
}

}  // namespace catena::command
