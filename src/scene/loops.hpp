// Loops of rigid bodies at the start: where their joints stand, and how many directions they
// restrict.
#pragma once

#include <vector>

#include "scene/pose.hpp"

namespace catena::scene {

/// Returns the pose of every body at the start, W. Precondition: rigid bodies in joint coordinates.
std::vector<Pose> start_poses(ChainSpec const&);
/// Returns the pose at the start of a body of `poses`, or of the ground.
Pose pose_at(std::vector<Pose> const& poses, std::int64_t body);
/// Returns the frame G at the start as the inboard body holds it: J X(q), W.
Pose held_frame(std::vector<Pose> const& poses, LoopClosure const& loop);

/// Number of directions that the joints of the chain's loops restrict, redundant ones included.
std::int64_t directions_of_loops(ChainSpec const&);
/// Returns ChainSpec::redundant_directions: the directions of the loops less the rank of their
/// Jacobian at the start, with singular values below 2^-16.5 of the largest one counted as 0.
/// Joints with prescribed motion have no part in it. In a singular position more are redundant than
/// elsewhere.
std::int64_t redundant_directions(ChainSpec const&);
/// Returns the same with all joints moved by up to 0.05 rad, so that loops open. A smaller number
/// than at the start tells of a singular position, such as a dead centre, or of a mechanism that
/// only moves because of its special dimensions.
std::int64_t redundant_nearby(ChainSpec);

}  // namespace catena::scene
