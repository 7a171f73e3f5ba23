// Start pose of the last body of a rigid chain, and closure of rings at the start.
#pragma once

#include "scene/node.hpp"
#include "scene/pose.hpp"

namespace catena::scene {

/// Largest closure error of a joint that must be closed at the start: lengths relative to the
/// chain's reach, angles in rad.
inline constexpr double closure_tolerance = 1e-9;
/// Largest closure error that the constraint projection closes at the start; two Newton steps
/// reduce it to rounding.
inline constexpr double closable = 1e-4;

/// End and length of a chain at the start.
struct Reach {
    Pose end;  // pose of the last body, W
    /// Sum of the distances between consecutive joints.
    double length = 0;
};
/// Computes the start poses along the chain.
Reach reach_of(BodyArrays const& bodies);

/// Throws InputError for a chain that cannot be a ring, for any joint: a fixed base, or too few
/// bodies.
void check_ring(ChainSpec const& chain, Node const& joint);

/// Closes a ring of rigid bodies at the start. Without a `rotation` the joint frame has the
/// orientation of the first body. A ring that is open within `closable` is noted in the scene; a
/// wider opening throws InputError.
void close_ring(ChainSpec& chain, Node const& joint, Scene& scene);

}  // namespace catena::scene
