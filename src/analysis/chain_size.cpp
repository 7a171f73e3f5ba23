// Implements sizes of one conformation.
#include "analysis/chain_size.hpp"

#include <cmath>

namespace catena::analysis {
namespace {

/// Largest separation of `count` points along a chain, or around a ring.
std::int64_t largest_separation(std::int64_t count, bool ring) {
    return ring ? count / 2 : count - 1;
}

std::int64_t bonds_of(Kind const& kind) {
    return kind.ring && kind.sites > 2 ? kind.sites : kind.sites - 1;
}

/// Returns the mean of value(i, j) over all pairs of `count` points at separation s. Around a ring
/// every point begins a pair.
template <class Value>
double mean_over_pairs(std::size_t count, std::size_t s, bool ring, Value const& value) {
    std::size_t const pairs = ring ? count : count - s;
    double sum = 0;
    for (std::size_t i = 0; i < pairs; ++i) sum += value(i, i + s < count ? i + s : i + s - count);
    return sum / static_cast<double>(pairs);
}

}  // namespace

double Gyration::radius() const { return std::sqrt(tensor(0, 0) + tensor(1, 1) + tensor(2, 2)); }

double Gyration::asphericity() const {
    double const trace = tensor(0, 0) + tensor(1, 1) + tensor(2, 2);
    double squares = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) squares += tensor(i, j) * tensor(i, j);
    return (3 * squares / (trace * trace) - 1) / 2;
}

Gyration gyration_of(std::span<Vec3 const> x, std::span<double const> mass) {
    Gyration found;
    double all = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        all += mass[k];
        found.centre = plus_scaled(found.centre, mass[k], x[k] - x[0]);
    }
    found.centre = x[0] + (1 / all) * found.centre;
    for (std::size_t k = 0; k < x.size(); ++k) {
        Vec3 const d = x[k] - found.centre;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j <= i; ++j) found.tensor(i, j) += mass[k] / all * d[i] * d[j];
    }
    return found;
}

InternalMeans::InternalMeans(Kind const& kind, std::int64_t frames)
    : ring_(kind.ring && kind.sites > 2),
      separations_(spaced_numbers(largest_separation(kind.sites, ring_))),
      bond_separations_(spaced_numbers(largest_separation(bonds_of(kind), ring_))),
      distances_(separations_.size(), kind.copies(), frames, kind.together()),
      cosines_(bond_separations_.size(), kind.copies(), frames, kind.together()),
      length_(1, kind.copies(), frames, kind.together()) {}

void InternalMeans::add(std::size_t copy, std::span<Vec3 const> x) {
    if (x.size() < 2) return;
    add_distances(copy, x);
    add_bonds(copy, x);
}

void InternalMeans::add_distances(std::size_t copy, std::span<Vec3 const> x) {
    std::vector<double> curve;
    for (std::int64_t const s : separations_)
        curve.push_back(mean_over_pairs(x.size(), static_cast<std::size_t>(s), ring_,
                                        [&](std::size_t i, std::size_t j) {
                                            Vec3 const d = x[j] - x[i];
                                            return dot(d, d);
                                        }));
    distances_.add(copy, curve);
}

void InternalMeans::add_bonds(std::size_t copy, std::span<Vec3 const> x) {
    std::size_t const bonds = ring_ ? x.size() : x.size() - 1;
    std::vector<Vec3> direction(bonds);
    double length = 0;
    for (std::size_t i = 0; i < bonds; ++i) {
        Vec3 const bond = x[(i + 1) % x.size()] - x[i];
        double const own = norm(bond);
        direction[i] = (1 / own) * bond;
        length += own / static_cast<double>(bonds);
    }
    length_.add(copy, std::span(&length, 1));
    std::vector<double> curve;
    for (std::int64_t const s : bond_separations_)
        curve.push_back(mean_over_pairs(
            bonds, static_cast<std::size_t>(s), ring_,
            [&](std::size_t i, std::size_t j) { return dot(direction[i], direction[j]); }));
    cosines_.add(copy, curve);
}

void InternalMeans::end_frame() {
    distances_.end_frame();
    cosines_.end_frame();
    length_.end_frame();
}

}  // namespace catena::analysis
