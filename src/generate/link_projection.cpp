// Implements the projection by a tridiagonal solver (Thomas algorithm), bordered for rings.
#include "generate/link_projection.hpp"

#include <cmath>
#include <limits>

namespace catena::scene {

namespace {

int constexpr most_sweeps = 20;

double mobility_of(LinkedUnits const& units, std::size_t k) {
    return units.mobility.empty() ? 1 : units.mobility[k];
}

/// Off-diagonal entry of the system: minus the change of one link's length by the displacement of
/// the unit between two links, if the other link's lambda is 1.
double beside(LinkedUnits const& units, std::size_t between, Vec3 const& a, Vec3 const& b) {
    return -dot(a, b) * mobility_of(units, between);
}

void shift(LinkedUnits const& units, std::size_t k, double lambda, Vec3 const& along) {
    if (double const mobility = mobility_of(units, k); mobility > 0)
        units.at[k] = plus_scaled(units.at[k], mobility * lambda, along);
}

}  // namespace

bool LinkProjection::project(LinkedUnits const& units) {
    if (units.at.size() < 2) return true;
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
        bool const wrong = eliminate(units), open = is_open(units);
        if (!wrong && !open) return true;
        substitute(units);
    }
    return !eliminate(units) && !is_open(units);
}

LinkProjection::Link LinkProjection::link_between(LinkedUnits const& units, std::size_t from,
                                                  std::size_t to, double length) {
    Vec3 const start =
        units.outboard.empty() ? units.at[from] : units.at[from] + units.outboard[from];
    Vec3 const end = units.inboard.empty() ? units.at[to] : units.at[to] + units.inboard[to];
    Vec3 const link = end - start;
    double const distance = norm(link), error = distance - length;
    double const rounding = 4 * std::numeric_limits<double>::epsilon() * norm(start);
    // The negated form also reports values that are not finite.
    bool const wrong = !(std::abs(error) <= 1e-13 * length + rounding);
    return {distance > 0 ? (1 / distance) * link : Vec3{{1, 0, 0}}, error, wrong};
}

/// Computes the links' directions and errors and eliminates the system from its first row on.
/// Returns false if no link needs a correction.
bool LinkProjection::eliminate(LinkedUnits const& units) {
    std::size_t const n = units.at.size();
    along_.resize(n), factor_.resize(n), lambda_.resize(n);
    bool wrong = false;
    for (std::size_t k = 1; k < n; ++k) {
        Link const link = link_between(units, k - 1, k, units.length[k]);
        wrong = wrong || link.wrong;
        along_[k] = link.along;
        double const diagonal = mobility_of(units, k - 1) + mobility_of(units, k);
        if (k == 1) {
            factor_[k] = 1 / diagonal, lambda_[k] = factor_[k] * link.error;
            continue;
        }
        double const off = beside(units, k - 1, along_[k - 1], along_[k]),
                     pivot = 1 / (diagonal - off * off * factor_[k - 1]);
        lambda_[k] = (link.error - off * lambda_[k - 1]) * pivot;
        factor_[k] = pivot;
    }
    return wrong;
}

/// Back substitution from the last row on; displaces the units.
void LinkProjection::substitute(LinkedUnits const& units) {
    std::size_t const n = units.at.size();
    if (units.closing > 0) close(units);
    for (std::size_t k = n - 1; k >= 1; --k) {
        if (units.closing == 0 && k + 1 < n)
            lambda_[k] -= beside(units, k, along_[k], along_[k + 1]) * factor_[k] * lambda_[k + 1];
        shift(units, k - 1, lambda_[k], along_[k]);
        shift(units, k, -lambda_[k], along_[k]);
    }
}

/// True if the closing link of a ring has a length error.
bool LinkProjection::is_open(LinkedUnits const& units) {
    if (units.closing == 0) return false;
    closing_ = link_between(units, units.at.size() - 1, 0, units.closing);
    return closing_.wrong;
}

/// Solves the system bordered by the closing link. The other links' lambdas are those without the
/// closing link, less their response to its lambda.
void LinkProjection::close(LinkedUnits const& units) {
    std::size_t const n = units.at.size(), last = n - 1;
    double const at_first = beside(units, 0, closing_.along, along_[1]),
                 at_last = beside(units, last, along_[last], closing_.along);
    response_.assign(n, 0.0);
    response_[1] += at_first, response_[last] += at_last;
    response_[1] *= factor_[1];
    auto const off = [&](std::size_t k) { return beside(units, k, along_[k], along_[k + 1]); };
    for (std::size_t k = 2; k < n; ++k)
        response_[k] = (response_[k] - off(k - 1) * response_[k - 1]) * factor_[k];
    for (std::size_t k = n - 2; k >= 1; --k) {
        response_[k] -= off(k) * factor_[k] * response_[k + 1];
        lambda_[k] -= off(k) * factor_[k] * lambda_[k + 1];
    }
    double const diagonal = mobility_of(units, 0) + mobility_of(units, last);
    double const others = at_first * lambda_[1] + at_last * lambda_[last],
                 response = at_first * response_[1] + at_last * response_[last];
    double const lambda = (closing_.error - others) / (diagonal - response);
    for (std::size_t k = 1; k < n; ++k) lambda_[k] -= response_[k] * lambda;
    shift(units, last, lambda, closing_.along);
    shift(units, 0, -lambda, closing_.along);
}

}  // namespace catena::scene
