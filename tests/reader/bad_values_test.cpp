// Values that are wrong in themselves: YAML, keys, numbers. Every message whole.
#include "tests/reader/refusal.hpp"

namespace catena::test {
namespace {

Refusal const yaml_cases[] = {
    {"empty_file", "", "the scene is empty (s.yaml): describe at least one chain under `chains:`"},
    {"comments_only", R"y(# nothing
)y",
     "the scene is empty (s.yaml): describe at least one chain under `chains:`"},
    {"syntax_error", R"y(title: a
chains: [
)y",
     "not YAML: end of sequence flow not found (s.yaml: line 3): correct the syntax there or just "
     "before"},
    {"bad_indent", R"y(title: a
  b: c
)y",
     "not YAML: illegal map value (s.yaml: line 2): correct the syntax there or just before"},
    {"a_list", R"y(- 1
- 2
)y",
     "the scene is a list, not a map (s.yaml: line 1): write keys such as `chains:` at the left "
     "margin"},
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
     "YAML tag `tag:yaml.org,2002:str` is not supported (s.yaml: line 1): leave the tag out"},
    {"map_as_key", "{[1, 2]: a}",
     "a key is not plain text (s.yaml: line 1): write `name: value`, and close every bracket"},
    {"alias_to_itself", R"y(title: &a [*a]
)y",
     "an alias refers to the value that contains it (s.yaml: line 1): write the value out"},
    {"control_characters", R"y("ti\ntle": a
)y",
     "unknown key `ti tle` (s.yaml: ti tle, line 1): did you mean `title`?"},
};
INSTANTIATE_TEST_SUITE_P(Yaml, Refused, testing::ValuesIn(yaml_cases), name_of_case);

Refusal const keys_cases[] = {
    {"unknown_at_top", "chians: []",
     "unknown key `chians` (s.yaml: chians, line 1): did you mean `chains`?"},
    {"unknown_far_from_all", "wallpaper: []",
     "unknown key `wallpaper` (s.yaml: wallpaper, line 1): use one of `title`, `units`, `chains`, "
     "`replicas`, `box`, `forces`, `dynamics`, `solver`, "
     "`output`, `relax`, `place`, `start`"},
    {"unknown_in_chain", "chains: [{sequnce: GGG, model: calvados2}]",
     "unknown key `sequnce` (s.yaml: chains[0].sequnce, line 1): did you mean `sequence`?"},
    {"unknown_in_body", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}, weight: 2})y",
     "unknown key `weight` (s.yaml: chains[0].bodies[1].weight, body 2, line 5): use one of "
     "`mass`, `com`, `inertia`, `joint`, `parent`, `wrench`, "
     "`drag`, `force`, `beads`"},
    {"unknown_near_in_body", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}, masss: 2})y",
     "unknown key `masss` (s.yaml: chains[0].bodies[1].masss, body 2, line 5): did you mean "
     "`mass`?"},
    {"unknown_in_joint", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axs: [0, 0, 1]}})y",
     "unknown key `axs` (s.yaml: chains[0].bodies[1].joint.axs, body 2, line 5): did you mean "
     "`axis`?"},
    {"another_word_in_joint", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: prismatic, axis: [0, 0, 1], force: 2}})y",
     "unknown key `force` (s.yaml: chains[0].bodies[0].joint.force, body 1, line 4): did you mean "
     "`torque`?"},
    {"another_word_in_body", R"y(chains:
  - bodies:
      - {mass: 1, inertia: [1, 1, 1], load: [0, 0, 2]})y",
     "unknown key `load` (s.yaml: chains[0].bodies[0].load, body 1, line 3): did you mean "
     "`wrench`?"},
    {"another_word_in_dynamics", R"y(chains: [{sequence: GGG, model: calvados2}]
dynamics: {integrator: rattle, dt: 1})y",
     "unknown key `dt` (s.yaml: dynamics.dt, line 2): did you mean `step`?"},
    {"unknown_in_dynamics", R"y(chains: [{sequence: GGG, model: calvados2}]
dynamics: {integrator: rattle, stp: 1})y",
     "unknown key `stp` (s.yaml: dynamics.stp, line 2): did you mean `step`?"},
    {"unknown_in_openmm", R"y(chains: [{sequence: GGG, model: calvados2}]
forces: {openmm: {bilder: calvados2}})y",
     "unknown key `bilder` (s.yaml: forces.openmm.bilder, line 2): did you mean `builder`?"},
    {"unknown_in_generator", "chains: [{generator: {random: {bodies: 3, joint: link, sed: 3}}}]",
     "unknown key `sed` (s.yaml: chains[0].generator.random.sed, line 1): did you mean `seed`?"},
    {"no_chains", "title: a",
     "key `chains` is missing (s.yaml): add `chains: [{name: a, sequence: GGG, model: "
     "calvados2}]`"},
    {"empty_chains", "chains: []",
     "the list of chains is empty (s.yaml: chains, line 1): describe at least one chain"},
    {"chains_not_a_list", "chains: 3",
     "`3` is not a list (s.yaml: chains, line 1): give a list in brackets or with dashes"},
    {"no_value", R"y(chains:
)y",
     "key `chains` has no value (s.yaml: chains, line 1): give one or leave the key out"},
    {"chain_is_text", "chains: [GGG]",
     "`GGG` is not a map (s.yaml: chains[0], line 1): give a map with keys among `name`, `count`, "
     "`concentration`, `place`, `sequence`, `fasta`, `record`, `pdb`, `chain`, `conformer`, "
     "`gaps`, `sites`, "
     "`bodies`, `generator`, `model`, `positions`, `links`, `base`, `tip`, "
     "`crosslinks`, `loops`, `anchor`, "
     "`conformation`, `rigid`, `charge_termini`, "
     "`velocities`"},
    {"nothing_in_chain", "chains: [{name: a}]",
     "the chain does not define its bodies (s.yaml: chains[0], line 1): add one of `sequence`, "
     "`fasta`, `pdb`, `bodies`, `generator`"},
    {"two_sources",
     "chains: [{sequence: GGG, model: calvados2, generator: {pendulum: {links: 2}}}]",
     "the chain has both `sequence` and `generator` (s.yaml: chains[0].generator, line 1): keep "
     "one of them"},
    {"same_name_twice",
     "chains: [{name: a, sequence: G, model: calvados2}, {name: a, sequence: G, model: calvados2}]",
     "two chains are named `a` (s.yaml: chains[1], line 1): give each its own `name`"},
    {"key_for_another_source", "chains: [{generator: {pendulum: {links: 3}}, links: model}]",
     "key `links` does not apply to generator `pendulum` (s.yaml: chains[0].links, line 1): leave "
     "it out"},
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
     "`heavy` is not a number (s.yaml: chains[0].bodies[1].mass, body 2, line 5): give a finite "
     "decimal number such as 0.38"},
    {"half_an_exponent", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1e, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "`1e` is not a number (s.yaml: chains[0].bodies[1].mass, body 2, line 5): give a finite "
     "decimal number such as 0.38"},
    {"hexadecimal", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 0x10, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "`0x10` is not a number (s.yaml: chains[0].bodies[1].mass, body 2, line 5): give a finite "
     "decimal number such as 0.38"},
    {"trailing_unit", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 3 kg, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "`3 kg` is not a number (s.yaml: chains[0].bodies[1].mass, body 2, line 5): give a finite "
     "decimal number such as 0.38"},
    {"quoted", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: "3", inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "`3` in quotes is not a number (s.yaml: chains[0].bodies[1].mass, body 2, line 5): give a "
     "finite decimal number such as 0.38"},
    {"nan", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: .nan, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "`.nan` is not finite (s.yaml: chains[0].bodies[1].mass, body 2, line 5): give a finite "
     "decimal number such as 0.38"},
    {"nan_word", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: nan, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "`nan` is not finite (s.yaml: chains[0].bodies[1].mass, body 2, line 5): give a finite "
     "decimal number such as 0.38"},
    {"infinite", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: -.inf, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "`-.inf` is not finite (s.yaml: chains[0].bodies[1].mass, body 2, line 5): give a finite "
     "decimal number such as 0.38"},
    {"too_large", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1e999, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "`1e999` is beyond the range of double precision (s.yaml: chains[0].bodies[1].mass, body 2, "
     "line 5): give a finite decimal number "
     "such as 0.38"},
    {"list_for_number", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: [1], inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "a list is not a number (s.yaml: chains[0].bodies[1].mass, body 2, line 5): give a finite "
     "decimal number such as 0.38"},
    {"map_for_number", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: {a: 1}, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}})y",
     "a map is not a number (s.yaml: chains[0].bodies[1].mass, body 2, line 5): give a finite "
     "decimal number such as 0.38"},
    {"fraction_of_bodies", "chains: [{generator: {random: {bodies: 2.5, joint: link}}}]",
     "`2.5` is not a whole number (s.yaml: chains[0].generator.random.bodies, line 1): give a "
     "whole number such as 1000"},
    {"negative_count", "chains: [{sequence: GGG, model: calvados2, count: -1}]",
     "count -1 is below 1 (s.yaml: chains[0].count, line 1): give 1 or more"},
    {"zero_bodies", "chains: [{generator: {random: {bodies: 0, joint: link}}}]",
     "bodies 0 is below 1 (s.yaml: chains[0].generator.random.bodies, line 1): give 1 or more"},
    {"negative_seed", "chains: [{generator: {random: {bodies: 2, joint: link, seed: -1}}}]",
     "`-1` is not a seed (s.yaml: chains[0].generator.random.seed, line 1): give a whole number "
     "from 0 to 18446744073709551615"},
    {"seed_too_large",
     "chains: [{generator: {random: {bodies: 2, joint: link, seed: 18446744073709551616}}}]",
     "`18446744073709551616` is not a seed (s.yaml: chains[0].generator.random.seed, line 1): give "
     "a whole number from 0 to "
     "18446744073709551615"},
    {"short_vector", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}, com: [1, 2]})y",
     "the list has 2 entries, not 3 (s.yaml: chains[0].bodies[1].com, body 2, line 5): give 3 "
     "numbers in brackets"},
    {"long_vector", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}, com: [1, 2, 3, 4]})y",
     "the list has 4 entries, not 3 (s.yaml: chains[0].bodies[1].com, body 2, line 5): give 3 "
     "numbers in brackets"},
    {"vector_not_list", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}, com: 0})y",
     "`0` is not a list (s.yaml: chains[0].bodies[1].com, body 2, line 5): give 3 numbers in "
     "brackets"},
    {"text_in_vector", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 0, 1]}, com: [0, up, 0]})y",
     "`up` is not a number (s.yaml: chains[0].bodies[1].com[1], body 2, line 5): give a finite "
     "decimal number such as 0.38"},
    {"not_true_or_false", R"y(chains: [{sequence: GGG, model: calvados2}]
output: {velocities: yes})y",
     "`yes` is not true or false (s.yaml: output.velocities, line 2): give true or false"},
};
INSTANTIATE_TEST_SUITE_P(Numbers, Refused, testing::ValuesIn(numbers_cases), name_of_case);

}  // namespace
}  // namespace catena::test
