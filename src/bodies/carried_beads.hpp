// Beads that rigid bodies carry: `beads: [{residue, position, mass}]`.
#pragma once

#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// The beads of body after body; without any bead CarriedBeads stay empty.
class CarriedList {
  public:
    /// One more bead of the present body.
    void append(Vec3 const& position, double mass, std::string const& residue);
    /// The present body has all its beads.
    void close();
    /// The whole body: its list in the scene, or null for none. Positions are moved by -`origin`
    /// (linked chains count from the centre of mass).
    void add(Node const* beads, Vec3 const& origin = Vec3::zero());
    CarriedBeads take();

  private:
    CarriedBeads beads_;
};

}  // namespace catena::scene
