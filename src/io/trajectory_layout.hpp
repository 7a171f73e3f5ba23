// Contents of a Catena trajectory, by name: H5MD 1.1
// (https://www.nongnu.org/h5md/releases/h5md-1.1.0.html) and Catena's own group. An element is a
// group {step, time, value}; shapes are those of its dataset value.
//
//   /h5md                         version [1, 1], author, creator "catena", modules/units
//   /particles/trajectory         sites in the order of the topology: beads, carried or not, and
//                                 bodies without beads
//       box                       dimension, boundary; edges if periodic
//       position, velocity        [frames][sites][3], ground axes, unwrapped
//       mass, id                  [sites], id from 1
//   /connectivity/bonds           [bonds][2], if a chain is branched or cross-linked: ids of the
//                                 bonded sites
//   /catena                       format_version, title, length_unit: texts of fixed length
//       chains                    first, count, beads, ring, name: [chains]; with replicas
//                                 replica, from 1
//       members                   if a structure file names residues: identifier, chain [members];
//                                 member, place, number [sites]: index of the site's member, its
//                                 place along the member from 0, its residue number in the file
//       parent                    [sites], if a chain is branched: number of the site on which each
//                                 hangs, from 0 within its chain; -1 for the chain's first
//       crosslinks                if there are any: their sites in pairs, from 0
//       orientation               [frames][bodies][4]: w x y z, body axes to ground axes;
//                                 site [bodies] from 0: the body's site or its first bead's
//       body_position, body_velocity, angular_velocity
//                                 [frames][bodies][3], with output.coordinates, in the order of
//                                 orientation: centre of mass in ground axes; angular velocity in
//                                 body axes
//       joint_position            [frames][bodies][4], with output.coordinates in joint
//                                 coordinates: a joint's `q` in a scene, i.e. angle or shift, two
//                                 angles, or w x y z (spherical, free); unused entries are 0
//       joint_rate                [frames][bodies][3]: a joint's `qd` in a scene
//       joint_torque, joint_force [frames][sites][3], on each body (at its first site) at its
//                                 inboard joint, ground axes
//       tip_torque, tip_force     [frames][tips][3], on the last body of each chain with a joint
//                                 to the ground, at that joint, ground axes; chain [tips] from 0
//
// All steps are one dataset and all times another, hard-linked from each element, so that elements
// cannot disagree. MDAnalysis 2.11 requires exactly one group in /particles, named `trajectory`,
// and `unit` attributes of variable length. `units: si` writes SI units (m, s, m s-1, N):
// MDAnalysis 2.11 knows no metre and refuses such a file; h5py reads it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/hdf5_data.hpp"
#include "io/output.hpp"

namespace catena::hdf5 {

/// Optional parts and array sizes of a trajectory.
struct TrajectoryContents {
    /// `body_states`: positions, velocities and angular velocities of bodies; `joint_states`: joint
    /// coordinates and rates.
    bool velocities = false, joint_forces = false, periodic = false, si = false,
         body_states = false, joint_states = false;
    hsize_t sites = 0, bodies = 0, tips = 0;

    /// Bytes of a frame's arrays of sites and bodies.
    std::int64_t bytes_of_frame() const {
        hsize_t const of_site = 3 + (velocities ? 3 : 0) + (joint_forces ? 6 : 0);
        hsize_t const of_body = 4 + (body_states ? 9 : 0) + (joint_states ? 7 : 0);
        return static_cast<std::int64_t>(sizeof(double) * (sites * of_site + of_body * bodies));
    }
};
/// Derives the contents from a topology and a run's output options.
TrajectoryContents contents_of(Topology const&, bool velocities, bool joint_forces);

/// Growing datasets of a trajectory. Those that a run does not write are empty.
struct TrajectorySeries {
    Series step, time, position, velocity, edges, orientation, torque, force, tip_torque, tip_force;
    Series body_position, body_velocity, angular_velocity, joint_position, joint_rate;

    /// Returns the datasets that are not empty, `step` last: a frame is valid once its step is
    /// written.
    std::vector<Series*> present();
};

/// Creates the groups and datasets of a new file.
TrajectorySeries create_trajectory(Place const& root, Topology const&, TrajectoryContents const&);

/// Opens a file that create_trajectory() made. Throws InputError if another program wrote the file
/// or its contents differ from `contents`.
TrajectorySeries open_trajectory(Place const& root, TrajectoryContents const&);

}  // namespace catena::hdf5
