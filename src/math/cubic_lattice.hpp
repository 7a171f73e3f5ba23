// Sites of a lattice that is nearly a cube.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace catena {

/// The smallest lattice of so many sites whose edges differ little.
class CubicLattice {
  public:
    explicit CubicLattice(std::int64_t sites) {
        auto const all = static_cast<double>(sites);
        double constexpr rounding = 1e-9;  // must not add a layer to a whole cube
        edge_[0] = std::llround(std::ceil(std::cbrt(all) - rounding));
        edge_[1] =
            std::llround(std::ceil(std::sqrt(all / static_cast<double>(edge_[0])) - rounding));
        edge_[2] = (sites + edge_[0] * edge_[1] - 1) / (edge_[0] * edge_[1]);
    }
    /// Sites along each edge.
    std::array<std::int64_t, 3> const& edge() const { return edge_; }
    /// Returns the site of a number, from 0.
    std::array<std::int64_t, 3> site(std::int64_t number) const {
        return {number % edge_[0], number / edge_[0] % edge_[1], number / (edge_[0] * edge_[1])};
    }

  private:
    std::array<std::int64_t, 3> edge_;
};

}  // namespace catena
