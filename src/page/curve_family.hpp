// Several curves in one picture, both axes logarithmic, as an SVG file of its own.
#pragma once

#include <string>
#include <vector>

namespace catena {

struct NamedCurve {
    std::string name;
    std::vector<double> x,
        y;  // of one length; what is not positive is a gap, NaN a gap with a cross on the axis
    bool dashed = false;
    bool marked = false;  // every point by a mark of the curve's own shape
    bool joined = true;   // points by lines
};
struct CurveFamily {
    std::string title, x_label, y_label;
    std::vector<NamedCurve> curves;
};
std::string curve_family(CurveFamily const&);

}  // namespace catena
