// The maps that a scene may hold, each with its declared keys.
#pragma once

#include "keys/key.hpp"

namespace catena::scene::keys {

/// The scene file itself, and its sections. `drag` also is a key of rigid bodies, `place` one of
/// chains.
extern KeyMap const top, box, cubic, place, slab, region, start, forces, drag, openmm, dynamics,
    solver, output;

/// An entry of `chains`, its start from a file, its rigid domains, and its tip: a joint to the
/// ground or to body 1.
extern KeyMap const chain, model, conformation, rigid, tip, tip_joint, tip_ring;

/// An entry of a chain's `loops`, and its joint.
extern KeyMap const loop, loop_joint;

/// An entry of `bodies` that is a rigid body on a joint, and the maps that it may hold.
extern KeyMap const body, wrench, carried_bead, joint, free_pose, free_rates, motion;

/// An entry of `bodies` that is a point bead, and the link to the bead before it.
extern KeyMap const bead, bead_link;

/// An entry of `bodies` in a chain of rigid bodies and beads on links, and its link.
extern KeyMap const linked, link;

/// `bodies` in a file, and the datasets of that file.
extern KeyMap const hdf5, datasets;

/// The kinds of generators, the parameters of each, and the distributions of sizes and masses.
extern KeyMap const generator, random, pendulum, coil, dill, elastic_rod, polygon, freely_jointed,
    worm_like, star, brush, dendrimer, random_tree, distribution;

/// Returns all maps above, those of one page of the manual after each other.
std::span<KeyMap const* const> all();

}  // namespace catena::scene::keys
