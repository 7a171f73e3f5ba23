// Interpolation of quantities that were measured at a few numbers of bodies.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

namespace catena::plan {

/// N times as functions of the number of bodies. Between measured numbers the logarithm of the time
/// is linear in the logarithm of the number. Outside the measured range the time is linear, with
/// the cost per body of the nearest interval.
template <std::size_t N>
class Curve {
  public:
    using Values = std::array<double, N>;

    /// Adds the N times, in seconds, measured at this number of bodies.
    void add(std::int64_t bodies, Values const& seconds) { points_[bodies] = seconds; }
    bool has(std::int64_t bodies) const { return points_.contains(bodies); }
    std::map<std::int64_t, Values> const& points() const { return points_; }

    /// Returns the interpolated times, in seconds. Precondition: at least one point.
    Values at(std::int64_t bodies) const {
        if (points_.size() == 1) return on_line(bodies, points_.begin(), points_.begin());
        auto const above = points_.lower_bound(bodies);
        if (above == points_.begin()) return on_line(bodies, above, std::next(above));
        auto const below = std::prev(above);
        if (above == points_.end()) return on_line(bodies, below, std::prev(below));
        double const share =
            std::log(ratio(bodies, below->first)) / std::log(ratio(above->first, below->first));
        Values seconds;
        for (std::size_t i = 0; i < N; ++i) {
            double const low = std::max(below->second[i], least),
                         high = std::max(above->second[i], least);
            seconds[i] = low * std::pow(high / low, share);
        }
        return seconds;
    }

  private:
    /// Smallest time in seconds that a clock can tell from zero.
    static constexpr double least = 1e-12;
    static double ratio(std::int64_t a, std::int64_t b) {
        return static_cast<double>(a) / static_cast<double>(b);
    }
    using Point = typename std::map<std::int64_t, Values>::const_iterator;
    /// Extrapolates from `near` with the slope between `near` and `far`. The slope is never
    /// negative, and the time of no bodies never below zero.
    Values on_line(std::int64_t bodies, Point near, Point far) const {
        Values seconds;
        auto const steps = static_cast<double>(bodies - near->first);
        for (std::size_t i = 0; i < N; ++i) {
            double const proportional = near->second[i] / static_cast<double>(near->first);
            double const slope = near == far ? proportional
                                             : (far->second[i] - near->second[i]) /
                                                   static_cast<double>(far->first - near->first);
            seconds[i] = near->second[i] +
                         steps * std::max(0.0, steps < 0 ? std::min(slope, proportional) : slope);
        }
        return seconds;
    }

    std::map<std::int64_t, Values> points_;
};

}  // namespace catena::plan
