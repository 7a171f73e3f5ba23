// Sizes of one conformation: radius of gyration, end-to-end distance, asphericity, internal
// distances, directions of bonds.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/estimate.hpp"
#include "analysis/kinds.hpp"
#include "math/linear.hpp"

namespace catena::analysis {

/// Moments of a chain's sites around their centre of mass.
struct Gyration {
    Vec3 centre = Vec3::zero();  // centre of mass
    Sym3 tensor = Sym3::zero();  // sum m (x - c)(x - c)^T / sum m
    /// Returns the square root of the trace, weighted by masses.
    double radius() const;
    /// Returns 3/2 sum (l_i - l)^2 / (sum l_i)^2 of the tensor's eigenvalues l_i with mean l: 0 for
    /// a sphere, 1 for a rod (R. I. Dima & D. Thirumalai, J. Phys. Chem. B 108, 6564, 2004). NaN if
    /// all sites coincide.
    double asphericity() const;
};
Gyration gyration_of(std::span<Vec3 const> x, std::span<double const> mass);

/// Internal distances and bond correlations of all copies of a chain.
class InternalMeans {
  public:
    InternalMeans(Kind const& kind, std::int64_t frames);
    /// Adds the conformation of one copy in the current frame.
    void add(std::size_t copy, std::span<Vec3 const> x);
    void end_frame();

    /// Separations s = |i - j| along the chain; around a ring the shorter way counts.
    std::vector<std::int64_t> const& separations() const { return separations_; }
    /// Mean squared distance of sites at each separation, over all pairs of sites.
    CurveMeans const& squared_distances() const { return distances_; }
    /// Separations of bonds. Bond i points from site i to site i + 1.
    std::vector<std::int64_t> const& bond_separations() const { return bond_separations_; }
    /// Mean cosine between the directions of bonds at each separation.
    CurveMeans const& cosines() const { return cosines_; }
    /// Mean length of bonds; entry 0 of the curve.
    CurveMeans const& bond_length() const { return length_; }

  private:
    void add_distances(std::size_t copy, std::span<Vec3 const> x);
    void add_bonds(std::size_t copy, std::span<Vec3 const> x);

    bool ring_;
    std::vector<std::int64_t> separations_, bond_separations_;
    CurveMeans distances_, cosines_, length_;
};

}  // namespace catena::analysis
