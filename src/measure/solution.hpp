// Accelerations and joint forces as the contract names them, body by body in the order of the
// scene.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "integrate/chain_system.hpp"

namespace catena {

/// On rank 0; empty on the others. Body b's numbers are entries [offset[b], offset[b + 1]).
struct Solution {
    /// Second derivatives of the joint's coordinates (universal 2, weld none); spherical:
    /// derivative of the components of qd (B); free: {alpha (B), acceleration of the origin (W)};
    /// link: the bead's acceleration (W), a rigid body's {alpha (B), of its centre of mass (W)}.
    std::vector<double> acceleration;
    std::vector<std::int64_t> acceleration_offset;
    /// Constraint wrench [torque, force] on body b at its inboard joint (W); link: its tension,
    /// positive when it pulls its ends together (0 where bead 1 of a free chain has none).
    std::vector<double> joint_force;
    std::vector<std::int64_t> force_offset;
    std::vector<TipForce> tip_force;      // one a chain whose tip is jointed, in scene order
    std::vector<Vec3> bead_acceleration;  // of the beads alone, W
    std::vector<Vec3> bead_force;         // OpenMM's on the beads, W; empty without OpenMM
};

/// Of the last evaluate(). Collective.
Solution solution_of(ChainSystem&);
/// Its acceleration_offset alone.
Solution layout_of(Scene const&);

/// Smallest handle kind that holds the chain.
char const* kind_of(ChainSpec const&);
/// Numbers in the acceleration of body k: as many as its inboard joint has coordinates; 3 of a
/// bead; 6 of a free or linked rigid body.
int accelerations_of(ChainSpec const&, std::size_t k);

/// Writes /accelerations, /joint_forces (both flat), /offsets ([bodies + 1][2]: where a body's
/// numbers begin in the one and the other), /tip_forces ([tips][6]) and /tip_chains ([tips], from
/// 0). Throws ComputationError naming file and cause. The first of the two tells beforehand, by
/// InputError, what is no regular file, and "built without HDF5" where it is absent.
void require_accelerations_writer(std::string const& file);
void write_accelerations(std::string const& file, Solution const&);

/// Largest difference of the joint accelerations from the reference, relative to the largest of the
/// reference: taken for joints' angular accelerations, linear accelerations of free bases and
/// accelerations of beads one by one, the worst of them. Equal layouts are a precondition.
double largest_difference(Scene const&, Solution const& found,
                          std::vector<double> const& reference);

}  // namespace catena
