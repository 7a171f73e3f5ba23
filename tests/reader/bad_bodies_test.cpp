// Bodies and their joints that are wrong in themselves. Every message whole.
#include "tests/reader/refusal.hpp"

namespace catena::test {
namespace {

Refusal const bodies_cases[] = {
    {"no_bodies", "chains: [{base: fixed, bodies: []}]",
     "the list of bodies is empty (s.yaml: chains[0].bodies, line 1): give at least one body"},
    {"body_is_text", "chains: [{base: fixed, bodies: [rod]}]",
     "`rod` is not a map (s.yaml: chains[0].bodies[0], body 1, line 1): give a map with keys among "
     "`mass`, `com`, `inertia`, `joint`, "
     "`parent`, `wrench`, `drag`, `force`, `beads`"},
    {"no_mass",
     "chains: [{base: fixed, bodies: [{inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, "
     "1]}}]}]",
     "key `mass` is missing (s.yaml: chains[0].bodies[0], body 1, line 1): add `mass: 1.0`"},
    {"zero_mass", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 0, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "mass 0 is not positive (s.yaml: chains[0].bodies[1].mass, body 2, line 5): give a number "
     "above 0"},
    {"negative_mass", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: -2, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "mass -2 is not positive (s.yaml: chains[0].bodies[1].mass, body 2, line 5): give a number "
     "above 0"},
    {"no_inertia",
     "chains: [{base: fixed, bodies: [{mass: 1, joint: {type: revolute, axis: [0, 0, 1]}}]}]",
     "key `inertia` is missing (s.yaml: chains[0].bodies[0], body 1, line 1): add `inertia: [[1, "
     "0, 0], [0, 1, 0], [0, 0, 1]]`"},
    {"asymmetric_inertia", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [[1, 0.1, 0], [0.2, 1, 0], [0, 0, 1]], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "the inertia is not symmetric: entries (1,2) and (2,1) are 0.1 and 0.2 (s.yaml: "
     "chains[0].bodies[1].inertia, body 2, line 5): give "
     "both the same value"},
    {"indefinite_inertia", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [[1, 2, 0], [2, 1, 0], [0, 0, 1]], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "the inertia is not positive definite: its smallest principal moment is -1 (s.yaml: "
     "chains[0].bodies[1].inertia, body 2, line 5): "
     "check the signs: off-diagonal entries are minus the products of inertia"},
    {"triangle_inequality", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [[1, 0, 0], [0, 1, 0], [0, 0, 2.1]], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "the principal moments 1, 1, 2.1 violate the triangle inequality of rigid bodies (s.yaml: "
     "chains[0].bodies[1].inertia, body 2, line 5): the largest may not exceed the sum of the "
     "other two"},
    {"thin_rod", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [[0, 0, 0], [0, 1, 0], [0, 0, 1]], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "the inertia is singular: its principal moments are 0, 1, 1 (s.yaml: "
     "chains[0].bodies[1].inertia, body 2, line 5): give the point "
     "mass or thin rod a bead radius r: add 0.4 m r^2 to the diagonal"},
    {"point_mass", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [0, 0, 0], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "the inertia is singular: its principal moments are 0, 0, 0 (s.yaml: "
     "chains[0].bodies[1].inertia, body 2, line 5): give the point "
     "mass or thin rod a bead radius r: add 0.4 m r^2 to the diagonal"},
    {"inertia_of_two_rows", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [[1, 0, 0], [0, 1, 0]], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "the matrix has 2 rows, not 3 (s.yaml: chains[0].bodies[1].inertia, body 2, line 5): give 3 "
     "rows of 3 numbers"},
    {"inertia_short_row", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [[1, 0, 0], [0, 1, 0], [0, 1]], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "the list has 2 entries, not 3 (s.yaml: chains[0].bodies[1].inertia[2], body 2, line 5): give "
     "3 numbers in brackets"},
    {"inertia_text", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: round, joint: {type: revolute, axis: [0, 0, 1]}})y",
     "`round` is not a list (s.yaml: chains[0].bodies[1].inertia, body 2, line 5): give 3 rows of "
     "3 numbers"},
    {"unknown_wrench_part", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}, wrench: {moment: [0, 0, 0]}})y",
     "unknown key `moment` (s.yaml: chains[0].bodies[1].wrench.moment, body 2, line 5): use one of "
     "`torque`, `force`"},
};
INSTANTIATE_TEST_SUITE_P(Bodies, Refused, testing::ValuesIn(bodies_cases), name_of_case);

Refusal const joints_cases[] = {
    {"no_joint",
     "chains: [{base: fixed, bodies: [{mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: "
     "[0, 0, 1]}}, {mass: 1, inertia: [1, 1, "
     "1]}]}]",
     "key `joint` is missing (s.yaml: chains[0].bodies[1], body 2, line 1): add `joint: {type: "
     "revolute, axis: [0, 0, 1]}`"},
    {"no_type", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {axis: [0, 0, 1]}})y",
     "key `type` is missing (s.yaml: chains[0].bodies[1].joint, body 2, line 5): add `type: "
     "revolute`"},
    {"unknown_type", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: spherial}})y",
     "`spherial` is not a value of `type` (s.yaml: chains[0].bodies[1].joint.type, body 2, line "
     "5): did you mean `spherical`?"},
    {"revolute", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: ball-and-socket}})y",
     "`ball-and-socket` is not a value of `type` (s.yaml: chains[0].bodies[1].joint.type, body 2, "
     "line 5): use one of `free`, `link`, "
     "`revolute`, `planar`, `universal`, `spherical`, `prismatic`, `helical`, `cylindrical`, "
     "`planar3`, `weld`"},
    {"zero_axis", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 0]}})y",
     "the axis is zero (s.yaml: chains[0].bodies[1].joint.axis, body 2, line 5): give a direction "
     "such as [0, 0, 1]"},
    {"no_axis", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute}})y",
     "key `axis` is missing (s.yaml: chains[0].bodies[1].joint, body 2, line 5): add `axis: [0, 0, "
     "1]`"},
    {"axis_of_spherical", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: spherical, axis: [0, 0, 1]}})y",
     "key `axis` does not apply to a spherical joint (s.yaml: chains[0].bodies[1].joint.axis, body "
     "2, line 5): leave it out or correct `type`"},
    {"quaternion_norm", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: spherical, q: [1, 0, 0, 0.1]}})y",
     "the quaternion is not a unit quaternion: its norm is 1.00498756 (s.yaml: "
     "chains[0].bodies[1].joint.q, body 2, line 5): normalise it: "
     "divide its four numbers by their norm"},
    {"quaternion_length", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: spherical, q: [1, 0, 0]}})y",
     "the list has 3 entries, not 4 (s.yaml: chains[0].bodies[1].joint.q, body 2, line 5): give 4 "
     "numbers in brackets"},
    {"rest_norm", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: spherical, rest: [0, 0, 0, 0]}})y",
     "the quaternion is not a unit quaternion: its norm is 0 (s.yaml: "
     "chains[0].bodies[1].joint.rest, body 2, line 5): normalise it: "
     "divide its four numbers by their norm"},
    {"skew_rotation", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: spherical, rotation: [[1, 0.1, 0], [0, 1, 0], [0, 0, 1]]}})y",
     "the rotation is not orthonormal: R^T R differs from 1 by 0.1 (s.yaml: "
     "chains[0].bodies[1].joint.rotation, body 2, line 5): give unit "
     "columns at right angles"},
    {"left_handed", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: spherical, rotation: [[1, 0, 0], [0, 1, 0], [0, 0, -1]]}})y",
     "the rotation is left-handed: its determinant is -1 (s.yaml: "
     "chains[0].bodies[1].joint.rotation, body 2, line 5): change the sign of "
     "one column"},
    {"angle_of_spherical", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: spherical, q: 0.3}})y",
     "`0.3` is not a list (s.yaml: chains[0].bodies[1].joint.q, body 2, line 5): give 4 numbers in "
     "brackets"},
    {"negative_stiffness", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1], stiffness: -1}})y",
     "stiffness -1 is negative (s.yaml: chains[0].bodies[1].joint.stiffness, body 2, line 5): give "
     "0 or a positive number"},
    {"negative_damping", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: spherical, damping: [1, -1, 0]}})y",
     "damping -1 is negative (s.yaml: chains[0].bodies[1].joint.damping, body 2, line 5): give 0 "
     "or positive numbers"},
    {"free_in_chain", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: free}})y",
     "a free joint inside a chain (s.yaml: chains[0].bodies[1].joint, body 2, line 5): use it for "
     "body 1 of a chain with `base: free`"},
    {"free_on_fixed",
     "chains: [{base: fixed, bodies: [{mass: 1, inertia: [1, 1, 1], joint: {type: free}}]}]",
     "a free joint on a fixed base (s.yaml: chains[0].bodies[0].joint, body 1, line 1): write "
     "`base: free`, or give joint 1 another type"},
    {"joint_on_free_base",
     "chains: [{base: free, bodies: [{mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: "
     "[0, 0, 1]}}]}]",
     "a revolute joint 1 on a free base, which has no joint 1 (s.yaml: chains[0].bodies[0].joint, "
     "body 1, line 1): write `base: fixed`, or "
     "`joint: {type: free}` for body 1"},
    {"torque_of_free",
     "chains: [{base: free, bodies: [{mass: 1, inertia: [1, 1, 1], joint: {type: free, torque: "
     "1}}]}]",
     "key `torque` does not apply to a free joint (s.yaml: chains[0].bodies[0].joint.torque, body "
     "1, line 1): leave it out or correct `type`"},
    {"free_quaternion",
     "chains: [{base: free, bodies: [{mass: 1, inertia: [1, 1, 1], joint: {type: free, q: "
     "{quaternion: [2, 0, 0, 0]}}}]}]",
     "the quaternion is not a unit quaternion: its norm is 2 (s.yaml: "
     "chains[0].bodies[0].joint.q.quaternion, body 1, line 1): normalise "
     "it: divide its four numbers by their norm"},
};
INSTANTIATE_TEST_SUITE_P(Joints, Refused, testing::ValuesIn(joints_cases), name_of_case);

}  // namespace
}  // namespace catena::test
