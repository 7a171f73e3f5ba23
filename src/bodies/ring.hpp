// Where a chain of rigid bodies ends at the start, and whether it closes on its first body there.
#pragma once

#include "scene/node.hpp"
#include "scene/pose.hpp"

namespace catena::scene {

/// Largest error of a joint that is to be closed at the start, relative to the length it is
/// measured by; of angles.
inline constexpr double closure_tolerance = 1e-9;
/// The same of a joint that projections close: two Newton steps bring it to rounding.
inline constexpr double closable = 1e-4;

struct Reach {
    Pose end;           // of the last body
    double length = 0;  // of the joints' distances along the chain
};
Reach reach_of(BodyArrays const& bodies);

/// InputError for what cannot be a ring, whatever its joints.
void check_ring(ChainSpec const& chain, Node const& joint);

/// Of rigid bodies. Where no rotation is written the joint frame stands as the first body does. A
/// ring that is open within `closable` is noted in the scene, InputError beyond.
void close_ring(ChainSpec& chain, Node const& joint, Scene& scene);

}  // namespace catena::scene
