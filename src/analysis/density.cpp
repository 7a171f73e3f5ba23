// Implements density profiles.
#include "analysis/density.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/concentration_units.hpp"

namespace catena::analysis {
namespace {

/// Returns the circular mean of coordinates in a periodic edge, weighted with masses.
double middle_of(std::vector<Vec3> const& x, std::vector<double> const& mass, int axis,
                 double edge) {
    double const turn = 2 * std::numbers::pi / edge;
    double sine = 0, cosine = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        sine += mass[k] * std::sin(turn * x[k][axis]);
        cosine += mass[k] * std::cos(turn * x[k][axis]);
    }
    return std::atan2(sine, cosine) / turn;
}

}  // namespace

DensityProfile::DensityProfile(Topology const& topology, std::vector<Kind> const& kinds, int axis,
                               std::size_t bins, std::int64_t frames)
    : axis_(axis),
      bins_(bins),
      kinds_(kinds.size()),
      unit_(topology.si ? 1 : mg_per_ml),
      owner_(topology.mass.size(), 0),
      mass_(topology.mass),
      profiles_((kinds.size() + 1) * bins, frames) {
    for (std::size_t k = 0; k < kinds.size(); ++k)
        for (std::size_t const chain : kinds[k].chains) {
            auto const first =
                owner_.begin() + static_cast<std::ptrdiff_t>(topology.chains[chain].first);
            std::fill_n(first, topology.chains[chain].count, k);
        }
}

void DensityProfile::add(Snapshot const& snapshot) {
    Vec3 const& box = *snapshot.box;
    double const edge = box[axis_], middle = middle_of(snapshot.position, mass_, axis_, edge);
    auto const count = static_cast<double>(bins_);
    double const density = unit_ * count / (box[0] * box[1] * box[2]);
    std::span<double> const row = profiles_.row();
    for (std::size_t k = 0; k < snapshot.position.size(); ++k) {
        double const apart = (snapshot.position[k][axis_] - middle) / edge;
        double const place = apart - std::floor(apart + 0.5) + 0.5;  // in [0, 1)
        std::size_t const bin =
            std::min(bins_ - 1, static_cast<std::size_t>(std::max(0.0, place) * count));
        row[owner_[k] * bins_ + bin] += density * mass_[k];
        row[kinds_ * bins_ + bin] += density * mass_[k];
    }
    profiles_.end_frame();
    edges_ += edge;
    ++frames_;
}

double DensityProfile::z(std::size_t bin) const {
    return edge() * ((static_cast<double>(bin) + 0.5) / static_cast<double>(bins_) - 0.5);
}

Estimate DensityProfile::at(std::size_t kind, std::size_t bin) const {
    std::size_t const number = kind * bins_ + bin;
    Blocked const found = blocked_mean({profiles_.series(number)});
    return {profiles_.means()[number], found.error, found.plateau, NAN};
}

Interfaces DensityProfile::interfaces() const {
    std::vector<double> const means = profiles_.means();
    std::vector<double> distance, density;
    for (std::size_t k = 0; k < bins_ / 2; ++k) {
        std::size_t const right = bins_ / 2 + k, left = bins_ / 2 - 1 - k;
        distance.push_back(z(right));
        density.push_back(0.5 * (means[kinds_ * bins_ + right] + means[kinds_ * bins_ + left]));
    }
    return fit_interfaces(distance, density, edge() / 2);
}

Estimate DensityProfile::in(std::size_t kind, Range const& region) const {
    std::vector<double> weights(profiles_.width(), 0.0);
    double bins = 0;
    for (std::size_t bin = 0; bin < bins_; ++bin) {
        if (!region.holds(std::abs(z(bin)))) continue;
        weights[kind * bins_ + bin] = 1;
        bins += 1;
    }
    if (bins == 0) return {};
    for (double& weight : weights) weight /= bins;
    std::vector<double> const means = profiles_.means();
    double mean = 0;
    for (std::size_t k = 0; k < means.size(); ++k) mean += weights[k] * means[k];
    Blocked const found = profiles_.error_of(weights);
    return {mean, found.error, found.plateau, NAN};
}

}  // namespace catena::analysis
