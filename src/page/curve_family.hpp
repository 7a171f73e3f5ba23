// Picture of several curves on two logarithmic axes, as an SVG file of its own.
#pragma once

#include <string>
#include <vector>

namespace catena {

/// Curve with the name that the legend shows.
struct NamedCurve {
    std::string name;
    std::vector<double> x,
        y;  // equal lengths; values that are not positive: gap; NaN: gap with a cross on the axis
    bool dashed = false;
    bool marked = false;  // points are drawn as marks, whose shape belongs to the curve
    bool joined = true;   // points are connected by lines
};
/// Curves of one picture with its title and the labels of its axes.
struct CurveFamily {
    std::string title, x_label, y_label;
    std::vector<NamedCurve> curves;
};
/// Returns the text of the SVG file. A picture without positive values says "No values."
std::string curve_family(CurveFamily const&);

}  // namespace catena
