// Density profile of a slab along an axis of the periodic box.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/estimate.hpp"
#include "analysis/fits.hpp"
#include "analysis/kinds.hpp"
#include "frames/trajectory_file.hpp"

namespace catena::analysis {

/// Density of all sites, or of one kind, in the two phases of a slab.
struct Phases {
    Estimate dense, dilute;
};

/// Profiles of mass per volume. In every frame the middle of the slab is moved to z = 0: the
/// circular mean of the sites' coordinates, weighted with masses (L. Bai & D. Breen, J. Graph.
/// Tools 13, 53, 2008).
class DensityProfile {
  public:
    /// `axis`: 0 to 2. `bins`: even number of bins between minus and plus half the box's edge.
    DensityProfile(Topology const&, std::vector<Kind> const&, int axis, std::size_t bins,
                   std::int64_t frames);
    /// Precondition: the snapshot has a box.
    void add(Snapshot const&);

    std::size_t bins() const { return bins_; }
    /// Middle of a bin, in the unit of length.
    double z(std::size_t bin) const;
    /// Density in mg/ml (kg/m^3 with `units: si`) of a kind, or of all sites for `kind` = number of
    /// kinds.
    Estimate at(std::size_t kind, std::size_t bin) const;

    /// True if the mass is as uneven along the axis as the random places of so few chains make it.
    bool may_be_chance() const;
    /// True if the dense part does not fill the box across the axis: a droplet or a cylinder. The
    /// mass within half the shorter edge of the middle tells it.
    bool is_uneven_across() const;
    /// Fits the interfaces to the profile of all sites, both halves averaged.
    Interfaces interfaces() const;
    /// Regions of |z| that count as dense and dilute: up to z0 - 2 w, and from z0 + 6 w on.
    static Range dense_region(Interfaces const& i) { return {0, i.position - 2 * i.width}; }
    Range dilute_region(Interfaces const& i) const {
        return {i.position + 6 * i.width, edge() / 2};
    }
    /// Returns the mean density of a kind (or all) in the bins whose middles lie in the region; NaN
    /// if there are none.
    Estimate in(std::size_t kind, Range const& region) const;

  private:
    /// Least ratio of an amplitude to that of random places that is not chance.
    static double constexpr beyond_chance = 1.5;
    double edge() const { return edges_ / static_cast<double>(frames_); }

    int axis_;
    std::size_t bins_, kinds_;
    double unit_;                     // mg/ml per unit of mass and volume
    std::vector<std::size_t> owner_;  // kind of each site
    std::vector<double> mass_;        // of each site
    double chance_;                   // mean amplitude along an edge of chains at random places
    BlockMeans profiles_;             // [kind, then all][bin]
    double edges_ = 0;                // sum of the edges along the axis
    double along_ = 0, across_ = 0;   // sums of the amplitudes of the mass along and across it
    std::int64_t frames_ = 0;
};

}  // namespace catena::analysis
