// Fits to mean curves: scaling exponent, persistence length, diffusion, interfaces of a slab.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/estimate.hpp"

namespace catena::analysis {

/// Straight line through points by least squares. Slope and intercept are weighted sums of y.
struct Line {
    double slope = NAN, intercept = NAN;
    std::vector<double> weights;  // slope = sum weights y
};
Line fit_line(std::span<double const> x, std::span<double const> y);

/// Range of a fit, both ends included.
struct Range {
    double least = 0, most = 0;
    bool holds(double x) const { return x >= least && x <= most; }
};

/// A number fitted to a curve, with errors to first order.
struct Fitted {
    Estimate value;
    Range range;      // range of the points that the fit used
    std::string why;  // reason if there is no value, else empty
};

/// Scaling exponent nu and prefactor of R(s) = sqrt(<r^2>) = R_0 s^nu.
struct Scaling {
    Fitted exponent;
    double prefactor = NAN;  // R_0
};
/// Fits a straight line to ln R against ln s by least squares. Every separation in `range` has the
/// same weight. `squares`: mean squared distances at `separations`.
Scaling fit_scaling(std::vector<std::int64_t> const& separations, CurveMeans const& squares,
                    Range const& range);

/// Fits the persistence length l of <u_i . u_i+s> = exp(-s b / l), b the mean bond length. The
/// logarithms of the cosines are fitted through the origin, from separation 1 to the last one
/// before the cosine falls below 1/e, and at least separation 1. There is no value if the first
/// cosine is not above its error.
Fitted fit_persistence(std::vector<std::int64_t> const& separations, CurveMeans const& cosines,
                       double bond_length);

/// Density profile of a slab around z = 0: dilute + (dense - dilute)/2 (1 - tanh((|z| - z0) / w)).
struct Interfaces {
    double position = NAN, width = NAN;  // z0, w
    double dense = NAN, dilute = NAN;
};
/// Fits z0, w and both densities by least squares. `z`: distances from the slab's middle, ascending
/// from 0; `half`: half an edge of the box.
Interfaces fit_interfaces(std::span<double const> z, std::span<double const> density, double half);

}  // namespace catena::analysis
