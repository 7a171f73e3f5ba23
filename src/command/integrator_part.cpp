#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "command/report_parts.hpp"

namespace catena::command {
namespace {

Json json_of(IntegratorStudy const& study) {
    Json curves = Json::array();
    for (IntegratorCurve const& c : study.curves) {
        Json points = Json::array();
        for (IntegratorPoint const& p : c.points)
            points.push_back({{"step", p.step},
                              {"error", p.error},
                              {"energy_error", p.energy_error ? Json(*p.energy_error) : Json()},
                              {"seconds", spread_json(p.seconds)}});
        curves.push_back({{"integrator", c.name},
                          {"order", c.order},
                          {"slope", c.slope ? Json(*c.slope) : Json()},
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
            {"curves", curves},
            {"valid", study.valid()}};
}

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

template <class Error>
CurveFamily picture(IntegratorStudy const& study, Error const& error, std::string const& name) {
    CurveFamily family{study.title + ": " + name, "seconds of the whole time", "relative " + name, {}};
    for (IntegratorCurve const& c : study.curves) {
        NamedCurve curve{c.name, {}, {}, false, true};
        for (IntegratorPoint const& p : c.points) {
            if (!p.finished) continue;
            curve.x.push_back(p.seconds.median);
            curve.y.push_back(error(p));
        }
        family.curves.push_back(curve);
    }
    return family;
}

std::string order_text(IntegratorCurve const& c) {
    if (c.exact) return "errors are roundings";
    if (!c.slope) return "not above the reference's error: INVALID";
    return fmt::format("{:.3f}, nominal {}{}", *c.slope, c.order, c.as_promised() ? "" : ": INVALID");
}

ReportSection section_of(IntegratorStudy const& study) {
    Table table({"integrator", "step", "error", "energy error", "time", "order"}, {0});
    for (IntegratorCurve const& c : study.curves)
        for (IntegratorPoint const& p : c.points)
            table.add({c.name, exponent(p.step), p.finished ? exponent(p.error) : "came to no end",
                       p.energy_error ? exponent(*p.energy_error) : "-", duration_text(p.seconds.median),
                       &p == &c.points.back() ? order_text(c) : ""});
    bool const ends = std::isfinite(study.reference_error);
    std::string const reference = ends ? fmt::format("which is {:.1e} from itself at twice the step", study.reference_error)
                                       : "which came to no end at so wide a step: INVALID";
    std::string heading =
        fmt::format("{}: {} bodies over {:g}; reference: {}, {}", study.title, study.bodies, study.time, study.reference, reference);
    std::vector<CurveFamily> pictures{picture(study, [](IntegratorPoint const& p) { return p.error; }, "error")};
    if (study.no_energy_error.empty())
        pictures.push_back(picture(study, [](IntegratorPoint const& p) { return *p.energy_error; }, "energy error"));
    else
        heading += "; no energy error: " + study.no_energy_error;
    return {heading, table, pictures};
}

ReportSection section_of(std::vector<DriftStudy> const& drifts) {
    Table table(
        {"scene", "integrator", "step", "steps", "kinetic energy", "scatter of the energy", "drift of all steps", "standard error", ""},
        {0, 1, 8});
    for (DriftStudy const& d : drifts) {
        double const time = static_cast<double>(d.steps) * d.step;
        table.add({d.title, d.name, exponent(d.step), std::to_string(d.steps), fmt::format("{:.4g}", d.kinetic_energy), exponent(d.scatter),
                   exponent(d.slope * time), exponent(d.slope_error * time), d.valid() ? "VALID" : "INVALID"});
    }
    return {"Drift of the energy: a straight line through means over 50 blocks; VALID within four standard errors", table, {}};
}

}  // namespace

ReportPart integrator_part(std::vector<IntegratorStudy> const& studies, std::vector<DriftStudy> const& drifts) {
    ReportPart part{
        "integrators",
        "integrators",
        "Integrator error against run time",
        "Median time of a whole run; error: the largest distance of a centre of mass from the reference at the end, over the "
        "scene's extent; energy error: the largest change of the total energy over the largest kinetic energy. The order is "
        "that of the two finest steps whose errors stand above 20 times the reference's; within 0.1 of the nominal one is VALID, one that "
        "cannot be seen is INVALID unless all errors are roundings (a smaller dynamics.step is a shorter time). g-baoab is taken at zero "
        "friction.",
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
