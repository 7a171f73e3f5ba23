// Size and configurational temperature of one bead chain.
#include "measure/chain_sample.hpp"

#include <cmath>
#include <vector>

#include "observe/observables.hpp"

namespace catena {
namespace {

/// Matrix T of the n - 1 links of n beads: diagonal, and `beside[j]` = T_j-1,j (entry 0: unused).
struct Tridiagonal {
    std::vector<double> diagonal, beside;

    Tridiagonal(std::span<Vec3 const> e, std::span<double const> mass)
        : diagonal(e.size()), beside(e.size()) {
        for (std::size_t j = 0; j < e.size(); ++j) {
            diagonal[j] = 1 / mass[j] + 1 / mass[j + 1];
            if (j > 0) beside[j] = -dot(e[j - 1], e[j]) / mass[j];
        }
    }
    /// Returns the pivots of the elimination from the first link on.
    std::vector<double> pivots() const {
        std::vector<double> p = diagonal;
        for (std::size_t j = 1; j < p.size(); ++j) p[j] -= beside[j] * beside[j] / p[j - 1];
        return p;
    }
    /// Returns (T^-1)_j-1,j; entry 0 is unused.
    std::vector<double> inverse_beside() const {
        std::vector<double> const p = pivots();
        std::vector<double> inverse(p.size());
        double corner = 1 / p.back();  // (T^-1)_jj
        for (std::size_t j = p.size(); j-- > 1;) {
            double const step = beside[j] / p[j - 1];
            inverse[j] = -step * corner;
            corner = 1 / p[j - 1] + step * step * corner;
        }
        return inverse;
    }
};

/// Returns g_j of each bond, and a zero after the last one.
std::vector<double> slopes(std::span<Vec3 const> e, std::span<double const> mass,
                           BondMeasure measure) {
    std::vector<double> g(e.size() + 1, 0.0);  // one entry more than bonds
    if (measure == BondMeasure::flexible) return g;
    std::vector<double> const inverse = Tridiagonal(e, mass).inverse_beside();
    for (std::size_t j = 1; j < e.size(); ++j) g[j] = -inverse[j] / mass[j];
    return g;
}

}  // namespace

double half_log_det(std::span<Vec3 const> e, std::span<double const> mass) {
    double sum = 0;
    for (double const pivot : Tridiagonal(e, mass).pivots()) sum += 0.5 * std::log(pivot);
    return sum;
}

ChainSample sample_chain(std::span<Vec3 const> x, std::span<Vec3 const> force,
                         std::span<double const> mass, BondMeasure measure) {
    std::size_t const bonds = x.size() - 1;
    Shape shape;
    for (std::size_t k = 0; k < x.size(); ++k) shape.add(mass[k], x[k]);
    std::vector<Vec3> e(bonds);
    std::vector<double> length(bonds);
    for (std::size_t j = 0; j < bonds; ++j) {
        Vec3 const b = x[j + 1] - x[j];
        length[j] = norm(b);
        e[j] = (1 / length[j]) * b;
    }
    std::vector<double> const g = slopes(e, mass, measure);

    ChainSample s{shape.radius_of_gyration(), shape.end_to_end_distance()};
    Vec3 beyond = Vec3::zero();
    for (std::size_t j = bonds; j-- > 1;) {
        beyond = beyond + force[j + 1];
        double const c = dot(e[j - 1], e[j]);
        Vec3 const w = plus_scaled(e[j - 1], -c, e[j]);
        double const turned =
            g[j] * (1 - c * c) + (j + 1 < bonds ? g[j + 1] * dot(w, e[j + 1]) : 0.0);
        s.cosine += c / static_cast<double>(bonds - 1);
        s.virial += dot(beyond, w);
        s.divergence += (2 * c - turned) / length[j];
    }
    return s;
}

}  // namespace catena
