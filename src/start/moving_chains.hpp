// Chains of beads and domains on links, moved by forces on their beads at constant lengths of
// links.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "generate/link_projection.hpp"
#include "math/linear.hpp"
#include "math/rotation.hpp"
#include "scene/scene.hpp"

namespace catena {

/// Displacement, velocity or acceleration of a unit, i.e. a bead or a rigid domain. `shift`: along
/// the ground axes, nm; `rotation`: rotation vector about the centre, rad. A bead has no rotation.
struct UnitMotion {
    Vec3 shift = Vec3::zero(), rotation = Vec3::zero();
};

/// Chain of beads, or of beads and domains on links. Every bead weighs 1.
class MovingChain {
  public:
    /// `first_bead`: index of the chain's first bead in the scene. The chain must outlive this
    /// object.
    MovingChain(ChainSpec& chain, std::size_t first_bead);

    std::size_t units() const { return stand_.at.size(); }
    /// Acceleration of a unit by `forces` on the scene's beads: the mean force, and the torque
    /// divided by the sum of the beads' squared distances from the centre.
    UnitMotion acceleration(std::size_t unit, std::vector<Vec3> const& forces) const;
    /// Scalar product of two motions of a unit, weighted by the unit's mass and inertia.
    double product(std::size_t unit, UnitMotion const& x, UnitMotion const& y) const;
    /// Largest displacement of the unit's beads in a motion: nm for a motion in nm and rad.
    double size(std::size_t unit, UnitMotion const& motion) const;
    /// Moves the units, then closes the links. `by` becomes the shifts that resulted. If the links
    /// cannot be closed, nothing moves and the result is false.
    bool move(std::span<UnitMotion> by);

    /// Writes the chain's beads to the positions of all of the scene's beads.
    void put_beads(std::vector<Vec3>& positions) const;
    /// Writes positions and orientations to the chain.
    void write();
    /// Memory of the units' positions and orientations, for broadcasts to other ranks.
    std::vector<std::span<std::byte>> bytes();

  private:
    /// Positions and orientations of the units.
    struct Stand {
        std::vector<Vec3> at;
        std::vector<Quat> rotation;  // empty for chains of beads
    };
    /// Index of a unit's first bead in the chain.
    std::size_t begin_of(std::size_t unit) const;
    /// Projects the units to the lengths of the links. Returns false if that fails.
    bool close();

    ChainSpec& chain_;
    std::size_t first_;
    std::vector<std::int64_t> parents_;  // LinkedUnits::parent
    Stand stand_;
    std::vector<double> weight_, squares_,
        widest_;  // per unit: beads, sum of their squared distances from the centre, largest
                  // distance (nm)
    scene::LinkProjection links_;
};

/// All chains of the scene that have beads. Throws InputError for beads on joints other than links.
std::vector<MovingChain> moving_chains(Scene& scene);

}  // namespace catena
