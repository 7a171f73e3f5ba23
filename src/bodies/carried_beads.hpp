// Reader of the beads that rigid bodies carry: `beads: [{residue, position, mass}]`.
#pragma once

#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// Collects the beads body by body. Without any bead the CarriedBeads stay empty.
class CarriedList {
  public:
    /// Adds a bead to the current body.
    void append(Vec3 const& position, double mass, std::string const& residue);
    /// Ends the current body.
    void close();
    /// Adds all beads of the next body and ends it. `beads` is its list in the scene, or nullptr.
    /// `origin` is subtracted from the positions: linked chains measure from the centre of mass.
    /// The mass defaults to that of the residue in CALVADOS 2, else to 1.
    void add(Node const* beads, Vec3 const& origin = Vec3::zero());
    /// Moves the result out.
    CarriedBeads take();

  private:
    /// The beads of all bodies that have been added so far.
    CarriedBeads beads_;
};

}  // namespace catena::scene
