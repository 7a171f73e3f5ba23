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

/// Ranges of the axes: they cover all drawn points, and the gaps along x.
struct Ranges {
    Range x, y;
    explicit Ranges(std::vector<NamedCurve> const& curves) {
        for (NamedCurve const& curve : curves)
            for (std::size_t i = 0; i < curve.x.size(); ++i)
                if (drawn(curve.x[i], curve.y[i]))
                    x.add(curve.x[i]), y.add(curve.y[i]);
                else if (std::isnan(curve.y[i]) && curve.x[i] > 0)
                    x.add(curve.x[i]);
    }
};

/// Beginning of the file, with the title.
std::string opening(std::string const& title) {
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
        "height=\"{1}\" role=\"img\">\n"
        "<style>text {{ fill: #1b2733; font: 12px system-ui, \"Segoe UI\", Roboto, Arial, "
        "sans-serif; }} .grid {{ stroke: #e9edf1; }} "
        ".axis {{ stroke: #9aa8b5; }} polyline {{ fill: none; stroke-width: 1.8; stroke-linejoin: "
        "round; }}</style>\n"
        "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n<text x=\"4\" y=\"14\" "
        "font-weight=\"600\">{2}</text>\n",
        width, height, escaped(title));
}

/// The axes, and what is drawn between them.
class Drawing {
  public:
    explicit Drawing(Ranges const& ranges)
        : x_axis_(logarithmic_axis(ranges.x.low, ranges.x.high)),
          y_axis_(logarithmic_axis(ranges.y.low, ranges.y.high)) {}

    /// Returns the grid lines and labels of both axes.
    std::string axes(CurveFamily const& family) const {
        std::string svg;
        for (Axis::Tick const& tick : y_axis_.ticks)
            svg += fmt::format(
                "<line class=\"grid\" x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/><text "
                "text-anchor=\"end\" x=\"{3}\" "
                "y=\"{4:.1f}\">{5}</text>\n",
                left, left + inner_width, at_y(tick.value), left - 8, at_y(tick.value) + 4,
                tick.label);
        for (Axis::Tick const& tick : x_axis_.ticks)
            svg += fmt::format(
                "<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/><text "
                "text-anchor=\"middle\" x=\"{0:.1f}\" "
                "y=\"{3}\">{4}</text>\n",
                at_x(tick.value), top, height - bottom, height - bottom + 18, tick.label);
        svg += fmt::format("<line class=\"axis\" x1=\"{0}\" x2=\"{1}\" y1=\"{2}\" y2=\"{2}\"/>\n",
                           left, left + inner_width, height - bottom);
        return svg + fmt::format(
                         "<text text-anchor=\"middle\" x=\"{}\" y=\"{}\">{}</text><text x=\"4\" "
                         "y=\"32\">{}</text>\n",
                         left + inner_width / 2, height - 6, escaped(family.x_label),
                         escaped(family.y_label));
    }
    /// Returns curve `i`: its lines, its line of the legend, and its marks on top.
    std::string curve(NamedCurve const& curve, std::size_t i) const {
        std::string const style = fmt::format("stroke=\"{}\"{}", colour_of(i),
                                              curve.dashed ? " stroke-dasharray=\"5 4\"" : "");
        std::string const dots = marks_of(curve, i);
        return lines_of(curve, style) + legend(curve, i, style) + dots + (dots.empty() ? "" : "\n");
    }

  private:
    double at_x(double x) const { return left + inner_width * x_axis_.place(x); }
    double at_y(double y) const { return top + inner_height * (1 - y_axis_.place(y)); }
    /// Returns the lines between points. A point that cannot be drawn interrupts them.
    std::string lines_of(NamedCurve const& curve, std::string const& style) const {
        std::string lines, line;
        auto const end_line = [&] {
            if (!line.empty()) lines += "<polyline " + style + " points=\"" + line + "\"/>";
            line.clear();
        };
        for (std::size_t k = 0; curve.joined && k < curve.x.size(); ++k)
            if (drawn(curve.x[k], curve.y[k]))
                line += fmt::format("{:.1f},{:.1f} ", at_x(curve.x[k]), at_y(curve.y[k]));
            else
                end_line();
        end_line();
        return lines;
    }
    /// Returns the marks of points, and crosses on the axis for gaps.
    std::string marks_of(NamedCurve const& curve, std::size_t i) const {
        std::string dots;
        for (std::size_t k = 0; k < curve.x.size(); ++k) {
            if (std::isnan(curve.y[k]) && curve.x[k] > 0) dots += gap_at(i, at_x(curve.x[k]));
            if (curve.marked && drawn(curve.x[k], curve.y[k]))
                dots += mark_at(i, at_x(curve.x[k]), at_y(curve.y[k]));
        }
        return dots;
    }
    /// Returns the line of the legend of curve `i`.
    static std::string legend(NamedCurve const& curve, std::size_t i, std::string const& style) {
        double const y = top + 8 + line_height * static_cast<double>(i),
                     x = left + inner_width + 12;
        std::string svg;
        if (curve.joined)
            svg += fmt::format(
                "<line {} stroke-width=\"1.8\" x1=\"{}\" x2=\"{}\" y1=\"{}\" y2=\"{}\"/>", style, x,
                x + 22, y, y);
        if (curve.marked) svg += mark_at(i, x + 11, y);
        return svg + fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n", x + 28, y + 4,
                                 escaped(curve.name));
    }
    Axis x_axis_, y_axis_;
};

}  // namespace

std::string curve_family(CurveFamily const& family) {
    std::string svg = opening(family.title);
    Ranges const ranges(family.curves);
    if (ranges.y.high == 0) return svg + "<text x=\"4\" y=\"40\">No values.</text></svg>\n";
    Drawing const drawing(ranges);
    svg += drawing.axes(family);
    for (std::size_t i = 0; i < family.curves.size(); ++i)
        svg += drawing.curve(family.curves[i], i);
    return svg + "</svg>\n";
}

}  // namespace catena
