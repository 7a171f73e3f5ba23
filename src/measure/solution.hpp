// Solution: accelerations and joint forces in the layout that users get (inputs/keys/output.md),
// body by body in scene order.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "integrate/chain_system.hpp"

namespace catena {

/// Results of one evaluation on rank 0; empty on other ranks. Body b owns entries [offset[b],
/// offset[b + 1]).
struct Solution {
    /// Joint accelerations. They are the second derivatives of the joint's coordinates (universal
    /// 2, weld none).
    /// Spherical: derivative of the components of qd (body axes). Free: {alpha (body axes),
    /// acceleration of the origin (W)}. Link: the bead's acceleration (W), or a rigid body's {alpha
    /// (body axes), acceleration of its centre of mass (W)}.
    std::vector<double> acceleration;
    // first entry of each body, then the number of entries
    std::vector<std::int64_t> acceleration_offset;
    /// Constraint wrench [torque, force] on body b at its inboard joint (W). Link: its tension,
    /// positive if it pulls its ends together (0 for bead 1 of a free chain, which has no link).
    std::vector<double> joint_force;
    // first entry of each body, then the number of entries
    std::vector<std::int64_t> force_offset;
    std::vector<TipForce> tip_force;        // one per chain with a jointed tip, in scene order
    std::vector<TipForce> loop_force;       // one per loop, in scene order
    std::vector<double> crosslink_tension;  // one per cross-link, in scene order
    std::vector<Vec3> bead_acceleration;    // accelerations of all beads of bead chains, W
    std::vector<Vec3> bead_force;           // OpenMM's forces on the beads, W; empty without OpenMM
};

/// Returns the results of the last evaluate(). Collective.
Solution solution_of(ChainSystem&);
/// Returns a Solution with acceleration_offset alone.
Solution layout_of(Scene const&);

/// Returns the name of the smallest handle kind that the chain needs.
char const* kind_of(ChainSpec const&);
/// Returns how many numbers the acceleration of body k has. It is the number of coordinates of the
/// inboard joint, 3 for a bead, and 6 for a free or linked rigid body.
int accelerations_of(ChainSpec const&, std::size_t k);

/// Returns the largest difference of the joint accelerations from the reference, relative to the
/// reference's largest. Angular accelerations of joints, those of prismatic joints, linear
/// accelerations of free bases and accelerations of beads are compared class by class. The result
/// is the largest of the classes. Precondition: both layouts are equal.
double largest_difference(Scene const&, Solution const& found,
                          std::vector<double> const& reference);

}  // namespace catena
