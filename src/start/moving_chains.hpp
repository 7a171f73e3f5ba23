// Chains of beads and domains on links, pushed by forces on their beads while their links keep
// their lengths.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "generate/link_projection.hpp"
#include "math/linear.hpp"
#include "math/rotation.hpp"
#include "scene/scene.hpp"

namespace catena {

/// Of a unit, along and about its centre: how far it goes, how fast, or what pushes it. A bead does
/// not turn.
struct UnitMotion {
    Vec3 shift = Vec3::zero(), turn = Vec3::zero();
};

/// One chain of beads, or of beads and domains on links. Every bead weighs 1.
class MovingChain {
  public:
    /// `first_bead`: in the scene. The chain outlives this object.
    MovingChain(ChainSpec& chain, std::size_t first_bead);

    std::size_t units() const { return stand_.at.size(); }
    /// What `forces` on the scene's beads make of each unit: the mean force, and the torque over
    /// the beads' squared distances.
    UnitMotion acceleration(std::size_t unit, std::vector<Vec3> const& forces) const;
    /// What a unit's motion weighs in sums over units: of x and y.
    double product(std::size_t unit, UnitMotion const& x, UnitMotion const& y) const;
    /// How far it takes the unit's beads at most; nm for one in nm and rad.
    double size(std::size_t unit, UnitMotion const& motion) const;
    /// Moves the units, then closes the links: the shifts become what was done. Where they cannot
    /// be closed, false and nothing has moved.
    bool move(std::span<UnitMotion> by);

    void put_beads(std::vector<Vec3>& positions) const;
    /// Into the chain.
    void write();
    /// Where units stand, as numbers for other ranks.
    std::vector<std::span<std::byte>> bytes();

  private:
    struct Stand {
        std::vector<Vec3> at;
        std::vector<Quat> turn;  // of linked chains
    };
    std::size_t begin_of(std::size_t unit) const;
    bool close();

    ChainSpec& chain_;
    std::size_t first_;
    Stand stand_;
    std::vector<double> weight_, squares_,
        widest_;  // of units: beads, their squared distances from the centre, the largest distance
    scene::LinkProjection links_;
};

/// InputError for beads on joints other than links.
std::vector<MovingChain> moving_chains(Scene& scene);

}  // namespace catena
