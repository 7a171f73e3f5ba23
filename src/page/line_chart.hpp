// One curve as inline SVG.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace catena {

struct Curve {
    std::string x_label, y_label;
    std::vector<double> x, y;  // of one length, x ascending; what is not finite is left out
};

/// Ticks at round numbers; a common power of ten or a large offset stands once, above the axis.
/// Logarithmic where all values are positive and span more than three decades.
std::string line_chart(Curve const&);

/// At most 2 * `buckets` points: of each run of points the lowest and the highest, in their order,
/// so that no spike is lost.
std::vector<std::pair<double, double>> thinned(std::vector<std::pair<double, double>> const& points,
                                               std::size_t buckets);

}  // namespace catena
