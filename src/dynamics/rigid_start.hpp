// What chains of rigid bodies in absolute coordinates begin with.
#pragma once

#include "chain/chain_group.hpp"
#include "mpi/communicator.hpp"
#include "scene/scene.hpp"

namespace catena {

/// Where the bodies of the group start. Collective.
struct RigidStart {
    Field<3> position, velocity, omega;
    Field<4> orientation;
};
RigidStart place_bodies(ChainGroup const&, Scene const&, Communicator const&);

/// Of all bodies: quaternions of the axes in B, and the moments about them; a point bead: none.
struct PrincipalFrames {
    Field<4> axes;
    Field<3> moment;
};
PrincipalFrames principal_frames(ChainGroup const&);

/// Longest distance of a joint from its bodies' centres, or a body's radius of gyration. The same
/// on every rank; collective.
double reach_of_joints(ChainGroup const&, Communicator const&);

}  // namespace catena
