// Beads that rigid bodies carry: `beads: [{residue, position, mass}]`.
#pragma once

#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// Closes body after body: CarriedBeads grow with the bodies and stay empty until the first bead comes.
class CarriedList {
  public:
    /// The beads of the next body; null: none. Positions are moved by -`origin` (linked chains count from the centre of mass).
    void add(Node const* beads, Vec3 const& origin = Vec3::zero());
    /// One bead of the next body.
    void add(Vec3 const& position, double mass, std::string const& residue);
    CarriedBeads take();

  private:
    CarriedBeads beads_;
};

}  // namespace catena::scene
