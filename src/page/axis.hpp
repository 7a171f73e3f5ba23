// Axes of drawings: range, ticks and the labels of the ticks.
#pragma once

#include <string>
#include <vector>

namespace catena {

/// Linear or logarithmic axis of a chart.
struct Axis {
    /// Tick at a value, with its text. Labels are relative to `note`.
    struct Tick {
        double value;
        std::string label;
    };
    double low = 0, high = 1;  // drawn range: values, or log10 of values if logarithmic
    bool logarithmic = false;
    std::vector<Tick> ticks;
    std::string
        note;  // common factor and offset of the labels, e.g. "x 10^-6", "+ 1234.5"; may be empty

    /// Relative position of a value: 0 at `low`, 1 at `high`.
    double place(double value) const;
};

/// Linear axis from `low` to `high`, both finite and `low` <= `high`. The drawn range extends by
/// `margin` * (high - low) beyond both ends. `ticks`: their approximate number.
Axis linear_axis(double low, double high, double margin, int ticks);
/// Logarithmic axis of whole decades, at least one. Precondition: 0 < `low` <= `high`.
Axis logarithmic_axis(double low, double high);

}  // namespace catena
