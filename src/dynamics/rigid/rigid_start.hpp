// Initial state of chains of rigid bodies in absolute coordinates, and properties computed once at
// the start.
#pragma once

#include "chain/chain_group.hpp"
#include "mpi/communicator.hpp"
#include "scene/scene.hpp"

namespace catena {

/// Initial poses and velocities of the group's bodies: position and velocity of the centre of mass
/// (W), omega (B) and orientation (quaternion of B in W).
struct RigidStart {
    Field<3> position, velocity, omega;
    Field<4> orientation;
};
/// The start that the scene specifies. Collective.
RigidStart place_bodies(ChainGroup const&, Scene const&, Communicator const&);

/// Principal axes of all bodies: quaternions of the axes in B, and the moments of inertia about
/// them. A point bead has moments 0.
struct PrincipalFrames {
    Field<4> axes;
    Field<3> moment;
};
PrincipalFrames principal_frames(ChainGroup const&);

/// Longest distance of a joint from its bodies' centres of mass, or the largest radius of gyration
/// if that is longer, nm. Returns the same value on every rank; collective.
double reach_of_joints(ChainGroup const&, Communicator const&);

}  // namespace catena
