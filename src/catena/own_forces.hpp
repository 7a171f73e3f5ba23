// Brings a force of the user's to the bodies of a system. Beads receive forces as from OpenMM.
// Rigid bodies carry points for it: one at the centre of mass and one on each axis, whose positions
// show the body's place and whose forces make up any force and torque.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "catena/forces.hpp"
#include "integrate/chain_system.hpp"

namespace catena {

/// Throws InputError if the scene asks for a GPU, which does not support own forces.
void refuse_own_forces_on_gpu(Scene const&);

/// Returns the scene whose rigid bodies carry the points of an own force. Throws InputError if own
/// forces do not support the scene: on a GPU, and on rigid bodies beside OpenMM's forces.
Scene with_force_points(Scene);

/// Calls a force at every evaluation of a system on one rank.
class OwnForces {
  public:
    /// Adds the force to the system, which must outlive this object and be made of
    /// with_force_points(). The object stays where it is.
    OwnForces(OwnForce force, ChainSystem& system);
    OwnForces(OwnForces const&) = delete;
    OwnForces& operator=(OwnForces const&) = delete;

    /// Potential energy at the last evaluation; absent if the force returned none.
    std::optional<double> energy() const { return energy_; }

  private:
    /// Calls the force and adds its result to the hosts' beads. Throws InputError for a torque on a
    /// bead, and ComputationError for numbers that are not finite.
    void add();
    /// Reads positions and orientations of a host's bodies.
    void read(BeadHost& host);
    /// Adds the forces on a host's bodies.
    void write(BeadHost& host);

    OwnForce force_;
    std::vector<BeadHost*> hosts_;
    std::vector<Triple> position_, on_force_, on_torque_;
    std::vector<UnitQuaternion> orientation_;
    std::optional<double> energy_;
};

}  // namespace catena
