// Implements the choice of ticks and of their labels.
#include "page/axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "page/html.hpp"

namespace catena {
namespace {

constexpr double label_digits = 1e5;  // labels that would need more digits than this get an offset

/// Smallest step of 1, 2 or 5 times a power of ten that needs at most `ticks` steps for the range.
double round_step(double range, int ticks) {
    double const raw = range / ticks, power = std::pow(10.0, std::floor(std::log10(raw)));
    for (double const factor : {1.0, 2.0, 5.0})
        if (raw <= factor * power * 1.0000001) return factor * power;
    return 10 * power;
}

/// Text of 10^exponent with superscript digits.
std::string power_of_ten(int exponent) {
    if (exponent == 0) return "1";
    std::string text = "10";
    for (char const c : std::to_string(exponent)) {
        static constexpr char const* superscript[] = {"⁰", "¹", "²", "³", "⁴",
                                                      "⁵", "⁶", "⁷", "⁸", "⁹"};
        text += c == '-' ? "⁻" : superscript[c - '0'];
    }
    return text;
}

/// Writes the labels of a linear axis. A common power of ten and a large offset move to the axis's
/// note.
void write_labels(Axis& axis, double step) {
    // Labels that share many leading digits are relative to the first tick.
    double const largest =
        std::max(std::abs(axis.ticks.front().value), std::abs(axis.ticks.back().value));
    double const offset = largest > label_digits * step ? axis.ticks.front().value : 0;
    // Labels from 10^-2 to 10^4 are written without a common power of ten.
    double const shown = offset == 0 ? largest : axis.ticks.back().value - offset;
    int exponent = shown > 0 ? static_cast<int>(std::floor(std::log10(shown) + 1e-9)) : 0;
    if (exponent < 5 && exponent > -3) exponent = 0;
    double const unit = std::pow(10.0, exponent);
    int const decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step / unit) + 1e-9)));
    for (Axis::Tick& tick : axis.ticks) {
        double const value = (tick.value - offset) / unit;
        tick.label = fmt::format(
            "{:.{}f}", std::abs(value) < 0.5 * std::pow(10.0, -decimals) ? 0.0 : value, decimals);
    }
    if (exponent != 0) axis.note = "× " + power_of_ten(exponent);
    if (offset != 0)
        axis.note += fmt::format(" {} {:.10g}", offset < 0 ? "−" : "+", std::abs(offset));
}

}  // namespace

double Axis::place(double value) const {
    return ((logarithmic ? std::log10(value) : value) - low) / (high - low);
}

// Ticks are the multiples of the step within the range.
Axis linear_axis(double low, double high, double margin, int ticks) {
    // A range without extent is widened, so that the axis has a scale.
    double const smallest = std::max(1e-12 * std::max(std::abs(low), std::abs(high)), 1e-300);
    if (high - low < smallest) {
        double const widen = low == 0 ? 1 : std::max(0.05 * std::abs(low), smallest);
        low -= widen;
        high += widen;
    }
    Axis axis;
    axis.low = low - margin * (high - low);
    axis.high = high + margin * (high - low);
    double const step = round_step(axis.high - axis.low, ticks);
    auto const first = static_cast<std::int64_t>(std::ceil(axis.low / step - 1e-9));
    auto const last = static_cast<std::int64_t>(std::floor(axis.high / step + 1e-9));
    for (std::int64_t k = first; k <= last; ++k)
        axis.ticks.push_back({static_cast<double>(k) * step, ""});
    if (!axis.ticks.empty()) write_labels(axis, step);
    return axis;
}

// Ranges of seven decades and more have ticks every second, third, ... decade.
Axis logarithmic_axis(double low, double high) {
    Axis axis;
    axis.logarithmic = true;
    axis.low = std::floor(std::log10(low));
    axis.high = std::max(axis.low + 1, std::ceil(std::log10(high)));
    int const each = 1 + static_cast<int>((axis.high - axis.low) / 7);
    for (int power = static_cast<int>(axis.low); power <= static_cast<int>(axis.high);
         power += each)
        axis.ticks.push_back({std::pow(10.0, power), power_of_ten(power)});
    return axis;
}

}  // namespace catena
