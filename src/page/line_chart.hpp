// Line chart of one curve as inline SVG.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace catena {

/// Curve of one observable with the labels of its axes.
struct Curve {
    std::string x_label, y_label;
    std::vector<double> x, y;  // equal lengths, x ascending; points that are not finite are omitted
    double counts_from = -INFINITY;  // the mean is that of the points from this x on; the range
                                     // before it is shaded
};

/// Returns the chart. Ticks are round numbers; a common power of ten or a large offset is written
/// once, above the axis. The y axis is logarithmic if all values are positive and span more than
/// three decades.
std::string line_chart(Curve const&);

/// Reduces a curve to at most 2 * `buckets` points. Each bucket of consecutive points keeps its
/// lowest and its highest point in their order, so that no spike is lost.
std::vector<std::pair<double, double>> thinned(std::vector<std::pair<double, double>> const& points,
                                               std::size_t buckets);

}  // namespace catena
