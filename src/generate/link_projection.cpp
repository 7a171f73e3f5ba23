// Implements the projection by a tridiagonal solver (Thomas algorithm), bordered for rings,
// and by 3 x 3 blocks for trees.
#include "generate/link_projection.hpp"

#include <Eigen/Cholesky>
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

/// Solves a symmetric positive definite system.
Vec3 solved(Mat3 const& a, Vec3 const& right) {
    Eigen::Matrix3d matrix;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) matrix(i, j) = a(i, j);
    Eigen::Vector3d const x = matrix.llt().solve(Eigen::Vector3d(right[0], right[1], right[2]));
    return {{x[0], x[1], x[2]}};
}

void shift(LinkedUnits const& units, std::size_t k, double lambda, Vec3 const& along) {
    if (double const mobility = mobility_of(units, k); mobility > 0)
        units.at[k] = plus_scaled(units.at[k], mobility * lambda, along);
}

}  // namespace

std::vector<std::int64_t> unit_parents(Parents parents, Base base) {
    std::vector<std::int64_t> units(parents.begin(), parents.end());
    if (units.empty() || base == Base::free) return units;
    for (std::int64_t& parent : units) ++parent;
    units.insert(units.begin(), -1);
    return units;
}

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
    if (!units.parent.empty()) return eliminate_tree(units);
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
    if (!units.parent.empty()) return substitute_tree(units);
    std::size_t const n = units.at.size();
    if (units.closing > 0) close(units);
    for (std::size_t k = n - 1; k >= 1; --k) {
        if (units.closing == 0 && k + 1 < n)
            lambda_[k] -= beside(units, k, along_[k], along_[k + 1]) * factor_[k] * lambda_[k + 1];
        shift(units, k - 1, lambda_[k], along_[k]);
        shift(units, k, -lambda_[k], along_[k]);
    }
}

/// Eliminates a tree from its ends on. The displacement d of a unit under the force lambda u of its
/// link obeys W d = lambda u + pull. Returns false if no link needs a correction.
bool LinkProjection::eliminate_tree(LinkedUnits const& units) {
    std::size_t const n = units.at.size();
    along_.resize(n), factor_.resize(n), lambda_.resize(n);
    weight_.assign(n, Mat3::zero()), pull_.assign(n, Vec3::zero());
    for (std::size_t k = 0; k < n; ++k)
        for (int i = 0; i < 3 && mobility_of(units, k) > 0; ++i)
            weight_[k](i, i) = 1 / mobility_of(units, k);
    bool wrong = false;
    for (std::size_t k = n - 1; k >= 1; --k) {
        auto const p = static_cast<std::size_t>(units.parent[k]);
        Link const link = link_between(units, p, k, units.length[k]);
        wrong = wrong || link.wrong;
        Vec3 const &u = along_[k] = link.along, softness = solved(weight_[k], u);
        factor_[k] = 1 / dot(u, softness);
        lambda_[k] = link.error + dot(softness, pull_[k]);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) weight_[p](i, j) += factor_[k] * u[i] * u[j];
        pull_[p] = plus_scaled(pull_[p], factor_[k] * lambda_[k], u);
    }
    return wrong;
}

/// Displaces the units of a tree, from the first one on.
void LinkProjection::substitute_tree(LinkedUnits const& units) {
    std::vector<Vec3> by(units.at.size(), Vec3::zero());
    if (mobility_of(units, 0) > 0) by[0] = solved(weight_[0], pull_[0]);
    for (std::size_t k = 1; k < by.size(); ++k) {
        double const along = dot(along_[k], by[static_cast<std::size_t>(units.parent[k])]);
        by[k] =
            solved(weight_[k], plus_scaled(pull_[k], factor_[k] * (along - lambda_[k]), along_[k]));
    }
    for (std::size_t k = 0; k < by.size(); ++k) units.at[k] = units.at[k] + by[k];
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
