// Implements the part of a report on the stability suite.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "report/report_parts.hpp"

namespace catena::command {
namespace {

/// Converts a study of one case to JSON.
Json json_of(StabilityStudy const& study) {
    Json points = Json::array();
    for (StabilityPoint const& p : study.points) {
        Json refined = Json::array();
        for (StabilityPoint::Refined const& r : p.refined)
            refined.push_back({{"forward_error", r.error},
                               {"residual_over_bound", r.of_residual_bound},
                               {"forward_error_over_bound", r.of_bound},
                               {"cost", r.cost}});
        Json settled;
        if (p.settled)
            settled = {{"steps", p.steps},
                       {"forward_error", p.settled->error},
                       {"residual_over_bound", p.settled->of_residual_bound},
                       {"forward_error_over_bound", p.settled->of_bound}};
        points.push_back({{"backend", p.backend},
                          {"handles", p.handles},
                          {"residual", p.residual},
                          {"residual_bound", p.residual_bound},
                          {"residual_over_bound", p.of_residual_bound},
                          {"forward_error", p.error},
                          {"forward_error_over_bound", p.of_bound},
                          {"refused", p.refused},
                          {"refined", refined},
                          {"settled", settled}});
    }
    Json peers = Json::array();
    for (StabilityPeer const& p : study.peers)
        peers.push_back({{"name", p.name}, {"forward_error", p.error}, {"why_not", p.why_not}});
    return {
        {"family", study.family},
        {"name", study.name},
        {"bodies", study.bodies},
        {"seeds", study.seeds},
        {"reference", study.reference},
        {"condition", study.condition ? Json(*study.condition) : Json()},
        {"growth", study.growth},
        {"oracle", {{"name", "articulated bodies, double"}, {"forward_error", study.oracle_error}}},
        {"points", points},
        {"peers", peers},
        {"best_of_others", study.best_of_others()},
        {"against_peers", study.against_peers()},
        {"articulated_against_peers", study.against_peers(true)},
        {"verdict", name_of(study.verdict())}};
}

/// Columns of the suite's tables.
std::vector<std::string> const columns{"case",          "condition",
                                       "growth",        "articulated bodies",
                                       "forward error", "over bound",
                                       "residual",      "over bound",
                                       "refined once",  "twice",
                                       "repeatedly",    "articulated handles",
                                       "refined",       ""};

/// Returns the largest value of the points with or without articulated handles; empty if one of
/// these has no value.
std::string worst(StabilityStudy const& study, bool articulated, auto const& value) {
    double largest = 0;
    bool all = false;
    for (StabilityPoint const& p : study.points) {
        if (p.is_articulated() != articulated) continue;
        std::optional<double> const found = p.refused.empty() ? value(p) : std::nullopt;
        if (!found) return "";
        largest = larger(largest, *found);
        all = true;
    }
    return all ? exponent(largest) : "";
}

/// Adds the row of a case.
void add_row(Table& table, StabilityStudy const& study) {
    using Number = std::optional<double>;
    bool const refused =
        !study.all(false, [](StabilityPoint const& p) { return p.refused.empty(); });
    auto const error = [](StabilityPoint const& p) { return Number(p.error); };
    auto const settled = [](StabilityPoint const& p) {
        return p.settled ? Number(p.settled->error) : std::nullopt;
    };
    auto const after = [&](std::size_t steps) {
        return worst(study, false, [&](StabilityPoint const& p) {
            return p.refined.size() >= steps ? Number(p.refined[steps - 1].error) : Number();
        });
    };
    table.add(
        {study.name, study.condition ? exponent(*study.condition) : "", exponent(study.growth),
         exponent(study.oracle_error), refused ? "refused" : worst(study, false, error),
         worst(study, false, [](StabilityPoint const& p) { return Number(p.of_bound); }),
         worst(study, false, [](StabilityPoint const& p) { return Number(p.residual); }),
         worst(study, false, [](StabilityPoint const& p) { return Number(p.of_residual_bound); }),
         after(1), after(2), worst(study, false, settled), worst(study, true, error),
         worst(study, true, settled), name_of(study.verdict())});
}

/// Returns the picture of all forward errors over the growth.
CurveFamily picture(std::vector<StabilityStudy> const& studies) {
    CurveFamily family{
        "Forward error over growth, all cases", "growth", "forward error (medians)", {}};
    NamedCurve oracle{"articulated bodies", {}, {}, false, true, false},
        one{"2^-53 growth", {1, 1e13}, {0x1p-53, 0x1p-53 * 1e13}, true};
    std::map<std::string, NamedCurve> curves;
    for (StabilityStudy const& study : studies) {
        oracle.x.push_back(study.growth), oracle.y.push_back(study.oracle_error);
        for (StabilityPoint const& p : study.points) {
            if (p.handles == name_of(Handles::full)) continue;
            NamedCurve& curve =
                curves[p.backend + (p.is_articulated() ? ", articulated handles" : "")];
            curve.x.push_back(study.growth), curve.y.push_back(p.error);
        }
    }
    std::map<std::string, NamedCurve> of_peers;
    for (StabilityStudy const& study : studies)
        for (StabilityPeer const& p : study.peers)
            of_peers[p.name].x.push_back(study.growth), of_peers[p.name].y.push_back(p.error);
    curves.merge(of_peers);
    for (auto& [name, curve] : curves)
        family.curves.push_back({name, curve.x, curve.y, false, true, false});
    NamedCurve refined{"refined repeatedly", {}, {}, false, true, false};
    for (StabilityStudy const& study : studies)
        for (StabilityPoint const& p : study.points)
            if (p.settled) refined.x.push_back(study.growth), refined.y.push_back(p.settled->error);
    family.curves.push_back(refined);
    family.curves.insert(family.curves.end(), {oracle, one});
    return family;
}

}  // namespace

ReportPart stability_part(std::vector<StabilityStudy> const& studies) {
    ReportPart part{
        "stability",
        "stability",
        "Stability suite",
        "Errors are medians over the seeds, the worst of all backends and handle kinds. The growth "
        "is the factor by which rounding errors of the data and of each body's and joint's "
        "equations change the solution. The condition is that of the joint-space inertia, or of "
        "the links' matrix. The bound of the residual is 32 depth(tree) 2^-53; that of the forward "
        "error is the same times the growth. VALID: both bounds hold. REFINED: they hold only "
        "after refinement (catena solve --refine; at most ten steps, as long as each halves the "
        "error). Refined errors must not exceed the larger of the residual's bound and 4 times the "
        "best error of others (articulated bodies in double, other programs), else the case is "
        "INVALID. If 2^-53 growth is above 1e-3, the equations of joint forces in double determine "
        "fewer than three digits. Such a case is ARTICULATED if refined solutions with articulated "
        "handles (catena solve --handles articulated) meet all these bounds. Otherwise the "
        "solution is that of a similar chain, or refused. The case is then BEYOND if others have "
        "no solution either or 2^-53 condition is above 1e-3 too, else LOST.",
        {},
        Json::array()};
    for (StabilityStudy const& study : studies) {
        part.json.push_back(json_of(study));
        part.valid = part.valid && study.verdict() != Verdict::invalid;
        add_row(part.section(study.family, Table(columns, {0, columns.size() - 1})).table, study);
    }
    if (!part.sections.empty()) part.sections.front().pictures = {picture(studies)};
    return part;
}

}  // namespace catena::command
