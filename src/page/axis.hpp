// A drawn axis: which numbers get a tick, and how they are written.
#pragma once

#include <string>
#include <vector>

namespace catena {

struct Axis {
    struct Tick {
        double value;
        std::string label;
    };
    double low = 0, high = 1;  // what is drawn, in value or, if logarithmic, in log10
    bool logarithmic = false;
    std::vector<Tick> ticks;
    std::string note;  // "x 10^-6", "+ 1234.5": what was taken out of the labels; may be empty

    /// 0 at `low`, 1 at `high`.
    double place(double value) const;
};

/// `low` <= `high`, finite. `margin`: how far the drawn range goes beyond, relative to high - low.
Axis linear_axis(double low, double high, double margin, int ticks);
/// 0 < `low` <= `high`.
Axis logarithmic_axis(double low, double high);

}  // namespace catena
