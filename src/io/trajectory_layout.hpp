// What a Catena trajectory holds, by name: H5MD 1.1
// (https://www.nongnu.org/h5md/releases/h5md-1.1.0.html) and Catena's own group.
//
//   /h5md                         version [1, 1], author, creator "catena", modules/units
//   /particles/trajectory         one site a bead, carried or not, or body without beads, in the
//   order of the topology
//       box                       dimension, boundary; edges when periodic
//       position, velocity        {step, time, value [frames][sites][3]}, ground axes, unwrapped
//       mass, id                  [sites], id from 1
//   /catena                       format_version, title, length_unit: texts of fixed length
//       chains                    first, count, beads, ring, name: [chains]
//       orientation               {step, time, value [frames][bodies][4]}: w x y z, body axes to
//       ground axes; site [bodies] from 0, the
//                                 body's or that of its first bead
//       body_position, body_velocity, angular_velocity
//                                 with output.coordinates: {step, time, value [frames][bodies][3]},
//                                 in the order of orientation: of the centre of mass in ground
//                                 axes; angular velocity in body axes
//       joint_position            {step, time, value [frames][bodies][4]}, with output.coordinates
//       in joint coordinates: as a joint's `q` in
//                                 a scene: angle or shift, two angles, or w x y z (spherical,
//                                 free); the rest of the four is 0
//       joint_rate                the same for `qd`: value [frames][bodies][3]
//       joint_torque, joint_force {step, time, value [frames][sites][3]}, on each body (at its
//       first site) at its inboard joint, ground
//                                 axes
//       tip_torque, tip_force     {step, time, value [frames][tips][3]}, on the last body of each
//       chain with a joint from there to the
//                                 ground, at that joint, ground axes; chain [tips] from 0
//
// All steps are one dataset and all times another, linked hard from each element, so the elements
// cannot disagree. MDAnalysis 2.11 wants exactly one group in /particles, named `trajectory`, and
// `unit` attributes of variable length. `units: si` writes the units as they are (m, s, m s-1, N):
// MDAnalysis 2.11 knows no metre and refuses such a file, h5py reads it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/hdf5_data.hpp"
#include "io/output.hpp"

namespace catena::hdf5 {

/// What of the optional parts a trajectory has.
struct TrajectoryContents {
    bool velocities = false, joint_forces = false, periodic = false, si = false,
         body_states = false, joint_states = false;
    hsize_t sites = 0, bodies = 0, tips = 0;

    std::int64_t bytes_of_frame() const {
        hsize_t const of_site = 3 + (velocities ? 3 : 0) + (joint_forces ? 6 : 0);
        hsize_t const of_body = 4 + (body_states ? 9 : 0) + (joint_states ? 7 : 0);
        return static_cast<std::int64_t>(sizeof(double) * (sites * of_site + of_body * bodies));
    }
};
TrajectoryContents contents_of(Topology const&, bool velocities, bool joint_forces);

/// The growing datasets; those that a run does not write are empty.
struct TrajectorySeries {
    Series step, time, position, velocity, edges, orientation, torque, force, tip_torque, tip_force;
    Series body_position, body_velocity, angular_velocity, joint_position, joint_rate;

    /// `step` is the last: a frame counts when its step is there.
    std::vector<Series*> present();
};

TrajectorySeries create_trajectory(Place const& root, Topology const&, TrajectoryContents const&);

/// Opens what create_trajectory made. InputError when the file is another program's or holds other
/// things than `contents`.
TrajectorySeries open_trajectory(Place const& root, TrajectoryContents const&);

}  // namespace catena::hdf5
