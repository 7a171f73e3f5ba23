// Implements the fits to mean curves.
#include "analysis/fits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace catena::analysis {
namespace {

constexpr std::size_t fewest_separations = 3;  // for a scaling exponent

/// Returns the fitted number of every copy, or nothing if one of them is not finite.
template <class Fit>
double between_copies(CurveMeans const& curve, Fit const& fit) {
    std::vector<double> values;
    for (std::size_t c = 0; c < curve.copies(); ++c) values.push_back(fit(curve.of_copy(c)));
    return error_between(values);
}

/// 1 / l of cosines at separations times bond length, fitted through the origin.
double decay_rate(std::span<double const> distance, std::span<double const> cosines) {
    double above = 0, below = 0;
    for (std::size_t k = 0; k < distance.size(); ++k) {
        above -= std::log(cosines[k]) * distance[k];
        below += distance[k] * distance[k];
    }
    return above / below;
}

/// Number of separations that the persistence length is fitted to.
std::size_t fitted_cosines(std::span<double const> cosines) {
    std::size_t count = 1;
    while (count < cosines.size() && cosines[count] >= std::exp(-1.0)) ++count;
    return count;
}

/// Densities that fit best for given interfaces, and the sum of the squared deviations.
struct Trial {
    Interfaces found;
    double deviation;
};
Trial try_interfaces(std::span<double const> z, std::span<double const> density, double position,
                     double width) {
    double n = 0, g = 0, gg = 0, y = 0, gy = 0, yy = 0;
    for (std::size_t k = 0; k < z.size(); ++k) {
        double const inside = 0.5 * (1 - std::tanh((z[k] - position) / width));
        n += 1;
        g += inside;
        gg += inside * inside;
        y += density[k];
        gy += inside * density[k];
        yy += density[k] * density[k];
    }
    double const below = n * gg - g * g;
    if (!(below > 1e-12 * n * n)) return {{}, std::numeric_limits<double>::infinity()};
    double const slope = (n * gy - g * y) / below, dilute = (y - slope * g) / n;
    return {{position, width, dilute + slope, dilute}, yy - slope * gy - dilute * y};
}

}  // namespace

Line fit_line(std::span<double const> x, std::span<double const> y) {
    auto const count = static_cast<double>(x.size());
    double const mean_x = std::accumulate(x.begin(), x.end(), 0.0) / count,
                 mean_y = std::accumulate(y.begin(), y.end(), 0.0) / count;
    double squares = 0;
    for (double const value : x) squares += (value - mean_x) * (value - mean_x);
    Line line;
    line.slope = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        line.weights.push_back((x[k] - mean_x) / squares);
        line.slope += line.weights.back() * (y[k] - mean_y);
    }
    line.intercept = mean_y - line.slope * mean_x;
    return line;
}

Scaling fit_scaling(std::vector<std::int64_t> const& separations, CurveMeans const& squares,
                    Range const& range) {
    std::vector<double> x;
    std::vector<std::size_t> used;
    for (std::size_t k = 0; k < separations.size(); ++k)
        if (range.holds(static_cast<double>(separations[k]))) {
            used.push_back(k);
            x.push_back(std::log(static_cast<double>(separations[k])));
        }
    Scaling scaling;
    if (used.size() < fewest_separations) {
        scaling.exponent.why = fmt::format("there are fewer than {} separations from {:g} to {:g}",
                                           fewest_separations, range.least, range.most);
        return scaling;
    }
    auto const line_of = [&](std::vector<double> const& means) {
        std::vector<double> y;
        for (std::size_t const k : used) y.push_back(0.5 * std::log(means[k]));
        return fit_line(x, y);
    };
    std::vector<double> const means = squares.blocks().means();
    Line const line = line_of(means);
    std::vector<double> weights(means.size(), 0.0);
    for (std::size_t i = 0; i < used.size(); ++i)
        weights[used[i]] = 0.5 * line.weights[i] / means[used[i]];
    Blocked const error = squares.blocks().error_of(weights);
    scaling.exponent.range = {static_cast<double>(separations[used.front()]),
                              static_cast<double>(separations[used.back()])};
    scaling.exponent.value = {
        line.slope, error.error, error.plateau,
        between_copies(squares, [&](auto const& of_copy) { return line_of(of_copy).slope; })};
    scaling.prefactor = std::exp(line.intercept);
    return scaling;
}

Fitted fit_persistence(std::vector<std::int64_t> const& separations, CurveMeans const& cosines,
                       double bond_length) {
    Fitted fitted;
    if (separations.empty()) {
        fitted.why = "the chain has fewer than two bonds";
        return fitted;
    }
    Estimate const first = cosines.at(0);
    if (!(first.mean > 0) || first.mean <= 2 * first.error) {
        fitted.why = "the first cosine is not above twice its error: bonds are not correlated";
        return fitted;
    }
    std::vector<double> const means = cosines.blocks().means();
    std::size_t const used = fitted_cosines(means);
    std::vector<double> distance;
    for (std::size_t k = 0; k < used; ++k)
        distance.push_back(bond_length * static_cast<double>(separations[k]));
    double const rate = decay_rate(distance, means);
    if (!(rate * distance.back() > 1e-12)) {
        fitted.why = "the chain is straight";
        return fitted;
    }
    double const below =
        std::inner_product(distance.begin(), distance.end(), distance.begin(), 0.0);
    std::vector<double> weights(means.size(), 0.0);
    for (std::size_t k = 0; k < used; ++k)
        weights[k] = distance[k] / (means[k] * below * rate * rate);
    Blocked const error = cosines.blocks().error_of(weights);
    fitted.range = {static_cast<double>(separations.front()),
                    static_cast<double>(separations[used - 1])};
    fitted.value = {1 / rate, error.error, error.plateau,
                    between_copies(cosines, [&](auto const& of_copy) {
                        return 1 / decay_rate(distance, of_copy);
                    })};
    return fitted;
}

Interfaces fit_interfaces(std::span<double const> z, std::span<double const> density, double half) {
    constexpr int points = 24, refinements = 10;
    double const bin = half / static_cast<double>(z.size());
    Range position{0, half}, width{std::log(0.25 * bin), std::log(0.5 * half)};
    Trial best{{}, std::numeric_limits<double>::infinity()};
    for (int refinement = 0; refinement < refinements; ++refinement) {
        for (int i = 0; i <= points; ++i)
            for (int j = 0; j <= points; ++j) {
                double const at = std::lerp(position.least, position.most, double(i) / points),
                             wide = std::lerp(width.least, width.most, double(j) / points);
                Trial const trial = try_interfaces(z, density, at, std::exp(wide));
                if (trial.deviation < best.deviation && trial.found.dense > trial.found.dilute)
                    best = trial;
            }
        if (!std::isfinite(best.deviation)) return {};
        double const shrunk = 0.15 * (position.most - position.least),
                     log_shrunk = 0.15 * (width.most - width.least),
                     middle = std::log(best.found.width);
        position = {std::max(0.0, best.found.position - shrunk),
                    std::min(half, best.found.position + shrunk)};
        width = {middle - log_shrunk, middle + log_shrunk};
    }
    return best.found;
}

}  // namespace catena::analysis
