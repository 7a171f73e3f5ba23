// Implements the part of a report that compares the stability suite with other programs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/report_parts.hpp"

namespace catena::command {
namespace {

/// Returns the smallest bound of the forward error among the points that have an answer.
double least_bound(StabilityStudy const& study) {
    double least = std::numeric_limits<double>::infinity();
    for (StabilityPoint const& p : study.points)
        if (p.refused.empty()) least = std::min(least, p.residual_bound * study.growth);
    return least;
}

/// Formats a number; empty if it is not finite, as for a bound or a peer without an answer.
std::string number(double value) { return std::isfinite(value) ? exponent(value) : ""; }

/// Counts the cases in which Catena's largest error is smaller than that of a peer, without and
/// with refinement.
struct Score {
    /// Cases that the peer solved; those that are neither BEYOND nor LOST; and those among the
    /// latter in which Catena's error is smaller.
    int ran = 0, within = 0, closer = 0;
    /// Cases within in which all points were refined, and those in which the refined error is
    /// smaller.
    int refined = 0, closer_refined = 0;

    void add(StabilityStudy const& study, double error) {
        ++ran;
        if (study.beyond()) return;
        ++within;
        closer += study.worst(&StabilityPoint::plain_error) < error ? 1 : 0;
        if (!study.all(false, [](StabilityPoint const& p) { return p.settled.has_value(); }))
            return;
        ++refined;
        closer_refined += study.worst(&StabilityPoint::last_error) < error ? 1 : 0;
    }
};

/// Returns the table of peers with their scores.
ReportSection scores(std::vector<StabilityStudy> const& studies, Json const& peers) {
    ReportSection section{
        "peers",
        Table({"", "version", "cases", "not beyond", "Catena is closer", "refined"}, {0, 1}),
        {}};
    for (Json const& peer : peers) {
        if (peer.contains("not_run")) continue;
        std::string const name = peer.at("name");
        Score score;
        for (StabilityStudy const& study : studies)
            for (StabilityPeer const& p : study.peers)
                if (p.name == name && p.why_not.empty()) score.add(study, p.error);
        section.table.add({name, peer.value("version", ""), std::to_string(score.ran),
                           std::to_string(score.within), std::to_string(score.closer),
                           fmt::format("{} of {}", score.closer_refined, score.refined)});
    }
    return section;
}

/// Removes the place in its own source code that a program names in an error message, and shortens
/// the rest.
std::string shortened(std::string const& why) {
    std::size_t const place = why.find(" thrown at "),
                      text = place == std::string::npos ? place : why.find(": ", place + 11);
    std::string const rest = text == std::string::npos ? why : why.substr(text + 2);
    return rest.size() > 100 ? rest.substr(0, 100) + " ..." : rest;
}

/// Returns the table of the first case of each family that a peer did not solve.
ReportSection stops(std::vector<StabilityStudy> const& studies) {
    ReportSection section{"not done", Table({"", "family", "from", "why"}, {0, 1, 2, 3}), {}};
    std::vector<std::string> said;
    for (StabilityStudy const& study : studies)
        for (StabilityPeer const& p : study.peers) {
            std::string const key = p.name + "/" + study.family;
            if (p.why_not.empty() || std::find(said.begin(), said.end(), key) != said.end())
                continue;
            said.push_back(key);
            section.table.add({p.name, study.family, study.name, shortened(p.why_not)});
        }
    return section;
}

}  // namespace

ReportPart peers_part(std::vector<StabilityStudy> const& studies, Json peers) {
    ReportPart part{
        "peers",
        "",
        "Stability suite by other programs",
        "Forward errors are medians over the seeds. Catena's are the worst of all backends and "
        "handle kinds, without refinement and refined repeatedly. The ratio divides the refined "
        "error by the larger of the residual's bound and 4 times the best error of the others, "
        "articulated bodies in double included. Without refinement it divides Catena's error by "
        "the bound times the growth. A case with a ratio above 1 is INVALID unless these equations "
        "lose all digits: LOST if others keep them, else BEYOND.",
        {scores(studies, peers)},
        std::move(peers)};
    std::vector<std::string> columns{"case", "bound", "Catena", "refined", "articulated bodies"};
    if (!studies.empty())
        for (StabilityPeer const& p : studies.front().peers) columns.push_back(p.name);
    columns.emplace_back("ratio");
    columns.emplace_back();
    for (StabilityStudy const& study : studies) {
        double const worst = study.worst(&StabilityPoint::plain_error);
        bool const refined =
            study.all(false, [](StabilityPoint const& p) { return p.settled.has_value(); });
        std::vector<std::string> row{
            study.name, number(least_bound(study)), std::isinf(worst) ? "refused" : exponent(worst),
            refined ? number(study.worst(&StabilityPoint::last_error)) : "",
            number(study.oracle_error)};
        for (StabilityPeer const& p : study.peers) row.push_back(number(p.error));
        row.push_back(number(study.against_peers()));
        row.emplace_back(name_of(study.verdict()));
        part.section(study.family, Table(columns, {0, columns.size() - 1})).table.add(row);
    }
    part.sections.push_back(stops(studies));
    return part;
}

}  // namespace catena::command
