// Where a chain of rigid bodies ends at the start, and whether it closes on its first body there.
#pragma once

#include "scene/node.hpp"
#include "scene/pose.hpp"

namespace catena::scene {

/// Largest error of a joint that is to be closed at the start, relative to the length it is measured by; of angles.
inline constexpr double closure_tolerance = 1e-9;

struct Reach {
    Pose end;           // of the last body
    double length = 0;  // of the joints' distances along the chain
};
Reach reach_of(BodyArrays const& bodies);

/// InputError for what cannot be a ring, whatever its joints.
void check_ring(ChainSpec const& chain, Node const& joint);

/// Of rigid bodies. Where no rotation is written the joint frame stands as the first body does. InputError when the ring is open.
void close_ring(ChainSpec& chain, Node const& joint);

}  // namespace catena::scene
