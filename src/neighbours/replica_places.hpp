// Places of replicas in the coordinates that OpenMM gets. Replicas exert no forces on each other,
// and one Context computes the forces of all. They stand on a cubic lattice, so far apart that no
// pair force reaches from one to another, wherever the scene's own coordinates have them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "math/linear.hpp"

namespace catena {

/// Places of the replicas, found anew from time to time. A replica's centre is the middle of the
/// box around its points.
class ReplicaPlaces {
  public:
    /// Distance that points may move away from the box around their replica before places are found
    /// anew, nm. In 250 steps of 10 fs a chain of 140 beads diffuses by 0.3 nm.
    static constexpr double slack = 3;
    /// Distance of two replicas beyond the reach of their forces, nm. On a GPU a place is used for
    /// one step after a point has left it.
    static constexpr double gap = 1;
    /// Largest coordinate of a place, nm. Single precision resolves 2.4e-4 nm there.
    static constexpr double most = 4000;

    /// No replicas.
    ReplicaPlaces() = default;
    /// `replica`: replica of each point, from 0. `reach`: longest cutoff of the forces, nm.
    ReplicaPlaces(std::vector<std::int32_t> replica, double reach);

    bool empty() const { return replica_.empty(); }
    /// Finds the places for points at `positions`, nm. Throws ComputationError if the lattice would
    /// extend beyond `most`.
    void find(std::span<Vec3 const> positions);
    /// True if all points are within farthest() of their centres, so that replicas stay apart.
    /// Precondition: find() has been called.
    bool hold(std::span<Vec3 const> positions) const;

    /// Largest coordinate of a point relative to its centre, nm.
    double farthest() const { return farthest_; }
    /// Distance of neighbouring places, nm.
    double spacing() const { return spacing_; }
    /// Centre of the replica of a point, nm.
    Vec3 const& centre(std::size_t point) const { return centre_[index(point)]; }
    /// Lattice site of the replica of a point; the place is `spacing()` times the site.
    std::int32_t const (&site(std::size_t point) const)[3] { return site_[index(point)].at; }
    /// Vector that is subtracted from a point's position, nm.
    Vec3 shift(std::size_t point) const;

  private:
    struct Site {
        std::int32_t at[3];
    };
    std::size_t index(std::size_t point) const { return static_cast<std::size_t>(replica_[point]); }
    std::vector<std::int32_t> replica_;
    double reach_ = 0, farthest_ = 0, spacing_ = 0;
    std::vector<Vec3> centre_;
    std::vector<Site> site_;
};

}  // namespace catena
