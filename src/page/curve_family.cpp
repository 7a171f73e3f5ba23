// Implements the SVG picture of several curves on logarithmic axes.
#include "page/curve_family.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "page/axis.hpp"
#include "page/html.hpp"

namespace catena {
namespace {

// Sizes in pixels: picture, margins around the curves, line height of the legend.
constexpr double width = 760, height = 420, left = 66, right = 190, top = 40, bottom = 46,
                 line_height = 18;
constexpr double inner_width = width - left - right, inner_height = height - top - bottom;
// Colours are those of Okabe and Ito and two dark ones. Colours and marks together distinguish 45
// curves.
constexpr char const* colours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00",
                                   "#56b4e9", "#882255", "#332288", "#475569"};
// Paths of the marks, centred at the origin: circle, square, triangle, diamond, triangle upside
// down.
constexpr std::string_view marks[] = {"M-3.2,0a3.2,3.2 0 1,0 6.4,0a3.2,3.2 0 1,0 -6.4,0z",
                                      "M-3,-3h6v6h-6z", "M0,-4l3.7,6.6h-7.4z",
                                      "M0,-4.3l3.4,4.3l-3.4,4.3l-3.4,-4.3z", "M0,4l3.7,-6.6h-7.4z"};
constexpr std::string_view cross =
    "M-3,-3L3,3M-3,3L3,-3";  // path of a value that could not be resolved

/// True if a point can be drawn on logarithmic axes.
bool drawn(double x, double y) { return x > 0 && y > 0 && std::isfinite(x) && std::isfinite(y); }

/// Colour of a curve by its number.
char const* colour_of(std::size_t curve) { return colours[curve % std::size(colours)]; }

/// Mark of a curve's point at a position in pixels.
std::string mark_at(std::size_t curve, double x, double y) {
    return fmt::format("<path fill=\"{}\" transform=\"translate({:.1f},{:.1f})\" d=\"{}\"/>",
                       colour_of(curve), x, y, marks[curve % std::size(marks)]);
}
/// Cross on the axis for a value that could not be resolved.
std::string gap_at(std::size_t curve, double x) {
    return fmt::format(
        "<path fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\" "
        "transform=\"translate({:.1f},{:.1f})\" d=\"{}\"><title>not "
        "resolved</title></path>",
        colour_of(curve), x, height - bottom, cross);
}

/// Range of positive values.
struct Range {
    double low = std::numeric_limits<double>::infinity(), high = 0;
    void add(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
};

}  // namespace

/// A point that cannot be drawn interrupts the curve.
std::string curve_family(CurveFamily const& family) {
    // The ranges of the axes cover all drawn points, and the gaps along x.
    Range xs, ys;
    for (NamedCurve const& curve : family.curves)
        for (std::size_t i = 0; i < curve.x.size(); ++i)
            if (drawn(curve.x[i], curve.y[i]))
                xs.add(curve.x[i]), ys.add(curve.y[i]);
            else if (std::isnan(curve.y[i]) && curve.x[i] > 0)
                xs.add(curve.x[i]);
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
        "height=\"{1}\" role=\"img\">\n"
        "<style>text {{ fill: #1b2733; font: 12px system-ui, \"Segoe UI\", Roboto, Arial, "
        "sans-serif; }} .grid {{ stroke: #e9edf1; }} "
        ".axis {{ stroke: #9aa8b5; }} polyline {{ fill: none; stroke-width: 1.8; stroke-linejoin: "
        "round; }}</style>\n"
        "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n<text x=\"4\" y=\"14\" "
        "font-weight=\"600\">{2}</text>\n",
        width, height, escaped(family.title));
    if (ys.high == 0) return svg + "<text x=\"4\" y=\"40\">No values.</text></svg>\n";
    Axis const x_axis = logarithmic_axis(xs.low, xs.high),
               y_axis = logarithmic_axis(ys.low, ys.high);
    auto const at_x = [&](double x) { return left + inner_width * x_axis.place(x); };
    auto const at_y = [&](double y) { return top + inner_height * (1 - y_axis.place(y)); };
    // Grid lines and labels of both axes.
    for (Axis::Tick const& tick : y_axis.ticks)
        svg += fmt::format(
            "<line class=\"grid\" x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/><text "
            "text-anchor=\"end\" x=\"{3}\" "
            "y=\"{4:.1f}\">{5}</text>\n",
            left, left + inner_width, at_y(tick.value), left - 8, at_y(tick.value) + 4, tick.label);
    for (Axis::Tick const& tick : x_axis.ticks)
        svg += fmt::format(
            "<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/><text "
            "text-anchor=\"middle\" x=\"{0:.1f}\" "
            "y=\"{3}\">{4}</text>\n",
            at_x(tick.value), top, height - bottom, height - bottom + 18, tick.label);
    svg += fmt::format("<line class=\"axis\" x1=\"{0}\" x2=\"{1}\" y1=\"{2}\" y2=\"{2}\"/>\n", left,
                       left + inner_width, height - bottom);
    svg += fmt::format(
        "<text text-anchor=\"middle\" x=\"{}\" y=\"{}\">{}</text><text x=\"4\" "
        "y=\"32\">{}</text>\n",
        left + inner_width / 2, height - 6, escaped(family.x_label), escaped(family.y_label));
    // Every curve: its lines, its marks on top, and its line of the legend.
    for (std::size_t i = 0; i < family.curves.size(); ++i) {
        NamedCurve const& curve = family.curves[i];
        std::string const style = fmt::format("stroke=\"{}\"{}", colour_of(i),
                                              curve.dashed ? " stroke-dasharray=\"5 4\"" : "");
        std::string lines, line, dots;
        auto const end_line = [&] {
            if (!line.empty()) lines += "<polyline " + style + " points=\"" + line + "\"/>";
            line.clear();
        };
        for (std::size_t k = 0; k < curve.x.size(); ++k) {
            if (std::isnan(curve.y[k]) && curve.x[k] > 0) dots += gap_at(i, at_x(curve.x[k]));
            if (!drawn(curve.x[k], curve.y[k])) {
                end_line();
                continue;
            }
            if (curve.joined)
                line += fmt::format("{:.1f},{:.1f} ", at_x(curve.x[k]), at_y(curve.y[k]));
            if (curve.marked) dots += mark_at(i, at_x(curve.x[k]), at_y(curve.y[k]));
        }
        end_line();
        double const y = top + 8 + line_height * static_cast<double>(i),
                     x = left + inner_width + 12;
        svg += lines;
        if (curve.joined)
            svg += fmt::format(
                "<line {} stroke-width=\"1.8\" x1=\"{}\" x2=\"{}\" y1=\"{}\" y2=\"{}\"/>", style, x,
                x + 22, y, y);
        if (curve.marked) svg += mark_at(i, x + 11, y);
        svg +=
            fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n", x + 28, y + 4, escaped(curve.name));
        svg += dots + (dots.empty() ? "" : "\n");
    }
    return svg + "</svg>\n";
}

}  // namespace catena
