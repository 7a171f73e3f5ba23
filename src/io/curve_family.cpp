#include "io/curve_family.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/axis.hpp"
#include "io/html.hpp"

namespace catena {
namespace {

constexpr double width = 760, height = 420, left = 66, right = 190, top = 40, bottom = 46, line_height = 18;
constexpr double inner_width = width - left - right, inner_height = height - top - bottom;
constexpr char const* colours[] = {"#0b6bcb", "#c2410c", "#15803d", "#7c3aed", "#b91c1c", "#0e7490", "#a16207", "#be185d", "#475569"};

bool drawn(double x, double y) { return x > 0 && y > 0 && std::isfinite(x) && std::isfinite(y); }

struct Range {
    double low = std::numeric_limits<double>::infinity(), high = 0;
    void add(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
};

}  // namespace

std::string curve_family(CurveFamily const& family) {
    Range xs, ys;
    for (NamedCurve const& curve : family.curves)
        for (std::size_t i = 0; i < curve.x.size(); ++i)
            if (drawn(curve.x[i], curve.y[i])) xs.add(curve.x[i]), ys.add(curve.y[i]);
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\">\n"
        "<style>text {{ fill: #1b2733; font: 12px system-ui, \"Segoe UI\", Roboto, Arial, sans-serif; }} .grid {{ stroke: #e9edf1; }} "
        ".axis {{ stroke: #9aa8b5; }} polyline {{ fill: none; stroke-width: 1.8; stroke-linejoin: round; }}</style>\n"
        "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n<text x=\"4\" y=\"14\" font-weight=\"600\">{2}</text>\n",
        width, height, escaped(family.title));
    if (ys.high == 0) return svg + "<text x=\"4\" y=\"40\">No values.</text></svg>\n";
    Axis const x_axis = logarithmic_axis(xs.low, xs.high), y_axis = logarithmic_axis(ys.low, ys.high);
    auto const at_x = [&](double x) { return left + inner_width * x_axis.place(x); };
    auto const at_y = [&](double y) { return top + inner_height * (1 - y_axis.place(y)); };
    for (Axis::Tick const& tick : y_axis.ticks)
        svg += fmt::format(
            "<line class=\"grid\" x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/><text text-anchor=\"end\" x=\"{3}\" "
            "y=\"{4:.1f}\">{5}</text>\n",
            left, left + inner_width, at_y(tick.value), left - 8, at_y(tick.value) + 4, tick.label);
    for (Axis::Tick const& tick : x_axis.ticks)
        svg += fmt::format(
            "<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/><text text-anchor=\"middle\" x=\"{0:.1f}\" "
            "y=\"{3}\">{4}</text>\n",
            at_x(tick.value), top, height - bottom, height - bottom + 18, tick.label);
    svg += fmt::format("<line class=\"axis\" x1=\"{0}\" x2=\"{1}\" y1=\"{2}\" y2=\"{2}\"/>\n", left, left + inner_width, height - bottom);
    svg += fmt::format("<text text-anchor=\"middle\" x=\"{}\" y=\"{}\">{}</text><text x=\"4\" y=\"32\">{}</text>\n", left + inner_width / 2,
                       height - 6, escaped(family.x_label), escaped(family.y_label));
    for (std::size_t i = 0; i < family.curves.size(); ++i) {
        NamedCurve const& curve = family.curves[i];
        std::string const style =
            fmt::format("stroke=\"{}\"{}", colours[i % std::size(colours)], curve.dashed ? " stroke-dasharray=\"5 4\"" : "");
        std::string dots;
        svg += "<polyline " + style + " points=\"";
        for (std::size_t k = 0; k < curve.x.size(); ++k) {
            if (!drawn(curve.x[k], curve.y[k])) continue;
            if (curve.joined) svg += fmt::format("{:.1f},{:.1f} ", at_x(curve.x[k]), at_y(curve.y[k]));
            if (curve.marked)
                dots += fmt::format("<circle fill=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\"/>", colours[i % std::size(colours)],
                                    at_x(curve.x[k]), at_y(curve.y[k]));
        }
        double const y = top + 8 + line_height * static_cast<double>(i), x = left + inner_width + 12;
        svg += fmt::format("\"/><line {} stroke-width=\"1.8\" x1=\"{}\" x2=\"{}\" y1=\"{}\" y2=\"{}\"/><text x=\"{}\" y=\"{}\">{}</text>\n",
                           style, x, x + 22, y, y, x + 28, y + 4, escaped(curve.name));
        svg += dots + (dots.empty() ? "" : "\n");
    }
    return svg + "</svg>\n";
}

}  // namespace catena
