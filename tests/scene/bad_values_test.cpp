// Values that are wrong in themselves: YAML, keys, numbers, bodies, joints. Every message whole.
#include "tests/scene/refusal.hpp"

namespace catena::test {
namespace {

TEST_P(Refused, in_one_line) {
    std::string const message = refusal_of(GetParam().yaml);
    EXPECT_EQ(message, GetParam().message);
    static std::regex const grammar(R"(not in this version: \S.* \(s\.yaml: .*\)|\S.* \(s\.yaml.*\): \S.*)");
    EXPECT_TRUE(std::regex_match(message, grammar)) << message;
}

Refusal const yaml_cases[] = {
    {"empty_file", "", "the scene is empty (s.yaml): describe at least one chain under `chains:`"},
    {"comments_only", R"y(# nothing
)y",
     "the scene is empty (s.yaml): describe at least one chain under `chains:`"},
    {"syntax_error", R"y(title: a
chains: [
)y",
     "not YAML: end of sequence flow not found (s.yaml: line 3): correct the syntax there or just before"},
    {"bad_indent", R"y(title: a
  b: c
)y",
     "not YAML: illegal map value (s.yaml: line 2): correct the syntax there or just before"},
    {"a_list", R"y(- 1
- 2
)y",
     "the scene is a list, not a map (s.yaml: line 1): write keys such as `chains:` at the left margin"},
    {"duplicate_key", R"y(title: a
box: none
title: b
)y",
     "key `title` is given twice (s.yaml: lines 1 and 3): keep one of them"},
    {"duplicate_in_body", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}, mass: 2})y",
     "key `mass` is given twice (s.yaml: line 5): keep one of them"},
    {"two_documents", R"y(title: a
---
title: b
)y",
     "holds more than one YAML document (s.yaml: line 3): keep one document, without `---`"},
    {"tag", R"y(title: !!str a
)y",
     "YAML tag `tag:yaml.org,2002:str` is not read (s.yaml: line 1): leave the tag out"},
    {"map_as_key", "{[1, 2]: a}", "a key is not plain text (s.yaml: line 1): write `name: value`, and close every bracket"},
    {"alias_to_itself", R"y(title: &a [*a]
)y",
     "an alias refers to the value it stands in (s.yaml: line 1): write the value out"},
    {"control_characters", R"y("ti\ntle": a
)y",
     "unknown key `ti tle` (s.yaml: ti tle, line 1): did you mean `title`?"},
};
INSTANTIATE_TEST_SUITE_P(Yaml, Refused, testing::ValuesIn(yaml_cases), name_of_case);

Refusal const keys_cases[] = {
    {"unknown_at_top", "chians: []", "unknown key `chians` (s.yaml: chians, line 1): did you mean `chains`?"},
    {"unknown_far_from_all", "wallpaper: []",
     "unknown key `wallpaper` (s.yaml: wallpaper, line 1): use one of `title`, `units`, `chains`, `box`, `forces`, `dynamics`, `solver`, "
     "`output`"},
    {"unknown_in_chain", "chains: [{sequnce: GGG, model: calvados2}]",
     "unknown key `sequnce` (s.yaml: chains[0].sequnce, line 1): did you mean `sequence`?"},
    {"unknown_in_body", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}, weight: 2})y",
     "unknown key `weight` (s.yaml: chains[0].bodies[1].weight, body 2, line 5): use one of `mass`, `com`, `inertia`, `joint`, `wrench`, "
     "`drag`, `beads`"},
    {"unknown_near_in_body", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}, masss: 2})y",
     "unknown key `masss` (s.yaml: chains[0].bodies[1].masss, body 2, line 5): did you mean `mass`?"},
    {"unknown_in_joint", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axs: [0, 0, 1]}})y",
     "unknown key `axs` (s.yaml: chains[0].bodies[1].joint.axs, body 2, line 5): did you mean `axis`?"},
    {"unknown_in_dynamics", R"y(chains: [{sequence: GGG, model: calvados2}]
dynamics: {integrator: rattle, stp: 1})y",
     "unknown key `stp` (s.yaml: dynamics.stp, line 2): did you mean `step`?"},
    {"unknown_in_openmm", R"y(chains: [{sequence: GGG, model: calvados2}]
forces: {openmm: {bilder: calvados2}})y",
     "unknown key `bilder` (s.yaml: forces.openmm.bilder, line 2): did you mean `builder`?"},
    {"unknown_in_generator", "chains: [{generator: {random: {bodies: 3, joint: link, sed: 3}}}]",
     "unknown key `sed` (s.yaml: chains[0].generator.random.sed, line 1): did you mean `seed`?"},
    {"no_chains", "title: a", "key `chains` is missing (s.yaml): add `chains: [{name: a, sequence: GGG, model: calvados2}]`"},
    {"empty_chains", "chains: []", "the list of chains is empty (s.yaml: chains, line 1): describe at least one chain"},
    {"chains_not_a_list", "chains: 3", "`3` is not a list (s.yaml: chains, line 1): give a list in brackets or with dashes"},
    {"no_value", R"y(chains:
)y",
     "key `chains` has no value (s.yaml: chains, line 1): give one or leave the key out"},
    {"chain_is_text", "chains: [GGG]",
     "`GGG` is not a map (s.yaml: chains[0], line 1): give a map with keys among `name`, `count`, `sequence`, `fasta`, `pdb`, `bodies`, "
     "`generator`, `model`, `positions`, `links`, `base`, `tip`, `anchor`, `conformation`, `rigid`, `velocities`"},
    {"nothing_in_chain", "chains: [{name: a}]",
     "the chain says nothing of its bodies (s.yaml: chains[0], line 1): add one of `sequence`, `fasta`, `pdb`, `bodies`, `generator`"},
    {"two_sources", "chains: [{sequence: GGG, model: calvados2, generator: {pendulum: {links: 2}}}]",
     "the chain has both `sequence` and `generator` (s.yaml: chains[0].generator, line 1): keep one of them"},
    {"same_name_twice", "chains: [{name: a, sequence: G, model: calvados2}, {name: a, sequence: G, model: calvados2}]",
     "two chains are named `a` (s.yaml: chains[1], line 1): give each its own `name`"},
    {"key_for_another_source", "chains: [{generator: {pendulum: {links: 3}}, links: model}]",
     "key `links` means nothing for generator `pendulum` (s.yaml: chains[0].links, line 1): leave it out"},
    {"unit_system", R"y(units: cgs
chains: [{sequence: GGG, model: calvados2}])y",
     "`cgs` is not a value of `units` (s.yaml: units, line 1): use one of `md`, `si`"},
};
INSTANTIATE_TEST_SUITE_P(Keys, Refused, testing::ValuesIn(keys_cases), name_of_case);

Refusal const numbers_cases[] = {
    {"text", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: heavy, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "`heavy` is not a number (s.yaml: chains[0].bodies[1].mass, body 2, line 5): give a finite decimal number such as 0.38"},
    {"half_an_exponent", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1e, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "`1e` is not a number (s.yaml: chains[0].bodies[1].mass, body 2, line 5): give a finite decimal number such as 0.38"},
    {"hexadecimal", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 0x10, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "`0x10` is not a number (s.yaml: chains[0].bodies[1].mass, body 2, line 5): give a finite decimal number such as 0.38"},
    {"trailing_unit", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 3 kg, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "`3 kg` is not a number (s.yaml: chains[0].bodies[1].mass, body 2, line 5): give a finite decimal number such as 0.38"},
    {"quoted", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: "3", inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "`3` in quotes is not a number (s.yaml: chains[0].bodies[1].mass, body 2, line 5): give a finite decimal number such as 0.38"},
    {"nan", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: .nan, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "`.nan` is not finite (s.yaml: chains[0].bodies[1].mass, body 2, line 5): give a finite decimal number such as 0.38"},
    {"nan_word", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: nan, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "`nan` is not finite (s.yaml: chains[0].bodies[1].mass, body 2, line 5): give a finite decimal number such as 0.38"},
    {"infinite", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: -.inf, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "`-.inf` is not finite (s.yaml: chains[0].bodies[1].mass, body 2, line 5): give a finite decimal number such as 0.38"},
    {"too_large", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1e999, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "`1e999` is beyond the range of double precision (s.yaml: chains[0].bodies[1].mass, body 2, line 5): give a finite decimal number "
     "such as 0.38"},
    {"list_for_number", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: [1], inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "a list is not a number (s.yaml: chains[0].bodies[1].mass, body 2, line 5): give a finite decimal number such as 0.38"},
    {"map_for_number", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: {a: 1}, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "a map is not a number (s.yaml: chains[0].bodies[1].mass, body 2, line 5): give a finite decimal number such as 0.38"},
    {"fraction_of_bodies", "chains: [{generator: {random: {bodies: 2.5, joint: link}}}]",
     "`2.5` is not a whole number (s.yaml: chains[0].generator.random.bodies, line 1): give a whole number such as 1000"},
    {"negative_count", "chains: [{sequence: GGG, model: calvados2, count: -1}]",
     "count -1 is below 1 (s.yaml: chains[0].count, line 1): give 1 or more"},
    {"zero_bodies", "chains: [{generator: {random: {bodies: 0, joint: link}}}]",
     "bodies 0 is below 1 (s.yaml: chains[0].generator.random.bodies, line 1): give 1 or more"},
    {"negative_seed", "chains: [{generator: {random: {bodies: 2, joint: link, seed: -1}}}]",
     "`-1` is not a seed (s.yaml: chains[0].generator.random.seed, line 1): give a whole number from 0 to 18446744073709551615"},
    {"seed_too_large", "chains: [{generator: {random: {bodies: 2, joint: link, seed: 18446744073709551616}}}]",
     "`18446744073709551616` is not a seed (s.yaml: chains[0].generator.random.seed, line 1): give a whole number from 0 to "
     "18446744073709551615"},
    {"short_vector", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}, com: [1, 2]})y",
     "the list has 2 entries, not 3 (s.yaml: chains[0].bodies[1].com, body 2, line 5): give 3 numbers in brackets"},
    {"long_vector", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}, com: [1, 2, 3, 4]})y",
     "the list has 4 entries, not 3 (s.yaml: chains[0].bodies[1].com, body 2, line 5): give 3 numbers in brackets"},
    {"vector_not_list", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}, com: 0})y",
     "`0` is not a list (s.yaml: chains[0].bodies[1].com, body 2, line 5): give 3 numbers in brackets"},
    {"text_in_vector", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}, com: [0, up, 0]})y",
     "`up` is not a number (s.yaml: chains[0].bodies[1].com[1], body 2, line 5): give a finite decimal number such as 0.38"},
    {"not_true_or_false", R"y(chains: [{sequence: GGG, model: calvados2}]
output: {velocities: yes})y",
     "`yes` is not true or false (s.yaml: output.velocities, line 2): give true or false"},
};
INSTANTIATE_TEST_SUITE_P(Numbers, Refused, testing::ValuesIn(numbers_cases), name_of_case);

Refusal const bodies_cases[] = {
    {"no_bodies", "chains: [{base: fixed, bodies: []}]",
     "the list of bodies is empty (s.yaml: chains[0].bodies, line 1): give at least one body"},
    {"body_is_text", "chains: [{base: fixed, bodies: [rod]}]",
     "`rod` is not a map (s.yaml: chains[0].bodies[0], body 1, line 1): give a map with keys among `mass`, `com`, `inertia`, `joint`, "
     "`wrench`, `drag`, `beads`"},
    {"no_mass", "chains: [{base: fixed, bodies: [{inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}]}]",
     "key `mass` is missing (s.yaml: chains[0].bodies[0], body 1, line 1): add `mass: 1.0`"},
    {"zero_mass", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 0, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "mass 0 is not positive (s.yaml: chains[0].bodies[1].mass, body 2, line 5): give a number above 0"},
    {"negative_mass", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: -2, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "mass -2 is not positive (s.yaml: chains[0].bodies[1].mass, body 2, line 5): give a number above 0"},
    {"no_inertia", "chains: [{base: fixed, bodies: [{mass: 1, joint: {type: revolute, axis: [0, 0, 1]}}]}]",
     "key `inertia` is missing (s.yaml: chains[0].bodies[0], body 1, line 1): add `inertia: [[1, 0, 0], [0, 1, 0], [0, 0, 1]]`"},
    {"asymmetric_inertia", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [[1, 0.1, 0], [0.2, 1, 0], [0, 0, 1]], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "the inertia is not symmetric: entries (1,2) and (2,1) are 0.1 and 0.2 (s.yaml: chains[0].bodies[1].inertia, body 2, line 5): give "
     "both the same value"},
    {"indefinite_inertia", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [[1, 2, 0], [2, 1, 0], [0, 0, 1]], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "the inertia is not positive definite: its smallest principal moment is -1 (s.yaml: chains[0].bodies[1].inertia, body 2, line 5): "
     "check the signs: off-diagonal entries are minus the products of inertia"},
    {"triangle_inequality", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [[1, 0, 0], [0, 1, 0], [0, 0, 2.1]], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "no rigid body has the principal moments 1, 1, 2.1: they break the triangle inequality (s.yaml: chains[0].bodies[1].inertia, body 2, "
     "line 5): the largest may not exceed the sum of the other two"},
    {"thin_rod", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [[0, 0, 0], [0, 1, 0], [0, 0, 1]], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "the inertia is singular: its principal moments are 0, 1, 1 (s.yaml: chains[0].bodies[1].inertia, body 2, line 5): give the point "
     "mass or thin rod a bead radius r: add 0.4 m r^2 to the diagonal"},
    {"point_mass", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [0, 0, 0], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "the inertia is singular: its principal moments are 0, 0, 0 (s.yaml: chains[0].bodies[1].inertia, body 2, line 5): give the point "
     "mass or thin rod a bead radius r: add 0.4 m r^2 to the diagonal"},
    {"inertia_of_two_rows", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [[1, 0, 0], [0, 1, 0]], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "the matrix has 2 rows, not 3 (s.yaml: chains[0].bodies[1].inertia, body 2, line 5): give 3 rows of 3 numbers"},
    {"inertia_short_row", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [[1, 0, 0], [0, 1, 0], [0, 1]], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "the list has 2 entries, not 3 (s.yaml: chains[0].bodies[1].inertia[2], body 2, line 5): give 3 numbers in brackets"},
    {"inertia_text", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: round, joint: {type: revolute, axis: [0, 0, 1]}})y",
     "`round` is not a list (s.yaml: chains[0].bodies[1].inertia, body 2, line 5): give 3 rows of 3 numbers"},
    {"unknown_wrench_part", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}, wrench: {moment: [0, 0, 0]}})y",
     "unknown key `moment` (s.yaml: chains[0].bodies[1].wrench.moment, body 2, line 5): use one of `torque`, `force`"},
};
INSTANTIATE_TEST_SUITE_P(Bodies, Refused, testing::ValuesIn(bodies_cases), name_of_case);

Refusal const joints_cases[] = {
    {"no_joint",
     "chains: [{base: fixed, bodies: [{mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}, {mass: 1, inertia: [1, 1, "
     "1]}]}]",
     "key `joint` is missing (s.yaml: chains[0].bodies[1], body 2, line 1): add `joint: {type: revolute, axis: [0, 0, 1]}`"},
    {"no_type", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {axis: [0, 0, 1]}})y",
     "key `type` is missing (s.yaml: chains[0].bodies[1].joint, body 2, line 5): add `type: revolute`"},
    {"unknown_type", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: spherial}})y",
     "`spherial` is not a value of `type` (s.yaml: chains[0].bodies[1].joint.type, body 2, line 5): did you mean `spherical`?"},
    {"hinge", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: ball-and-socket}})y",
     "`ball-and-socket` is not a value of `type` (s.yaml: chains[0].bodies[1].joint.type, body 2, line 5): use one of `free`, `link`, "
     "`revolute`, `planar`, `universal`, `spherical`, `prismatic`, `helical`, `weld`"},
    {"zero_axis", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 0]}})y",
     "the axis is zero (s.yaml: chains[0].bodies[1].joint.axis, body 2, line 5): give a direction such as [0, 0, 1]"},
    {"no_axis", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute}})y",
     "key `axis` is missing (s.yaml: chains[0].bodies[1].joint, body 2, line 5): add `axis: [0, 0, 1]`"},
    {"axis_of_spherical", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: spherical, axis: [0, 0, 1]}})y",
     "key `axis` means nothing for a spherical joint (s.yaml: chains[0].bodies[1].joint.axis, body 2, line 5): leave it out or correct "
     "`type`"},
    {"quaternion_norm", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: spherical, q: [1, 0, 0, 0.1]}})y",
     "the quaternion is not a unit quaternion: its norm is 1.00498756 (s.yaml: chains[0].bodies[1].joint.q, body 2, line 5): normalise it: "
     "divide its four numbers by their norm"},
    {"quaternion_length", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: spherical, q: [1, 0, 0]}})y",
     "the list has 3 entries, not 4 (s.yaml: chains[0].bodies[1].joint.q, body 2, line 5): give 4 numbers in brackets"},
    {"rest_norm", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: spherical, rest: [0, 0, 0, 0]}})y",
     "the quaternion is not a unit quaternion: its norm is 0 (s.yaml: chains[0].bodies[1].joint.rest, body 2, line 5): normalise it: "
     "divide its four numbers by their norm"},
    {"skew_rotation", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: spherical, rotation: [[1, 0.1, 0], [0, 1, 0], [0, 0, 1]]}})y",
     "the rotation is not orthonormal: R^T R differs from 1 by 0.1 (s.yaml: chains[0].bodies[1].joint.rotation, body 2, line 5): give unit "
     "columns at right angles"},
    {"left_handed", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: spherical, rotation: [[1, 0, 0], [0, 1, 0], [0, 0, -1]]}})y",
     "the rotation is left-handed: its determinant is -1 (s.yaml: chains[0].bodies[1].joint.rotation, body 2, line 5): change the sign of "
     "one column"},
    {"angle_of_spherical", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: spherical, q: 0.3}})y",
     "`0.3` is not a list (s.yaml: chains[0].bodies[1].joint.q, body 2, line 5): give 4 numbers in brackets"},
    {"negative_stiffness", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1], stiffness: -1}})y",
     "stiffness -1 is negative (s.yaml: chains[0].bodies[1].joint.stiffness, body 2, line 5): give 0 or a number above it"},
    {"negative_damping", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: spherical, damping: [1, -1, 0]}})y",
     "damping -1 is negative (s.yaml: chains[0].bodies[1].joint.damping, body 2, line 5): give 0 or numbers above it"},
    {"free_in_chain", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: free}})y",
     "a free joint inside a chain (s.yaml: chains[0].bodies[1].joint, body 2, line 5): use it for body 1 of a chain with `base: free`"},
    {"free_on_fixed", "chains: [{base: fixed, bodies: [{mass: 1, inertia: [1, 1, 1], joint: {type: free}}]}]",
     "a free joint on a fixed base (s.yaml: chains[0].bodies[0].joint, body 1, line 1): write `base: free`, or give joint 1 another type"},
    {"joint_on_free_base", "chains: [{base: free, bodies: [{mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}]}]",
     "a revolute joint 1 on a free base, which has no joint 1 (s.yaml: chains[0].bodies[0].joint, body 1, line 1): write `base: fixed`, or "
     "`joint: {type: free}` for body 1"},
    {"torque_of_free", "chains: [{base: free, bodies: [{mass: 1, inertia: [1, 1, 1], joint: {type: free, torque: 1}}]}]",
     "key `torque` means nothing for a free joint (s.yaml: chains[0].bodies[0].joint.torque, body 1, line 1): leave it out or correct "
     "`type`"},
    {"free_quaternion",
     "chains: [{base: free, bodies: [{mass: 1, inertia: [1, 1, 1], joint: {type: free, q: {quaternion: [2, 0, 0, 0]}}}]}]",
     "the quaternion is not a unit quaternion: its norm is 2 (s.yaml: chains[0].bodies[0].joint.q.quaternion, body 1, line 1): normalise "
     "it: divide its four numbers by their norm"},
};
INSTANTIATE_TEST_SUITE_P(Joints, Refused, testing::ValuesIn(joints_cases), name_of_case);

}  // namespace
}  // namespace catena::test
