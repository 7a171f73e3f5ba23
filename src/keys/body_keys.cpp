// Declares the keys of bodies written one by one, of their joints, and the datasets of bodies in a
// file.
#include "keys/maps.hpp"

namespace catena::scene::keys {
namespace {

// Keys that several maps share.
constexpr Key body_mass{"mass",     "number > 0", "required", "mass", "The body has this mass.",
                        "mass: 1.2"};
constexpr Key com{"com",
                  "3 numbers",
                  "`[0, 0, 0]`",
                  "length",
                  "The centre of mass is here in B.",
                  "com: [0, 0, -0.2]"};
constexpr Key carried{
    "beads",
    "list of maps",
    "none",
    "",
    "The body carries these points, on which OpenMM's forces act; they add no mass.",
    "beads: [{residue: ALA, position: [0, 0, 0.1], mass: 71}]"};
constexpr Key position{"position",
                       "3 numbers",
                       "required",
                       "length",
                       "The bead stands here in W; neighbours may not coincide.",
                       "position: [0, 0, 0]"};
constexpr Key velocity{"velocity",
                       "3 numbers",
                       "`[0, 0, 0]`",
                       "length / time",
                       "The bead or centre of mass has this velocity in W; one given velocity "
                       "makes the whole chain start as given.",
                       "velocity: [0, 0, 1]"};
constexpr Key residue{
    "residue",     "text", "`UNK`", "", "Topology and force field know the bead by this name.",
    "residue: ALA"};
constexpr Key force{"force",
                    "3 numbers",
                    "`[0, 0, 0]`",
                    "energy / length",
                    "This constant force acts on the bead or at the centre of mass, in W; its "
                    "energy counts.",
                    "force: [0, 0, 5]"};
constexpr Key link_type{"type",      "`link`", "required", "", "The body hangs on a rigid link.",
                        "type: link"};
constexpr std::string_view as_coordinate = "radians or length";

constexpr Key body_keys[] = {
    body_mass,
    com,
    {"inertia", "3 rows of 3 numbers, or 3 numbers of a diagonal", "required", "mass length^2",
     "The body has this inertia tensor about its centre of mass, in B.",
     "inertia: [0.1, 0.2, 0.2]"},
    {"joint", "map", "required but for body 1 of a free base", "",
     "This joint connects the body to the one it hangs on.", "joint: {type: spherical}"},
    {"parent", "integer, 1 to the body's number less 1", "the body before", "",
     "The body hangs on the body with this number, counted from 1; body 1 takes 0.", "parent: 3"},
    {"wrench", "map", "none", "", "A constant torque and force act on the body.",
     "wrench: {force: [0, 0, -5]}"},
    {"drag", "map", "that of `forces`", "", "Viscous drag acts on this body.",
     "drag: {linear: 0.2}"},
    force,
    carried,
};

constexpr Key wrench_keys[] = {
    {"torque", "3 numbers", "`[0, 0, 0]`", "energy", "This torque acts on the body, in W.",
     "torque: [0, 0, 1]"},
    {"force", "3 numbers", "`[0, 0, 0]`", "energy / length",
     "This force acts at the centre of mass, in W.", "force: [0, 0, -5]"},
};

constexpr Key carried_keys[] = {
    residue,
    {"position", "3 numbers", "required", "length",
     "The bead stands here in B, from the body's origin.", "position: [0, 0, 0.1]"},
    {"mass", "number > 0", "the residue's in CALVADOS 2, else 1", "mass",
     "Topology and force field take this mass; the body's own decides the motion.", "mass: 71"},
};

constexpr Key joint_keys[] = {
    {"type",
     "`free`, `link`, `revolute`, `planar`, `universal`, `spherical`, `prismatic`, `helical`, "
     "`cylindrical`, `planar3`, `weld`",
     "required", "", "The joint leaves the motions of this type free.", "type: revolute"},
    {"axis", "3 numbers, not all 0",
     "required by `revolute`, `planar`, `prismatic`, `helical`, `cylindrical`", "",
     "The axis has this direction, the same in B and in J; it is normalised.", "axis: [0, 0, 1]"},
    {"axes", "2 axes", "required by `universal`, `planar3`", "",
     "The first axis is fixed in J, the second in B, not parallel; of `planar3` the direction of "
     "q[0] and the normal.",
     "axes: [[1, 0, 0], [0, 1, 0]]"},
    {"pitch", "number, not 0", "required by `helical`", "length / radian",
     "The body shifts along `axis` by this much per radian.", "pitch: 0.1"},
    {"rotation", "3 rows of 3 numbers", "identity", "",
     "This rotation matrix is the orientation of J in the inboard body; for joint 1, in the "
     "ground."},
    {"translation", "3 numbers", "`[0, 0, 0]`", "length",
     "J has its origin here in the inboard body.", "translation: [0, 0, -0.4]"},
    {"q", "number; `universal`, `cylindrical` 2; `planar3` 3; `spherical` 4; `free` map",
     "0; identity", as_coordinate, "B stands at this position in J at the start.", "q: 0.3"},
    {"qd", "number; `universal`, `cylindrical` 2; `planar3`, `spherical` 3; `free` map", "0",
     "that of `q` / time", "The position changes at this rate at the start.", "qd: 0.1"},
    {"torque", "number; `universal` 1 or 2; `cylindrical` 2; `planar3`, `spherical` 3", "0",
     "energy; energy / length where `q` is a length",
     "This torque or force acts along each coordinate, and its reaction on the inboard body.",
     "torque: 0.5"},
    {"stiffness",
     "number >= 0; `universal` 1 or 2; `cylindrical` 2; `planar3` 3; `spherical` 1 or 3", "0",
     "energy / radian^2; energy / length^2 where `q` is a length",
     "A spring of this stiffness acts along each coordinate.", "stiffness: 40"},
    {"damping", "as `stiffness`", "0", "that of `torque` / that of `qd`",
     "A damper acts against `qd`.", "damping: 0.2"},
    {"rest", "as `q`; `universal` 1 or 2; not `free`", "0; identity", as_coordinate,
     "The spring is relaxed here.", "rest: 0.5"},
    {"motion", "map; `universal`, `cylindrical`: list of 2 maps", "none", "",
     "The coordinate follows this function of time, whatever the forces.", "motion: {rate: 6.28}"},
};

constexpr Key pose_keys[] = {
    {"position", "3 numbers", "`[0, 0, 0]`", "length", "The body's origin stands here in W.",
     "position: [0, 0, 1]"},
    {"quaternion", "4 numbers", "`[1, 0, 0, 0]`", "",
     "This unit quaternion w, x, y, z is the orientation of B in W.", "quaternion: [1, 0, 0, 0]"},
};

constexpr Key rate_keys[] = {
    {"omega", "3 numbers", "`[0, 0, 0]`", "radians / time",
     "The body has this angular velocity, in B.", "omega: [0, 0, 1]"},
    {"velocity", "3 numbers", "`[0, 0, 0]`", "length / time",
     "The body's origin has this velocity, in W.", "velocity: [0, 0, 1]"},
};

constexpr Key motion_keys[] = {
    {"offset", "number", "0", as_coordinate, "The motion is about this position.", "offset: 0.1"},
    {"rate", "number", "0", "that of `offset` / time", "The position grows at this rate.",
     "rate: 6.28"},
    {"amplitude", "number", "0", as_coordinate, "A sine of this amplitude is added.",
     "amplitude: 0.5"},
    {"frequency", "number", "0", "1 / time", "The sine has this frequency.", "frequency: 2"},
    {"phase", "number", "0", "radians", "The sine has this phase at time 0.", "phase: 1.57"},
};

constexpr Key bead_keys[] = {
    body_mass,
    position,
    velocity,
    residue,
    force,
    {"joint", "`{type: link}`", "required but for bead 1", "",
     "This link connects the bead to the one it hangs on.", "joint: {type: link}"},
    {"parent", "integer, 1 to the bead's number less 1", "the bead before", "",
     "The bead hangs on the bead with this number, counted from 1; bead 1 takes 0.", "parent: 3"},
};

constexpr Key bead_link_keys[] = {
    link_type,
    {"length", "number > 0", "the distance in the positions", "length",
     "The link is this long; that of bead 1 begins at `anchor`.", "length: 0.38"},
};

constexpr Key linked_keys[] = {
    body_mass,
    {"inertia", "3 rows of 3 numbers, or 3 numbers of a diagonal", "none: a bead", "mass length^2",
     "The entry is a rigid body with this inertia about its centre of mass, in B.",
     "inertia: [400, 500, 600]"},
    com,
    {"position", "3 numbers", "required", "length",
     "The body's origin stands here in W, which is where its link ends.", "position: [0, 0, 0]"},
    {"quaternion", "4 numbers", "`[1, 0, 0, 0]`", "",
     "This unit quaternion w, x, y, z is the orientation of B in W.", "quaternion: [1, 0, 0, 0]"},
    velocity,
    {"omega", "3 numbers", "`[0, 0, 0]`", "radians / time",
     "A rigid body has this angular velocity, in B.", "omega: [0, 0, 0.1]"},
    residue,
    force,
    carried,
    {"joint", "map", "required but for body 1", "",
     "This link connects the body to the one before it.", "joint: {type: link, length: 0.4}"},
};

constexpr Key link_keys[] = {
    link_type,
    {"length", "number > 0", "the distance at the start", "length",
     "The link is this long, to 1e-9 of the distance at the start.", "length: 0.4"},
    {"translation", "3 numbers", "`[0, 0, 0]`", "length",
     "The link starts here in the inboard body; a bead has no such key.", "translation: [1, 0, 0]"},
};

constexpr Key hdf5_keys[] = {
    {"hdf5", "path", "required", "", "Rigid bodies are read from the datasets of this HDF5 file.",
     "hdf5: chain.h5"},
};

constexpr Key dataset_keys[] = {
    {"mass", "[n]", "required", "mass", "Bodies have these masses, above 0."},
    {"com", "[n, 3]", "0", "length", "Centres of mass are here in B."},
    {"inertia", "[n, 3, 3] or [n, 6]", "required", "mass length^2",
     "Six numbers are xx, yx, yy, zx, zy, zz of the tensor about the centre of mass."},
    {"joint_type", "[n]", "required", "",
     "Names, or 0 free, 2 spherical, 3 revolute, 4 universal, 5 weld, 6 prismatic, 7 helical, 8 "
     "cylindrical, 9 planar3, say the type of each joint."},
    {"parent", "[n]", "the body before", "",
     "Bodies hang on the bodies with these numbers, counted from 1; body 1 takes 0."},
    {"axis", "[n, 3]", "required if a joint has one", "",
     "Joints have these axes; of universal joints it is the second, of planar3 joints the normal."},
    {"rotation", "[n, 3, 3]", "identity", "",
     "Rotation matrices are the orientations of J in the inboard body."},
    {"translation", "[n, 3]", "0", "length", "J has its origin here in the inboard body."},
    {"q", "[n, 4]", "0; identity", as_coordinate,
     "A row begins with one number per coordinate, or a quaternion w, x, y, z; the rest means "
     "nothing."},
    {"qd", "[n, 3]", "0", "that of `q` / time", "A row begins with one rate per coordinate."},
    {"first_axis", "[n, 3]", "required by universal and planar3 joints", "",
     "Universal joints have this first axis, in J; planar3 joints translate by q[0] along it."},
    {"pitch", "[n]", "required by helical joints", "length / radian",
     "Helical joints shift by this much per radian."},
    {"torque", "[n, 3]", "0", "energy; energy / length where `q` is a length",
     "A row begins with one torque per coordinate."},
    {"stiffness", "[n, 3]", "0", "energy / radian^2; energy / length^2 where `q` is a length",
     "A row begins with one stiffness per coordinate."},
    {"damping", "[n, 3]", "0", "that of `torque` / that of `qd`",
     "A row begins with one damping per coordinate."},
    {"rest", "[n, 4]", "0; identity", as_coordinate, "Springs are relaxed here, written as `q`."},
    {"wrench", "[n, 6]", "0", "energy; energy / length",
     "A row is the torque and the force on a body, in W."},
    {"drag", "[n, 2]", "that of `forces`", "mass / time; mass length^2 / time",
     "A row is the linear and the angular drag of a body."},
    {"force", "[n, 3]", "0", "energy / length",
     "A row is the constant force at the centre of mass of a body, in W; its energy counts."},
    {"free_position", "[3]", "0", "length", "Body 1 of a free base has its origin here in W."},
    {"free_velocity", "[3]", "0", "length / time",
     "The origin of body 1 of a free base has this velocity, in W."},
};

}  // namespace

constinit KeyMap const body{"bodies", "chains[i].bodies[k], a rigid body on a joint", body_keys};
constinit KeyMap const wrench{"bodies.wrench", "chains[i].bodies[k].wrench", wrench_keys};
constinit KeyMap const carried_bead{"bodies.beads", "chains[i].bodies[k].beads[j]", carried_keys};
constinit KeyMap const joint{"bodies.joint", "chains[i].bodies[k].joint of a rigid body",
                             joint_keys};
constinit KeyMap const free_pose{"bodies.joint.q", "chains[i].bodies[0].joint.q of `type: free`",
                                 pose_keys};
constinit KeyMap const free_rates{"bodies.joint.qd", "chains[i].bodies[0].joint.qd of `type: free`",
                                  rate_keys};
constinit KeyMap const motion{"bodies.joint.motion", "chains[i].bodies[k].joint.motion",
                              motion_keys};
constinit KeyMap const bead{"beads", "chains[i].bodies[k], a bead in a chain of beads", bead_keys};
constinit KeyMap const bead_link{"beads.joint", "chains[i].bodies[k].joint in a chain of beads",
                                 bead_link_keys};
constinit KeyMap const linked{"linked", "chains[i].bodies[k], a body or bead on a link",
                              linked_keys};
constinit KeyMap const link{"linked.joint",
                            "chains[i].bodies[k].joint in a chain of bodies on links", link_keys};
constinit KeyMap const hdf5{"bodies.hdf5", "chains[i].bodies, a map", hdf5_keys};
constinit KeyMap const datasets{"datasets", "the file that chains[i].bodies.hdf5 names",
                                dataset_keys};

}  // namespace catena::scene::keys
