// Branched chains of point beads for tests, and the dense matrix of their links in extended
// precision.
#pragma once

#include <cmath>
#include <vector>

#include "scene/scene.hpp"
#include "tests/support/random_chain.hpp"

namespace catena::test {

/// Places the beads at random directions from the beads on which they hang. Masses extend over
/// `decades` powers of ten.
inline ChainSpec grown(std::uint64_t seed, std::vector<std::int64_t> const& parent, Base base,
                       double decades = 1) {
    Random random(seed);
    ChainSpec chain;
    chain.name = "tree";
    chain.base = base;
    chain.parent = parent;
    BeadArrays& b = chain.beads;
    b.anchor = random.vector(1);
    for (std::int64_t const p : parent) {
        double const length = random.uniform(0.2, 0.6);
        Vec3 const from = p < 0 ? b.anchor : b.position[static_cast<std::size_t>(p)];
        b.mass.push_back(std::pow(10.0, random.uniform(-0.5 * decades, 0.5 * decades)));
        b.length.push_back(length);
        b.residue.push_back("UNK");
        b.position.push_back(from + length * random.direction());
        b.velocity.push_back(random.vector(1));
    }
    return chain;
}

/// Beads that hang on a random bead before them; with probability `follow` on the one just before.
inline std::vector<std::int64_t> random_parents(std::uint64_t seed, std::size_t beads,
                                                double follow) {
    Random random(seed);
    std::vector<std::int64_t> parent{-1};
    for (std::size_t k = 1; k < beads; ++k)
        parent.push_back(random.chance(follow) ? static_cast<std::int64_t>(k) - 1
                                               : static_cast<std::int64_t>(random.uniform() *
                                                                           static_cast<double>(k)));
    return parent;
}
/// A backbone, and a side chain of `side` beads on each of its beads.
inline std::vector<std::int64_t> brush_parents(std::size_t backbone, std::size_t side) {
    std::vector<std::int64_t> parent;
    for (std::size_t i = 0; i < backbone; ++i) parent.push_back(static_cast<std::int64_t>(i) - 1);
    for (std::size_t i = 0; i < backbone; ++i)
        for (std::size_t j = 0; j < side; ++j)
            parent.push_back(j == 0 ? static_cast<std::int64_t>(i)
                                    : static_cast<std::int64_t>(parent.size()) - 1);
    return parent;
}
/// A star: bead 0 and `arms` beads on it.
inline std::vector<std::int64_t> star_parents(std::size_t arms) {
    std::vector<std::int64_t> parent(arms + 1, 0);
    parent[0] = -1;
    return parent;
}

/// The matrix T of all links (src/dca/README.md, "Link chains") and its Cholesky factor.
class DenseLinks {
  public:
    using Real = long double;
    using Point = Vector<Real, 3>;
    DenseLinks(ChainSpec const& chain, std::vector<Vec3> const& position)
        : chain_(chain), links_(chain.size()), factor_(links_ * links_, 0) {
        for (std::size_t k = 0; k < links_; ++k) {
            // A free first bead has no link: its row is that of a unit matrix.
            Point const d = point(position[k]) - point(from(position, k));
            Real const size = std::sqrt(dot(d, d));
            direction_.push_back(has_link(k) ? (1 / size) * d : Point{});
        }
        for (std::size_t i = 0; i < links_; ++i)
            for (std::size_t j = 0; j <= i; ++j) factor_[i * links_ + j] = entry(i, j);
        factorize();
    }
    Real log_determinant() const {
        Real sum = 0;
        for (std::size_t i = 0; i < links_; ++i) sum += 2 * std::log(factor_[i * links_ + i]);
        return sum;
    }
    /// Accelerations of the beads under forces, at velocities that keep the links; `tension` gets
    /// the force of each link on its bead along its direction.
    std::vector<Vec3> accelerations(std::vector<Vec3> const& velocity,
                                    std::vector<Vec3> const& force,
                                    std::vector<double>& along) const {
        std::vector<Real> f(links_, 0);
        for (std::size_t k = 0; k < links_; ++k) {
            if (!has_link(k)) continue;
            bool const grounded = chain_.parent[k] < 0;
            Point const u = direction_[k];
            Point v = point(velocity[k]), a = (1 / mass(k)) * point(force[k]);
            if (!grounded) {
                auto const p = static_cast<std::size_t>(chain_.parent[k]);
                v = v - point(velocity[p]);
                a = a - (1 / mass(p)) * point(force[p]);
            }
            Point const across = v - dot(v, u) * u;
            f[k] = -dot(across, across) / static_cast<Real>(chain_.beads.length[k]) - dot(u, a);
        }
        solve(f);
        std::vector<Vec3> result;
        std::vector<Point> a;
        for (std::size_t k = 0; k < links_; ++k)
            a.push_back((1 / mass(k)) * (point(force[k]) + f[k] * direction_[k]));
        for (std::size_t k = 0; k < links_; ++k)
            if (chain_.parent[k] >= 0) {
                auto const p = static_cast<std::size_t>(chain_.parent[k]);
                a[p] = a[p] - (f[k] / mass(p)) * direction_[k];
            }
        along.clear();
        for (std::size_t k = 0; k < links_; ++k) {
            result.push_back({{static_cast<double>(a[k][0]), static_cast<double>(a[k][1]),
                               static_cast<double>(a[k][2])}});
            along.push_back(static_cast<double>(f[k]));
        }
        return result;
    }
    std::vector<Point> const& direction() const { return direction_; }

  private:
    static Point point(Vec3 const& x) { return {{x[0], x[1], x[2]}}; }
    bool has_link(std::size_t k) const {
        return chain_.parent[k] >= 0 || chain_.base == Base::fixed;
    }
    Vec3 from(std::vector<Vec3> const& position, std::size_t k) const {
        std::int64_t const p = chain_.parent[k];
        return p < 0 ? chain_.beads.anchor : position[static_cast<std::size_t>(p)];
    }
    Real mass(std::size_t k) const { return static_cast<Real>(chain_.beads.mass[k]); }
    /// Sum over the beads at which both links end: u_i . u_j / m, with the opposite sign if the
    /// bead is the outboard end of one link and the inboard end of the other.
    Real entry(std::size_t i, std::size_t j) const {
        if (!has_link(i) || !has_link(j)) return i == j ? 1 : 0;
        std::int64_t const out_i = static_cast<std::int64_t>(i), in_i = chain_.parent[i],
                           out_j = static_cast<std::int64_t>(j), in_j = chain_.parent[j];
        Real sum = 0;
        auto const add = [&](std::int64_t a, std::int64_t b, Real sign) {
            if (a == b && a >= 0)
                sum += sign * dot(direction_[i], direction_[j]) / mass(static_cast<std::size_t>(a));
        };
        add(out_i, out_j, 1), add(in_i, in_j, 1), add(out_i, in_j, -1), add(in_i, out_j, -1);
        return sum;
    }
    void factorize() {
        for (std::size_t i = 0; i < links_; ++i)
            for (std::size_t j = 0; j <= i; ++j) {
                Real sum = factor_[i * links_ + j];
                for (std::size_t k = 0; k < j; ++k)
                    sum -= factor_[i * links_ + k] * factor_[j * links_ + k];
                factor_[i * links_ + j] = i == j ? std::sqrt(sum) : sum / factor_[j * links_ + j];
            }
    }
    void solve(std::vector<Real>& b) const {
        for (std::size_t i = 0; i < links_; ++i) {
            for (std::size_t k = 0; k < i; ++k) b[i] -= factor_[i * links_ + k] * b[k];
            b[i] /= factor_[i * links_ + i];
        }
        for (std::size_t i = links_; i-- > 0;) {
            for (std::size_t k = i + 1; k < links_; ++k) b[i] -= factor_[k * links_ + i] * b[k];
            b[i] /= factor_[i * links_ + i];
        }
    }

    ChainSpec const& chain_;
    std::size_t links_;
    std::vector<Real> factor_;
    std::vector<Point> direction_;
};

}  // namespace catena::test
