// Implements the lattice of replicas.
#include "neighbours/replica_places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include "error.hpp"
#include "math/cubic_lattice.hpp"

namespace catena {
ReplicaPlaces::ReplicaPlaces(std::vector<std::int32_t> replica, double reach)
    : replica_(std::move(replica)), reach_(reach) {
    std::int64_t const count = 1 + *std::max_element(replica_.begin(), replica_.end());
    centre_.resize(static_cast<std::size_t>(count));
    CubicLattice const lattice(count);
    for (std::int64_t r = 0; r < count; ++r) {
        Site site{};
        for (std::size_t c = 0; c < 3; ++c)
            site.at[c] = static_cast<std::int32_t>(lattice.site(r)[c] - lattice.edge()[c] / 2);
        site_.push_back(site);
    }
}

void ReplicaPlaces::find(std::span<Vec3 const> positions) {
    double constexpr none = std::numeric_limits<double>::infinity();
    std::vector<Vec3> low(centre_.size(), {{none, none, none}}),
        high(centre_.size(), {{-none, -none, -none}});
    for (std::size_t i = 0; i < positions.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            low[index(i)][c] = std::min(low[index(i)][c], positions[i][c]);
            high[index(i)][c] = std::max(high[index(i)][c], positions[i][c]);
        }
    double half = 0;  // of the longest edge of a box around a replica
    for (std::size_t r = 0; r < centre_.size(); ++r) {
        centre_[r] = 0.5 * (low[r] + high[r]);
        for (int c = 0; c < 3; ++c) half = std::max(half, 0.5 * (high[r][c] - low[r][c]));
    }
    farthest_ = half + slack;
    spacing_ = 2 * farthest_ + reach_ + gap;
    std::int32_t edge = 0;
    for (Site const& site : site_)
        for (std::int32_t const at : site.at) edge = std::max(edge, std::abs(at));
    if (double const extent = spacing_ * edge + farthest_; extent > most)
        throw ComputationError(fmt::format(
            "a replica is {:.4g} nm wide, so that {} replicas do not fit side by side within {:g} "
            "nm: single precision has too few digits there; use fewer replicas, or keep the chains "
            "of a replica together",
            2 * half, centre_.size(), most));
}

bool ReplicaPlaces::hold(std::span<Vec3 const> positions) const {
    for (std::size_t i = 0; i < positions.size(); ++i) {
        Vec3 const local = positions[i] - centre(i);
        for (int c = 0; c < 3; ++c)
            if (!(std::abs(local[c]) <= farthest_)) return false;
    }
    return true;
}

Vec3 ReplicaPlaces::shift(std::size_t point) const {
    Vec3 shift = centre(point);
    for (int c = 0; c < 3; ++c) shift[c] -= spacing_ * site(point)[c];
    return shift;
}

}  // namespace catena
