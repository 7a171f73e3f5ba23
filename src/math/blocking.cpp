// Means and standard errors by blocking.
#include "math/blocking.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace catena {
namespace {

constexpr std::int64_t fewest_blocks = 16;  // their scatter is known to a fifth

/// Number of samples per copy.
std::int64_t length_of(CopySeries const& series) {
    return series.empty() ? 0 : std::ssize(series.front());
}

double mean_of(CopySeries const& series) {
    double sum = 0;
    for (auto const& copy : series)
        for (double const value : copy) sum += value;
    return sum / static_cast<double>(std::ssize(series) * length_of(series));
}

/// Returns the standard error for one block length; NaN if there are fewer than two blocks. Samples
/// at a series' end that do not fill a block are left out. They are then treated as statistically
/// equal to the others.
double error_with(CopySeries const& series, std::int64_t block, double mean) {
    std::int64_t const of_copy = length_of(series) / block;
    double sum = 0;
    for (auto const& copy : series)
        for (std::int64_t b = 0; b < of_copy; ++b) {
            double inside = 0;
            for (std::int64_t i = b * block; i < (b + 1) * block; ++i)
                inside += copy[static_cast<std::size_t>(i)] - mean;
            sum += std::pow(inside / static_cast<double>(block), 2);
        }
    auto const blocks = static_cast<double>(of_copy * std::ssize(series));
    double const filled =
        static_cast<double>(of_copy * block) / static_cast<double>(length_of(series));
    return blocks < 2 ? std::numeric_limits<double>::quiet_NaN()
                      : std::sqrt(filled * sum / (blocks * (blocks - 1)));
}

}  // namespace

Blocked blocked_mean(CopySeries const& series) {
    std::int64_t const length = length_of(series);
    if (length == 0) return {};
    Blocked found{mean_of(series)};
    double const single = error_with(series, 1, found.mean),
                 samples = static_cast<double>(length * std::ssize(series));
    if (single == 0) return {found.mean, 0, 1, true};
    for (std::int64_t block = 1;; block = std::min(2 * block, length)) {
        double const error = error_with(series, block, found.mean);
        if (!(error <= found.error) && std::isfinite(error)) {
            found.error = error;
            found.block = block;
        }
        bool const many = length / block * std::ssize(series) >= fewest_blocks;
        if (many &&
            std::pow(static_cast<double>(block), 3) > 2 * samples * std::pow(error / single, 4))
            return {found.mean, found.error, found.block, true};
        if (block == length) {
            found.plateau = std::ssize(series) >= fewest_blocks;
            return found;
        }
    }
}

Blocked blocked_ratio(CopySeries const& above, CopySeries const& below) {
    double const scale = mean_of(below), ratio = mean_of(above) / scale;
    CopySeries rest = above;
    for (std::size_t c = 0; c < rest.size(); ++c)
        for (std::size_t i = 0; i < rest[c].size(); ++i)
            rest[c][i] = (above[c][i] - ratio * below[c][i]) / scale;
    Blocked found = blocked_mean(rest);
    found.mean = ratio;
    return found;
}

}  // namespace catena
