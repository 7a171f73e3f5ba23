// Implements mean squared displacements.
#include "analysis/displacement.hpp"

#include <algorithm>
#include <cmath>

namespace catena::analysis {
namespace {

constexpr double least_lag = 0.05, most_lag = 0.25;  // fitted lags, parts of the whole time
constexpr std::size_t fewest_lags = 3;

/// Centres of mass, and squared displacements between frames.
struct Centres {
    std::span<Vec3 const> x;  // [frame][copy]
    std::size_t copies;

    std::size_t frames() const { return x.size() / copies; }
    double square(std::size_t from, std::size_t lag, std::size_t copy) const {
        Vec3 const d = x[(from + lag) * copies + copy] - x[from * copies + copy];
        return dot(d, d);
    }
    /// Mean over copies, for every starting frame that `longest` frames follow.
    std::vector<double> series(std::size_t lag, std::size_t longest) const {
        std::vector<double> values(frames() - longest, 0.0);
        for (std::size_t f = 0; f < values.size(); ++f)
            for (std::size_t c = 0; c < copies; ++c)
                values[f] += square(f, lag, c) / static_cast<double>(copies);
        return values;
    }
    /// Mean over starting frames of one copy.
    double mean(std::size_t lag, std::size_t copy) const {
        double sum = 0;
        for (std::size_t f = 0; f + lag < frames(); ++f) sum += square(f, lag, copy);
        return sum / static_cast<double>(frames() - lag);
    }
};

/// Fits the diffusion constant to lags in frames, with their mean squares over copies.
Fitted fit_diffusion(Centres const& centres, std::vector<std::size_t> const& lags,
                     std::vector<double> const& squares, double interval) {
    Fitted fitted;
    double const whole = static_cast<double>(centres.frames() - 1);
    Range const range{least_lag * whole, most_lag * whole};
    std::vector<std::size_t> used;
    std::vector<double> x, y;
    for (std::size_t k = 0; k < lags.size(); ++k)
        if (range.holds(static_cast<double>(lags[k]))) {
            used.push_back(lags[k]);
            x.push_back(interval * static_cast<double>(lags[k]));
            y.push_back(squares[k]);
        }
    if (used.size() < fewest_lags) {
        fitted.why = "there are too few frames";
        return fitted;
    }
    Line const line = fit_line(x, y);
    std::vector<double> of_start(centres.frames() - used.back(), 0.0), of_copy;
    for (std::size_t k = 0; k < used.size(); ++k) {
        std::vector<double> const series = centres.series(used[k], used.back());
        for (std::size_t f = 0; f < of_start.size(); ++f)
            of_start[f] += line.weights[k] * series[f] / 6;
    }
    for (std::size_t c = 0; c < centres.copies; ++c) {
        double slope = 0;
        for (std::size_t k = 0; k < used.size(); ++k)
            slope += line.weights[k] * centres.mean(used[k], c);
        of_copy.push_back(slope / 6);
    }
    Blocked const error = blocked_mean({of_start});
    fitted.range = {x.front(), x.back()};
    fitted.value = {line.slope / 6, error.error, error.plateau, error_between(of_copy)};
    return fitted;
}

}  // namespace

Displacements displacements_of(std::span<Vec3 const> centres, std::size_t copies, double interval) {
    Centres const all{centres, copies};
    Displacements found;
    std::vector<std::size_t> lags;
    std::vector<double> squares;
    for (std::int64_t const lag : spaced_numbers(static_cast<std::int64_t>(all.frames() / 2))) {
        lags.push_back(static_cast<std::size_t>(lag));
        Blocked const mean = blocked_mean({all.series(lags.back(), lags.back())});
        std::vector<double> of_copy(copies);
        for (std::size_t c = 0; c < copies; ++c) of_copy[c] = all.mean(lags.back(), c);
        found.lag.push_back(interval * static_cast<double>(lag));
        found.square.push_back({mean.mean, mean.error, mean.plateau, error_between(of_copy)});
        squares.push_back(mean.mean);
    }
    if (all.frames() < 2)
        found.diffusion.why = "there is one frame only";
    else
        found.diffusion = fit_diffusion(all, lags, squares, interval);
    return found;
}

}  // namespace catena::analysis
