#include <fmt/format.h>

#include <algorithm>

#include "command/report_parts.hpp"

namespace catena::command {
namespace {

Json json_of(IntegratorStudy const& study) {
    Json curves = Json::array();
    for (IntegratorCurve const& c : study.curves) {
        Json points = Json::array();
        for (IntegratorPoint const& p : c.points)
            points.push_back({{"step", p.step}, {"error", p.error}, {"energy_error", p.energy_error}, {"seconds", spread_json(p.seconds)}});
        curves.push_back({{"integrator", c.name},
                          {"order", c.order},
                          {"slope", c.slope ? Json(*c.slope) : Json()},
                          {"valid", c.as_promised()},
                          {"points", points}});
    }
    return {{"title", study.title},
            {"bodies", study.bodies},
            {"time", study.time},
            {"reference", study.reference},
            {"reference_error", study.reference_error},
            {"curves", curves}};
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

CurveFamily picture(IntegratorStudy const& study, double IntegratorPoint::* error, std::string const& name) {
    CurveFamily family{study.title + ": " + name, "seconds of the whole time", "relative " + name, {}};
    for (IntegratorCurve const& c : study.curves) {
        NamedCurve curve{c.name, {}, {}, false, true};
        for (IntegratorPoint const& p : c.points) {
            curve.x.push_back(p.seconds.median);
            curve.y.push_back(p.*error);
        }
        family.curves.push_back(curve);
    }
    return family;
}

ReportSection section_of(IntegratorStudy const& study) {
    Table table({"integrator", "step", "error", "energy error", "time", "order"}, {0});
    for (IntegratorCurve const& c : study.curves)
        for (IntegratorPoint const& p : c.points) {
            std::string order;
            if (&p == &c.points.back())
                order =
                    c.slope ? fmt::format("{:.3f}, nominal {}{}", *c.slope, c.order, c.as_promised() ? "" : ": INVALID") : "not resolved";
            table.add({c.name, exponent(p.step), exponent(p.error), exponent(p.energy_error), duration_text(p.seconds.median), order});
        }
    std::string const heading = fmt::format("{}: {} bodies over {:g}; reference: {}, which is {:.1e} from itself at twice the step",
                                            study.title, study.bodies, study.time, study.reference, study.reference_error);
    return {
        heading, table, {picture(study, &IntegratorPoint::error, "error"), picture(study, &IntegratorPoint::energy_error, "energy error")}};
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
        "that of the two finest steps whose errors stand above the reference's; within 0.1 of the nominal one is VALID. g-baoab "
        "is taken at zero friction.",
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
