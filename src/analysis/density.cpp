// Implements density profiles.
#include "analysis/density.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "math/concentration_units.hpp"

namespace catena::analysis {
namespace {

/// First Fourier component of the mass along a periodic edge.
class Wave {
  public:
    explicit Wave(double edge) : turn_(2 * std::numbers::pi / edge) {}
    void add(double mass, double x) {
        mass_ += mass;
        sine_ += mass * std::sin(turn_ * x);
        cosine_ += mass * std::cos(turn_ * x);
    }
    /// Circular mean of the coordinates.
    double middle() const { return std::atan2(sine_, cosine_) / turn_; }
    /// 0 for even mass, 1 for mass at one place.
    double amplitude() const { return mass_ > 0 ? std::hypot(sine_, cosine_) / mass_ : 0; }

  private:
    double turn_, mass_ = 0, sine_ = 0, cosine_ = 0;
};

/// Number of chains of equal masses whose random places would make the mass as uneven as these.
double even_chains(Topology const& topology) {
    double sum = 0, squares = 0;
    for (Topology::Chain const& chain : topology.chains) {
        auto const first = topology.mass.begin() + static_cast<std::ptrdiff_t>(chain.first);
        double const mass = std::accumulate(first, first + chain.count, 0.0);
        sum += mass;
        squares += mass * mass;
    }
    return squares > 0 ? sum * sum / squares : 1;
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
      chance_(0.5 * std::sqrt(std::numbers::pi / even_chains(topology))),
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
    double const edge = box[axis_];
    Wave along(edge);
    for (std::size_t k = 0; k < mass_.size(); ++k) along.add(mass_[k], snapshot.position[k][axis_]);
    double const middle = along.middle();
    int const sides[] = {(axis_ + 1) % 3, (axis_ + 2) % 3};
    double const near = 0.5 * std::min(box[sides[0]], box[sides[1]]) / edge;
    Wave across[] = {Wave(box[sides[0]]), Wave(box[sides[1]])};
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
        for (int i = 0; i < 2 && std::abs(place - 0.5) <= near; ++i)
            across[i].add(mass_[k], snapshot.position[k][sides[i]]);
    }
    along_ += along.amplitude();
    across_ += std::max(across[0].amplitude(), across[1].amplitude());
    profiles_.end_frame();
    edges_ += edge;
    ++frames_;
}

bool DensityProfile::may_be_chance() const {
    return along_ < beyond_chance * chance_ * static_cast<double>(frames_);
}

bool DensityProfile::is_uneven_across() const {
    double constexpr uneven = 0.35;  // a sphere as wide as the box has 0.30, one of 2/3 of it 0.63
    return across_ > std::max(uneven, beyond_chance * chance_) * static_cast<double>(frames_);
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
