// Draws the figures of `catena bench figures` as SVG.
#include <fmt/format.h>

#include <algorithm>

#include "page/curve_family.hpp"
#include "report/chapter_figures.hpp"
#include "report/figures.hpp"

namespace catena::command {
namespace {

/// Draws the time of each level on one core, threads and the GPU, with the transfers of a cut.
std::string levels_picture(LevelStudy const& study) {
    CurveFamily family{
        fmt::format("Figure 2.3: time of each level; assembly of {} bodies, {} handles",
                    study.bodies, name_of(study.handles)),
        "merges of the level (crosses: not resolved)",
        "microseconds",
        {}};
    auto const add = [&](std::string const& name, bool dashed, auto const& seconds) {
        NamedCurve curve{name, {}, {}, dashed, true};
        for (LevelPoint const& level : study.levels)
            if (std::optional<double> const value = seconds(level)) {
                curve.x.push_back(static_cast<double>(level.merges));
                curve.y.push_back(microseconds * *value);
            }
        if (!curve.x.empty()) family.curves.push_back(std::move(curve));
    };
    using Value = std::optional<double>;
    add("CPU, one core", false, [](LevelPoint const& p) { return Value(p.one_core.assembly); });
    add(fmt::format("CPU, {} threads", study.threads), false,
        [](LevelPoint const& p) { return p.threads ? Value(p.threads->assembly) : Value(); });
    add("GPU", false, [](LevelPoint const& p) { return p.gpu ? Value(p.gpu->assembly) : Value(); });
    add("transfers, cut above", true, [](LevelPoint const& p) { return p.transfers; });
    return curve_family(family);
}

/// Draws one quantity over the number of bodies, with the chapter's curves dashed.
std::string steps_picture(std::vector<FigurePoint> const& points, FigureQuantity const& quantity,
                          Handles handles) {
    CurveFamily family{fmt::format("Figure {}: {}, {} handles (dashed: the chapter's)",
                                   quantity.figure, quantity.title, name_of(handles)),
                       "bodies",
                       "milliseconds",
                       {}};
    for (FigurePoint const& point : points) {
        std::optional<Spread> const seconds = quantity_of(point, quantity.figure);
        if (point.handles != handles || !seconds) continue;
        auto curve = std::find_if(family.curves.begin(), family.curves.end(),
                                  [&](NamedCurve const& c) { return c.name == point.what.name; });
        if (curve == family.curves.end())
            curve = family.curves.insert(curve, {point.what.name, {}, {}, false, true});
        curve->x.push_back(static_cast<double>(point.bodies));
        curve->y.push_back(milliseconds * seconds->median);
    }
    for (std::size_t i = 0; i < chapter_columns.size(); ++i) {
        NamedCurve curve{"chapter, " + chapter_columns[i], {}, {}, true};
        for (auto const& [bodies, row] : chapter_figures().at(quantity.chapter)) {
            curve.x.push_back(static_cast<double>(bodies));
            curve.y.push_back(row[i]);
        }
        if (*std::max_element(curve.y.begin(), curve.y.end()) > 0)
            family.curves.push_back(std::move(curve));
    }
    return curve_family(family);
}

}  // namespace

std::optional<Spread> quantity_of(FigurePoint const& point, std::string const& figure) {
    if (figure == "2.5") return point.step;
    if (figure == "2.6") return point.solve;
    if (!point.upload) return std::nullopt;
    return Spread{point.upload->median + point.download->median,
                  point.upload->min + point.download->min, point.upload->max + point.download->max,
                  point.upload->count};
}

std::vector<std::pair<std::string, std::string>> draw_figures(
    Figures const& figures, std::vector<std::string> const& asked) {
    auto const wanted = [&](char const* figure) {
        return std::find(asked.begin(), asked.end(), figure) != asked.end();
    };
    std::vector<std::pair<std::string, std::string>> files;
    for (LevelStudy const& study : figures.levels)
        files.emplace_back(fmt::format("figure-2.3-{}.svg", name_of(study.handles)),
                           levels_picture(study));
    for (FigureQuantity const& quantity : figure_quantities) {
        if (!wanted(quantity.figure)) continue;
        for (Handles const handles : {Handles::full, Handles::projected})
            if (std::any_of(figures.points.begin(), figures.points.end(),
                            [&](FigurePoint const& p) {
                                return p.handles == handles && quantity_of(p, quantity.figure);
                            }))
                files.emplace_back(
                    fmt::format("figure-{}-{}.svg", quantity.figure, name_of(handles)),
                    steps_picture(figures.points, quantity, handles));
    }
    return files;
}

}  // namespace catena::command
