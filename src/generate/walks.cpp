// Implements the random walks of beads on links.
#include <algorithm>
#include <cmath>

#include "generate/generators.hpp"

namespace catena::scene {

namespace {

/// Returns a unit vector at the angle acos(`cosine`) to the unit vector `axis`, at `azimuth` about
/// it.
Vec3 tilted(Vec3 const& axis, double cosine, double azimuth) {
    int const least = std::abs(axis[0]) < std::abs(axis[1])
                          ? (std::abs(axis[0]) < std::abs(axis[2]) ? 0 : 2)
                          : (std::abs(axis[1]) < std::abs(axis[2]) ? 1 : 2);
    Vec3 other = Vec3::zero();
    other[least] = 1;
    Vec3 side = cross(axis, other);
    side = (1 / norm(side)) * side;
    double const sine = std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine)));
    Vec3 const direction =
        cosine * axis + sine * (std::cos(azimuth) * side + std::sin(azimuth) * cross(axis, side));
    return (1 / norm(direction)) * direction;
}

/// Returns 1 - cos theta of an angle with weight exp(kappa cos theta) on the sphere. It is the
/// inverse of the distribution at `u` in (0, 1).
double versine(double kappa, double u) {
    return kappa < 1e-9 ? 2 * u : -std::log1p(u * std::expm1(-2 * kappa)) / kappa;
}

/// Places the beads one by one; `next(k, direction before)` returns the direction of link k.
template <class Next>
void follow(BeadArrays& beads, Base base, Next next) {
    Vec3 at = beads.anchor, direction = Vec3::zero();
    for (std::size_t k = 0; k < beads.mass.size(); ++k) {
        if (k > 0 || base == Base::fixed) {
            direction = next(k, direction);
            at = plus_scaled(at, beads.length[k], direction);
        }
        beads.position.push_back(at);
    }
}

}  // namespace

double bending_of(double ratio) {
    double const c = std::exp(-ratio), rest = -std::expm1(-ratio);  // rest = 1 - c
    if (c < 1e-3) return 3 * c * (1 + 0.6 * c * c);
    double kappa = c * (3 - c * c) / (rest * (1 + c));
    // Newton's iteration on 1 / kappa - 2 / (exp(2 kappa) - 1) = 1 - c, which keeps its digits for
    // c near 1.
    for (int i = 0; i < 50; ++i) {
        double const e = std::expm1(2 * kappa), f = 1 / kappa - 2 / e - rest;
        double const slope = -1 / (kappa * kappa) + (std::isinf(e) ? 0 : 4 * (e + 1) / (e * e));
        double const next = kappa - f / slope;
        bool const done = std::abs(next - kappa) <= 1e-14 * kappa;
        kappa = next > 0 ? next : 0.5 * kappa;
        if (done) break;
    }
    return kappa;
}

BeadArrays drawn_sizes(Walk const& walk) {
    BeadArrays beads;
    auto const n = static_cast<std::size_t>(walk.beads);
    beads.residue.assign(n, "UNK");
    beads.velocity.assign(n, Vec3::zero());
    beads.anchor = walk.anchor;
    beads.mass.reserve(n), beads.length.reserve(n), beads.position.reserve(n);
    for (std::int64_t k = 0; k < walk.beads; ++k) {
        beads.mass.push_back(draw_size(walk.mass, walk.seed, k, SizeStream::mass));
        bool const linked = k > 0 || walk.base == Base::fixed;
        beads.length.push_back(linked ? draw_size(walk.length, walk.seed, k, SizeStream::length)
                                      : 0);
    }
    return beads;
}

BeadArrays freely_jointed(Walk const& walk) {
    BeadArrays beads = drawn_sizes(walk);
    // Stream k yields point k of the walk, the anchor included.
    std::int64_t const first = walk.base == Base::fixed ? 1 : 0;
    follow(beads, walk.base, [&](std::size_t k, Vec3 const&) {
        return Draws(walk.seed, static_cast<std::int64_t>(k) + first).on_sphere();
    });
    return beads;
}

BeadArrays worm_like(Walk const& walk, double persistence) {
    BeadArrays beads = drawn_sizes(walk);
    /// Values of the joint drawn last; equal links share them.
    double mean = 0, kappa = 0;
    bool first = true;
    follow(beads, walk.base, [&](std::size_t k, Vec3 const& before) {
        Draws draws(walk.seed, static_cast<std::int64_t>(k));
        if (std::exchange(first, false)) return draws.on_sphere();
        double const between = 0.5 * (beads.length[k - 1] + beads.length[k]);
        if (between != std::exchange(mean, between)) kappa = bending_of(between / persistence);
        double const u = draws.uniform();
        return tilted(before, 1 - versine(kappa, u), 2 * Draws::pi * draws.uniform());
    });
    return beads;
}

}  // namespace catena::scene
