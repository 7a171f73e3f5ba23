// Implements the part of a report on the errors of the integrators.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/report_parts.hpp"

namespace catena::command {
namespace {

/// Returns the number, or null.
Json or_null(std::optional<double> const& number) { return number ? Json(*number) : Json(); }

/// Converts a point of an error curve to JSON.
Json json_of(IntegratorPoint const& p) {
    Json json = {{"step", p.step},
                 {"error", p.error},
                 {"energy_error", or_null(p.energy_error)},
                 {"seconds", spread_json(p.seconds)}};
    json["no_error"] = p.no_error;
    if (p.tolerance > 0)
        json.update({{"tolerance", p.tolerance},
                     {"taken", p.taken},
                     {"rejected", p.rejected},
                     {"allowed_error", p.allowed}});
    return json;
}

/// Returns the name of a scheme in the JSON.
char const* name_of(Scheme scheme) {
    switch (scheme) {
        case Scheme::implicit_springs:
            return "implicit springs";
        case Scheme::adaptive:
            return "adaptive";
        default:
            return "explicit";
    }
}

/// Converts a study of integrators to JSON.
Json json_of(IntegratorStudy const& study) {
    Json curves = Json::array();
    for (IntegratorCurve const& c : study.curves) {
        Json points = Json::array();
        for (IntegratorPoint const& p : c.points) points.push_back(json_of(p));
        curves.push_back({{"integrator", c.name},
                          {"scheme", name_of(c.scheme)},
                          {"order", c.order},
                          {"slope", or_null(c.slope)},
                          {"slope_beyond", or_null(c.slope_beyond)},
                          {"slow", c.slow},
                          {"unstable_from", c.unstable_from()},
                          {"too_stiff", c.too_stiff},
                          {"exact", c.exact},
                          {"valid", c.as_promised()},
                          {"points", points}});
    }
    return {{"title", study.title},
            {"bodies", study.bodies},
            {"time", study.time},
            {"reference", study.reference},
            {"reference_error", study.reference_error},
            {"no_energy_error", study.no_energy_error},
            {"no_implicit", study.no_implicit},
            {"refine", study.refine},
            {"curves", curves},
            {"valid", study.valid()}};
}

/// Converts a study of the energy drift to JSON.
Json json_of(DriftStudy const& d) {
    return {{"title", d.title},
            {"integrator", d.name},
            {"step", d.step},
            {"steps", d.steps},
            {"kinetic_energy", d.kinetic_energy},
            {"scatter", d.scatter},
            {"slope", d.slope},
            {"slope_error", d.slope_error},
            {"valid", d.valid()}};
}

/// A quantity of a point that a picture shows on one of its axes.
using Quantity = double (*)(IntegratorPoint const&);
double error_of(IntegratorPoint const& p) { return p.error; }
double energy_error_of(IntegratorPoint const& p) { return *p.energy_error; }
double seconds_of(IntegratorPoint const& p) { return p.seconds.median; }
double step_of(IntegratorPoint const& p) { return p.step; }

/// Returns a picture of an error over a quantity, with one curve per integrator.
CurveFamily picture(IntegratorStudy const& study, Quantity x, std::string const& x_label,
                    Quantity error, std::string const& name) {
    CurveFamily family{study.title + ": " + name, x_label, "relative " + name, {}};
    for (IntegratorCurve const& c : study.curves) {
        if (c.scheme == Scheme::adaptive && x == step_of) continue;
        NamedCurve curve{c.name, {}, {}, false, true};
        for (IntegratorPoint const& p : c.points) {
            if (!p.no_error.empty()) continue;
            curve.x.push_back(x(p));
            curve.y.push_back(error(p));
        }
        family.curves.push_back(curve);
    }
    return family;
}

/// Returns the picture of errors over the time step. A line marks the step at which the last
/// explicit integrator becomes unstable.
CurveFamily picture_over_step(IntegratorStudy const& study) {
    CurveFamily family = picture(study, step_of, "step", error_of, "error");
    family.title += " over the step";
    double limit = 0, least = HUGE_VAL, most = 0;
    for (IntegratorCurve const& c : study.curves) {
        if (c.scheme == Scheme::explicit_steps) limit = std::max(limit, c.unstable_from());
        for (IntegratorPoint const& p : c.points)
            if (c.scheme != Scheme::adaptive && p.error > 0)
                least = std::min(least, p.error), most = std::max(most, p.error);
    }
    if (limit > 0 && least < most)
        family.curves.push_back({"explicit: unstable", {limit, limit}, {least, most}, true});
    return family;
}

/// Describes the order or stability of an integrator, with "INVALID" if it fails its promise.
std::string verdict_of(IntegratorCurve const& c) {
    std::string const verdict = c.as_promised() ? "" : ": INVALID",
                      limit = exponent(c.unstable_from());
    if (c.exact) return "errors are rounding errors";
    if (c.too_stiff) return "unstable from " + limit;
    if (c.scheme == Scheme::adaptive)
        return c.as_promised() ? "within the allowed error" : "above the allowed error: INVALID";
    if (!c.slope) return "not above the reference's error: INVALID";
    std::string text = fmt::format("{:.3f}, nominal {}", *c.slope, c.order);
    if (c.slope_beyond) text += fmt::format(", beyond the explicit limit {:.3f}", *c.slope_beyond);
    if (c.unstable_from() > 0) text += "; unstable from " + limit;
    return text + verdict;
}

/// Returns the table and the pictures of a study.
ReportSection section_of(IntegratorStudy const& study) {
    auto const is_adaptive = [](IntegratorCurve const& c) { return c.scheme == Scheme::adaptive; };
    bool const any_adaptive = std::any_of(study.curves.begin(), study.curves.end(), is_adaptive);
    std::vector<std::string> columns{"integrator", "step", "error", "energy error", "time"};
    if (any_adaptive)
        columns.insert(columns.end(), {"tolerance", "inner steps", "rejected", "error allowed"});
    columns.emplace_back("order");
    Table table(columns, {0});
    for (IntegratorCurve const& c : study.curves)
        for (IntegratorPoint const& p : c.points) {
            bool const known = p.no_error.empty();
            std::vector<std::string> row{c.name, exponent(p.step),
                                         known ? exponent(p.error) : p.no_error,
                                         p.energy_error ? exponent(*p.energy_error) : "-",
                                         known ? duration_text(p.seconds.median) : "-"};
            if (is_adaptive(c))
                row.insert(row.end(), {fmt::format("{:.0e}", p.tolerance), std::to_string(p.taken),
                                       std::to_string(p.rejected), exponent(p.allowed)});
            row.resize(columns.size() - 1);
            row.push_back(&p == &c.points.back() ? verdict_of(c) : "");
            table.add(row);
        }
    bool const ends = std::isfinite(study.reference_error);
    std::string const reference =
        ends ? fmt::format("which differs by {:.1e} from itself at twice the step",
                           study.reference_error)
             : "which did not finish at twice the step: INVALID";
    std::string heading = fmt::format("{}: {} bodies over {:g}; reference: {}, {}", study.title,
                                      study.bodies, study.time, study.reference, reference);
    if (!study.no_implicit.empty())
        heading += "; without integrators with implicit springs: " + study.no_implicit;
    if (study.refine > 0)
        heading += fmt::format(
            "; solutions of rk4, dormand-prince and velocity-verlet refined {} (solver.refine)",
            counted(study.refine, "time", "times"));
    std::string const time = "run time in seconds";
    std::vector<CurveFamily> pictures{picture(study, seconds_of, time, error_of, "error")};
    if (study.has_implicit()) pictures.push_back(picture_over_step(study));
    if (study.no_energy_error.empty())
        pictures.push_back(picture(study, seconds_of, time, energy_error_of, "energy error"));
    else
        heading += "; no energy error: " + study.no_energy_error;
    return {heading, table, pictures};
}

/// Returns the table of energy drifts.
ReportSection section_of(std::vector<DriftStudy> const& drifts) {
    Table table({"scene", "integrator", "step", "steps", "kinetic energy", "scatter of the energy",
                 "drift of all steps", "standard error", ""},
                {0, 1, 8});
    for (DriftStudy const& d : drifts) {
        double const time = static_cast<double>(d.steps) * d.step;
        table.add({d.title, d.name, exponent(d.step), std::to_string(d.steps),
                   fmt::format("{:.4g}", d.kinetic_energy), exponent(d.scatter),
                   exponent(d.slope * time), exponent(d.slope_error * time),
                   d.valid() ? "VALID" : "INVALID"});
    }
    return {
        "Drift of the energy: a straight line through means over 50 blocks; VALID within four "
        "standard errors",
        table,
        {}};
}

}  // namespace

ReportPart integrator_part(std::vector<IntegratorStudy> const& studies,
                           std::vector<DriftStudy> const& drifts) {
    ReportPart part{
        "integrators",
        "integrators",
        "Integrator error against run time",
        "The time is the median of whole runs. The error is the largest distance of a centre of "
        "mass from the reference at the end, relative to the scene's extent. The energy error is "
        "the largest change of the total energy, relative to the largest kinetic energy. The order "
        "is determined from the two finest steps whose errors exceed 20 times the reference's. It "
        "is VALID within 0.1 of the nominal order. An order that cannot be determined is INVALID "
        "unless all errors are rounding errors (a smaller dynamics.step shortens the time). "
        "g-baoab and implicit-g-baoab run at zero friction. dormand-prince keeps a tolerance by "
        "inner steps, which it chooses between stops at every eighth of the time; its error may be "
        "the tolerance times the number of inner steps. staggered and implicit-g-baoab integrate "
        "joint springs implicitly. By design, vibrations faster than the step then become slower. "
        "Their amplitudes are small, so errors of positions are those of the slow motion. These "
        "integrators must run where the explicit integrator of their kind (velocity-verlet, "
        "g-baoab) cannot; in the report's own scene they must be of second order within 0.1 (a "
        "line through errors below a hundredth). The explicit one is unstable there (more than "
        "four times the reference's kinetic energy) or does not finish (equations without a "
        "solution). Such points are not drawn.",
        {},
        {{"scenes", Json::array()}, {"drifts", Json::array()}}};
    for (IntegratorStudy const& study : studies) {
        part.json["scenes"].push_back(json_of(study));
        part.valid = part.valid && study.valid();
        part.sections.push_back(section_of(study));
    }
    for (DriftStudy const& drift : drifts) {
        part.json["drifts"].push_back(json_of(drift));
        part.valid = part.valid && drift.valid();
    }
    if (!drifts.empty()) part.sections.push_back(section_of(drifts));
    return part;
}

}  // namespace catena::command
