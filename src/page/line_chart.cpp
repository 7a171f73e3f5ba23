// Implements the line chart of one curve.
#include "page/line_chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "page/axis.hpp"
#include "page/html.hpp"

namespace catena {
namespace {

constexpr std::size_t most_buckets = 1000;  // limits a curve to twice as many points
// Sizes in pixels: picture and margins around the curve.
constexpr double width = 640, height = 280, left = 66, right = 14, top = 24, bottom = 42;
constexpr double inner_width = width - left - right, inner_height = height - top - bottom;
constexpr double decades_for_logarithm = 1e3;  // largest ratio of values on a linear axis

using Points = std::vector<std::pair<double, double>>;

/// Axes of a chart, which map values to pixels.
struct Drawing {
    Axis x, y;
    double at_x(double value) const { return left + inner_width * x.place(value); }
    double at_y(double value) const { return top + inner_height * (1 - y.place(value)); }
};

/// Points of which both coordinates are finite.
Points finite_points(Curve const& curve) {
    Points points;
    for (std::size_t k = 0; k < std::min(curve.x.size(), curve.y.size()); ++k)
        if (std::isfinite(curve.x[k]) && std::isfinite(curve.y[k]))
            points.emplace_back(curve.x[k], curve.y[k]);
    return points;
}

/// Axis that covers the values. It is logarithmic if they are positive and span more than three
/// decades.
Axis axis_of_values(Points const& points) {
    auto const [low, high] =
        std::minmax_element(points.begin(), points.end(),
                            [](auto const& a, auto const& b) { return a.second < b.second; });
    bool const logarithmic = low->second > 0 && high->second > decades_for_logarithm * low->second;
    return logarithmic ? logarithmic_axis(low->second, high->second)
                       : linear_axis(low->second, high->second, 0.06, 6);
}

/// Ticks, grid lines and labels of both axes.
std::string axes(Drawing const& drawing, Curve const& curve) {
    std::string svg;
    for (Axis::Tick const& tick : drawing.y.ticks) {
        double const y = drawing.at_y(tick.value);
        svg += fmt::format("<line class=\"grid\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>",
                           left, width - right, y, y);
        svg += fmt::format("<text class=\"end\" x=\"{}\" y=\"{:.1f}\">{}</text>\n", left - 8, y + 4,
                           tick.label);
    }
    double const base = height - bottom;
    svg += fmt::format("<line class=\"axis\" x1=\"{}\" x2=\"{}\" y1=\"{}\" y2=\"{}\"/>", left,
                       width - right, base, base);
    for (Axis::Tick const& tick : drawing.x.ticks) {
        double const x = drawing.at_x(tick.value);
        svg += fmt::format("<line class=\"axis\" x1=\"{:.1f}\" x2=\"{:.1f}\" y1=\"{}\" y2=\"{}\"/>",
                           x, x, base, base + 5);
        svg += fmt::format("<text class=\"middle\" x=\"{:.1f}\" y=\"{}\">{}</text>\n", x, base + 18,
                           tick.label);
    }
    std::string const x_note = drawing.x.note.empty() ? "" : " (" + drawing.x.note + ")";
    std::string const y_note = drawing.y.note.empty() ? "" : "  " + drawing.y.note;
    svg += fmt::format("<text class=\"middle\" x=\"{}\" y=\"{}\">{}</text>\n",
                       left + inner_width / 2, height - 6, escaped(curve.x_label + x_note));
    svg += fmt::format("<text x=\"{}\" y=\"14\">{}</text>\n", 4, escaped(curve.y_label + y_note));
    return svg;
}

/// Arithmetic mean of the y values from `from` on; NaN if there are none.
double mean_of(Points const& points, double from) {
    double sum = 0, count = 0;
    for (auto const& [x, y] : points)
        if (x >= from) sum += y, ++count;
    return sum / count;
}

/// Shaded range of the points that do not count; empty if all count.
std::string shade(Drawing const& drawing, double counts_from) {
    if (!(counts_from > drawing.x.low)) return "";
    double const end = drawing.at_x(std::min(counts_from, drawing.x.high));
    return fmt::format("<rect class=\"shade\" x=\"{}\" y=\"{}\" width=\"{:.1f}\" height=\"{}\"/>\n",
                       left, top, end - left, inner_height);
}

}  // namespace

/// A bucket may contribute a single point, if all of its values are equal.
Points thinned(Points const& points, std::size_t buckets) {
    if (points.size() <= 2 * buckets) return points;
    Points kept;
    for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
        auto const begin =
            // A bucket holds consecutive points, as many as the others up to one.
            points.begin() + static_cast<std::ptrdiff_t>(bucket * points.size() / buckets);
        auto const end =
            points.begin() + static_cast<std::ptrdiff_t>((bucket + 1) * points.size() / buckets);
        auto const [low, high] = std::minmax_element(
            begin, end, [](auto const& a, auto const& b) { return a.second < b.second; });
        kept.push_back(std::min(low, high)[0]);
        if (low != high) kept.push_back(std::max(low, high)[0]);
    }
    return kept;
}

/// A curve without finite values becomes a sentence.
std::string line_chart(Curve const& curve) {
    Points const points = finite_points(curve);
    if (points.empty()) return "<p>No finite values.</p>\n";
    // The x axis has no margin, since its values ascend.
    Drawing const drawing{linear_axis(points.front().first,
                                      std::max(points.front().first, points.back().first), 0, 7),
                          axis_of_values(points)};
    std::string svg =
        fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{} against {}\">\n",
                    width, height, escaped(curve.y_label), escaped(curve.x_label));
    svg += shade(drawing, curve.counts_from) + axes(drawing, curve);
    // A dotted line marks the mean on linear axes.
    double const mean = mean_of(points, curve.counts_from);
    if (!drawing.y.logarithmic && std::isfinite(mean)) {
        double const y = drawing.at_y(mean);
        svg +=
            fmt::format("<line class=\"mean\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>\n",
                        left, width - right, y, y);
    }
    svg += "<polyline class=\"curve\" points=\"";
    for (auto const& [x, y] : thinned(points, most_buckets))
        svg += fmt::format("{:.1f},{:.1f} ", drawing.at_x(x), drawing.at_y(y));
    svg += "\"/>\n";
    // A single point would be an invisible line.
    if (points.size() == 1)
        svg += fmt::format("<circle class=\"c0\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\"/>\n",
                           drawing.at_x(points[0].first), drawing.at_y(points[0].second));
    return svg + "</svg>\n";
}

}  // namespace catena
