// What is wrong with beads, sections and their combinations, and what later versions bring. Every
// message whole.
#include "tests/reader/refusal.hpp"

namespace catena::test {
namespace {

Refusal const beads_cases[] = {
    {"unknown_letter", "chains: [{sequence: GAXS, model: calvados2}]",
     "`X` at position 3 of the sequence is not a residue of calvados2 (s.yaml: chains[0].sequence, "
     "line 1): use the one-letter codes ARNDCQEGHILKMFPSTWYV"},
    {"no_model", "chains: [{sequence: GAS}]",
     "key `model` is missing (s.yaml: chains[0], line 1): add `model: calvados2`"},
    {"unknown_model", "chains: [{sequence: GAS, model: calvado2}]",
     "`calvado2` is not a value of `model` (s.yaml: chains[0].model, line 1): did you mean "
     "`calvados2`?"},
    {"model_in_capitals", "chains: [{sequence: GAS, model: CALVADOS2}]",
     "`CALVADOS2` is not a value of `model` (s.yaml: chains[0].model, line 1): did you mean "
     "`calvados2`?"},
    {"model_in_words", "chains: [{sequence: GAS, model: Calvados_3}]",
     "`Calvados_3` is not a value of `model` (s.yaml: chains[0].model, line 1): did you mean "
     "`calvados3`?"},
    {"sequence_list", "chains: [{sequence: [G], model: calvados2}]",
     "a list is not a text (s.yaml: chains[0].sequence, line 1): give a text"},
    {"si_units", R"y(units: si
chains: [{sequence: GGG, model: calvados2}])y",
     "model calvados2 in SI units (s.yaml: chains[0], line 2): write `units: md`: its parameters "
     "are in nm, amu and kJ/mol"},
    {"missing_positions", "chains: [{sequence: GGG, model: calvados2, positions: nowhere.csv}]",
     "no such file: `nowhere.csv` (s.yaml: chains[0].positions, line 1): check the path"},
    {"missing_fasta", "chains: [{fasta: nowhere.fasta, model: calvados2}]",
     "no such file: `nowhere.fasta` (s.yaml: chains[0].fasta, line 1): check the path"},
    {"unknown_conformation", "chains: [{sequence: GGG, model: calvados2, conformation: straigt}]",
     "`straigt` is not a value of `conformation` (s.yaml: chains[0].conformation, line 1): use one "
     "of `extended`, `self_avoiding`"},
    {"conformation_and_positions",
     "chains: [{sequence: GGG, model: calvados2, conformation: extended, positions: a.csv}]",
     "the chain has both `positions` and `conformation` (s.yaml: chains[0].conformation, line 1): "
     "keep one of them"},
    {"unknown_links", "chains: [{sequence: GGG, model: calvados2, links: as-given}]",
     "`as-given` is not a value of `links` (s.yaml: chains[0].links, line 1): did you mean "
     "`as_given`?"},
    {"anchor_of_free", "chains: [{sequence: GGG, model: calvados2, anchor: [0, 0, 0]}]",
     "an anchor without a fixed base (s.yaml: chains[0].anchor, line 1): write `base: fixed` or "
     "leave `anchor` out"},
    {"coincident",
     "chains: [{bodies: [{mass: 1, position: [0, 0, 0], joint: {type: link}}, {mass: 1, position: "
     "[0.4, 0, 0], joint: {type: link}}, "
     "{mass: 1, position: [0.4, 0, 0], joint: {type: link}}]}]",
     "bead 3 coincides with bead 2: their link has no direction (s.yaml: chains[0].bodies, bead 3, "
     "line 1): move one of them"},
    {"on_the_anchor",
     "chains: [{base: fixed, anchor: [1, 0, 0], bodies: [{mass: 1, position: [1, 0, 0], joint: "
     "{type: link}}]}]",
     "bead 1 coincides with the anchor: their link has no direction (s.yaml: chains[0].bodies, "
     "bead 1, line 1): move one of them"},
    {"bead_with_com",
     "chains: [{bodies: [{mass: 1, position: [0, 0, 0], joint: {type: link}, com: [1, 1, 1]}]}]",
     "key `com` does not apply to a point bead on a link (s.yaml: chains[0].bodies[0].com, body 1, "
     "line 1): leave it out or change `joint`"},
    {"bead_without_position", "chains: [{bodies: [{mass: 1, joint: {type: link}}]}]",
     "key `position` is missing (s.yaml: chains[0].bodies[0], body 1, line 1): add `position: [0, "
     "0, 0]`"},
    {"zero_length",
     "chains: [{bodies: [{mass: 1, position: [0, 0, 0], joint: {type: link}}, {mass: 1, position: "
     "[1, 0, 0], joint: {type: link, length: "
     "0}}]}]",
     "length 0 is not positive (s.yaml: chains[0].bodies[1].joint.length, body 2, line 1): give a "
     "number above 0"},
    {"no_link_before_bead_1",
     "chains: [{bodies: [{mass: 1, position: [1, 0, 0], joint: {type: link, length: 1}}]}]",
     "a link length for bead 1 of a free base, which has no link (s.yaml: "
     "chains[0].bodies[0].joint.length, body 1, line 1): leave it out "
     "or write `base: fixed`"},
    {"walk_without_length", "chains: [{generator: {freely_jointed: {beads: 3}}}]",
     "key `length` is missing (s.yaml: chains[0].generator.freely_jointed, line 1): add `length: "
     "1.0`"},
    {"walk_of_negative_length", "chains: [{generator: {freely_jointed: {beads: 3, length: -1}}}]",
     "length -1 is not positive (s.yaml: chains[0].generator.freely_jointed.length, line 1): give "
     "a number above 0"},
    {"two_generators",
     "chains: [{generator: {freely_jointed: {beads: 3, length: 1}, pendulum: {links: 2}}}]",
     "the chain has 2 generators (s.yaml: chains[0].generator, line 1): give one of `random`, "
     "`pendulum`, `coil`, `dill`, `elastic_rod`, "
     "`polygon`, "
     "`freely_jointed`, `worm_like`, `star`, `brush`, `dendrimer`, `random_tree`"},
    {"no_generator", "chains: [{generator: {}}]",
     "the chain has 0 generators (s.yaml: chains[0].generator, line 1): give one of `random`, "
     "`pendulum`, `coil`, `dill`, `elastic_rod`, "
     "`polygon`, "
     "`freely_jointed`, `worm_like`, `star`, `brush`, `dendrimer`, `random_tree`"},
    {"unknown_generator", "chains: [{generator: {pendulm: {links: 3}}}]",
     "unknown key `pendulm` (s.yaml: chains[0].generator.pendulm, line 1): did you mean "
     "`pendulum`?"},
    {"free_pendulum", "chains: [{generator: {pendulum: {links: 3}}, base: free}]",
     "a pendulum on a free base (s.yaml: chains[0].base, line 1): write `base: fixed`"},
    {"unknown_random_joint", "chains: [{generator: {random: {bodies: 3, joint: ball}}}]",
     "`ball` is not a value of `joint` (s.yaml: chains[0].generator.random.joint, line 1): use one "
     "of `link`, `planar`, "
     "`revolute`, `universal`, `spherical`, `weld`, `prismatic`, `helical`, `cylindrical`, "
     "`planar3`, `mixed`"},
    {"unknown_base", "chains: [{sequence: GGG, model: calvados2, base: floating}]",
     "`floating` is not a value of `base` (s.yaml: chains[0].base, line 1): use one of `free`, "
     "`fixed`"},
    {"copies_too_many_for_box", R"y(box: {periodic: [10, 10, 10]}
chains: [{sequence: GGG, model: calvados2, count: 1000, conformation: extended}])y",
     "the box 10 x 10 x 10 has room for 216 chains side by side, each within a sphere 1.445 wide, "
     "not for 1000 (s.yaml: chains[0], line "
     "2): enlarge the box, lower `count` or write `conformation: self_avoiding` (without "
     "`positions`), which is packed more densely"},
    {"extended_in_small_box", R"y(box: {periodic: [2, 2, 2]}
chains: [{sequence: GGGGGGGGGG, model: calvados2}])y",
     "the box 2 x 2 x 2 has room for 0 chains side by side, each within a sphere 3.728 wide, not "
     "for 1 (s.yaml: chains[0], line 2): "
     "enlarge the box, lower `count` or write `conformation: self_avoiding` (without `positions`), "
     "which is packed more densely"},
    {"rods_too_many_for_box", R"y(box: {periodic: [10, 10, 10]}
chains: [{generator: {pendulum: {links: 3}}, count: 1000}])y",
     "the box 10 x 10 x 10 has room for 8 chains side by side, each within a sphere 4.5 wide, not "
     "for 1000 (s.yaml: chains[0], line 2): "
     "enlarge the box or lower `count`; only free chains of a `sequence` or `fasta` "
     "without `positions` and cross-links are packed more densely"},
    {"tethers_too_many_for_box", R"y(box: {periodic: [10, 10, 10]}
chains: [{sequence: GGG, model: calvados2, base: fixed, count: 9000, conformation: self_avoiding}])y",
     "the box 10 x 10 x 10 has room for 216 chains side by side, each within a sphere 1.52 wide, "
     "not for 9000; at random places 1094 found room (s.yaml: chains[0], line 2): "
     "enlarge the box or lower `count`; only free chains of a `sequence` or `fasta` "
     "without `positions` and cross-links are packed more densely"},
    {"packing_beyond_any", R"y(box: {periodic: [10, 10, 10]}
chains: [{sequence: GGGGGGGGGG, model: calvados2, count: 1000}])y",
     "10000 beads that stay 0.56 nm apart would fill 0.805 of the box 10 x 10 x 10, random "
     "packings of spheres fill 0.64 (s.yaml: chains[0], line 2): make each edge 1.08 times as long "
     "or longer, or lower `count`"},
    {"packing_too_narrow", R"y(box: {periodic: [1.3, 20, 20]}
chains: [{sequence: GGGGGGGGGG, model: calvados2, count: 10}])y",
     "the box 1.3 x 20 x 20 is too narrow to pack chains whose beads stay 0.56 nm apart (s.yaml: "
     "chains[0], line 2): give edges of 1.4 nm or more"},
};
INSTANTIATE_TEST_SUITE_P(Beads, Refused, testing::ValuesIn(beads_cases), name_of_case);

Refusal const sections_cases[] = {
    {"box_text", R"y(box: large
chains: [{sequence: GGG, model: calvados2}])y",
     "`large` is not a box (s.yaml: box, line 1): give `{periodic: [60, 60, 60]}` or `none`"},
    {"box_edge", R"y(box: {periodic: [1, 0, 1]}
chains: [{sequence: GGG, model: calvados2}])y",
     "box edge 0 is not positive (s.yaml: box.periodic, line 1): give three edges above 0"},
    {"box_without_edges", R"y(box: {}
chains: [{sequence: GGG, model: calvados2}])y",
     "key `periodic` is missing (s.yaml: box, line 1): add `periodic: [60, 60, 60]`"},
    {"no_integrator", R"y(chains: [{sequence: GGG, model: calvados2}]
dynamics: {step: 0.01})y",
     "key `integrator` is missing (s.yaml: dynamics, line 2): add `integrator: g-baoab`"},
    {"unknown_integrator", R"y(chains: [{sequence: GGG, model: calvados2}]
dynamics: {integrator: ratle, step: 0.01})y",
     "`ratle` is not a value of `integrator` (s.yaml: dynamics.integrator, line 2): did you mean "
     "`rattle`?"},
    {"no_step", R"y(chains: [{sequence: GGG, model: calvados2}]
dynamics: {integrator: rattle})y",
     "key `step` is missing (s.yaml: dynamics, line 2): add `step: 0.01`"},
    {"zero_step", R"y(chains: [{sequence: GGG, model: calvados2}]
dynamics: {integrator: rattle, step: 0})y",
     "step 0 is not positive (s.yaml: dynamics.step, line 2): give a number above 0"},
    {"negative_steps", R"y(chains: [{sequence: GGG, model: calvados2}]
dynamics: {integrator: rattle, step: 1, steps: -5})y",
     "steps -5 is below 0 (s.yaml: dynamics.steps, line 2): give 0 or more"},
    {"negative_temperature", R"y(chains: [{sequence: GGG, model: calvados2}]
dynamics: {integrator: g-baoab, step: 1, temperature: -1})y",
     "temperature -1 is negative (s.yaml: dynamics.temperature, line 2): give 0 or a positive "
     "number"},
    {"negative_friction", R"y(chains: [{sequence: GGG, model: calvados2}]
dynamics: {integrator: g-baoab, step: 1, friction: -1})y",
     "friction -1 is negative (s.yaml: dynamics.friction, line 2): give 0 or a positive number"},
    {"seed_text", R"y(chains: [{sequence: GGG, model: calvados2}]
dynamics: {integrator: g-baoab, step: 1, seed: 1.5})y",
     "`1.5` is not a seed (s.yaml: dynamics.seed, line 2): give a whole number from 0 to "
     "18446744073709551615"},
    {"zero_tolerance", R"y(chains: [{sequence: GGG, model: calvados2}]
dynamics: {integrator: rattle, step: 1, constraint_tolerance: 0})y",
     "constraint_tolerance 0 is not positive (s.yaml: dynamics.constraint_tolerance, line 2): give "
     "a number above 0"},
    {"si_friction", R"y(units: si
chains: [{generator: {freely_jointed: {beads: 3, length: 1}}}]
dynamics: {integrator: g-baoab, step: 1})y",
     "key `friction` is missing (s.yaml: dynamics, line 3): add `friction: 1e10`"},
    {"backend", R"y(chains: [{sequence: GGG, model: calvados2}]
solver: {backend: segment})y",
     "`segment` is not a value of `backend` (s.yaml: solver.backend, line 2): did you mean "
     "`segments`?"},
    {"handles", R"y(chains: [{sequence: GGG, model: calvados2}]
solver: {handles: 6x6})y",
     "`6x6` is not a value of `handles` (s.yaml: solver.handles, line 2): use one of `projected`, "
     "`full`, `articulated`"},
    {"threads", R"y(chains: [{sequence: GGG, model: calvados2}]
solver: {threads: -1})y",
     "threads -1 is below 0 (s.yaml: solver.threads, line 2): give 0 or more"},
    {"balance", R"y(chains: [{sequence: GGG, model: calvados2}]
solver: {balance: 2})y",
     "`2` is not true or false (s.yaml: solver.balance, line 2): give true or false"},
    {"refine", R"y(chains: [{sequence: GGG, model: calvados2}]
solver: {refine: -1})y",
     "refine -1 is below 0 (s.yaml: solver.refine, line 2): give 0 or more"},
    {"gpu_levels", R"y(chains: [{sequence: GGG, model: calvados2}]
solver: {gpu_levels: most})y",
     "`most` is not a number of levels (s.yaml: solver.gpu_levels, line 2): give `auto`, `all`, a "
     "number, or two as `UP,DOWN`"},
    {"every", R"y(chains: [{sequence: GGG, model: calvados2}]
output: {every: 0})y",
     "every 0 is below 1 (s.yaml: output.every, line 2): give 1 or more"},
    {"observable", R"y(chains: [{sequence: GGG, model: calvados2}]
output: {observables: [energi]})y",
     "`energi` is not an observable (s.yaml: output.observables[0], line 2): did you mean "
     "`energy`?"},
    {"temperature_of_nothing",
     R"y(chains: [{base: fixed, bodies: [{mass: 1, inertia: [1, 1, 1], com: [1, 0, 0], joint: {type: weld}}]}]
output: {observables: [energy, temperature]})y",
     "the temperature is undefined because nothing can move (s.yaml: output.observables[1], line "
     "2): leave it out"},
    {"temperature_of_the_driven",
     R"y(chains: [{base: fixed, bodies: [{mass: 1, inertia: [1, 1, 1], com: [1, 0, 0], joint: {type: revolute, axis: [0, 0, 1], motion: {rate: 1}}}]}]
output: {observables: [temperature]})y",
     "the temperature is undefined because a joint of chain `chain-1` is driven (s.yaml: "
     "output.observables[0], line 2): leave it out"},
    {"observable_twice", R"y(chains: [{sequence: GGG, model: calvados2}]
output: {observables: [energy, energy]})y",
     "`energy` is listed twice (s.yaml: output.observables[1], line 2): list it once"},
    {"gravity", R"y(chains: [{sequence: GGG, model: calvados2}]
forces: {gravity: 9.81})y",
     "`9.81` is not a list (s.yaml: forces.gravity, line 2): give 3 numbers in brackets"},
    {"neither_builder_nor_system", R"y(chains: [{sequence: GGG, model: calvados2}]
forces: {openmm: {}})y",
     "neither `builder` nor `system` (s.yaml: forces.openmm, line 2): add `builder: calvados2`, or "
     "`system: system.xml`"},
    {"both_builder_and_system", R"y(chains: [{sequence: GGG, model: calvados2}]
forces: {openmm: {builder: calvados2, system: a.xml}})y",
     "both `builder` and `system` (s.yaml: forces.openmm.builder, line 2): keep one of them"},
    {"missing_system", R"y(chains: [{sequence: GGG, model: calvados2}]
forces: {openmm: {system: nowhere.xml}})y",
     "no such file: `nowhere.xml` (s.yaml: forces.openmm.system, line 2): check the path"},
    {"unknown_builder", R"y(chains: [{sequence: GGG, model: calvados2}]
forces: {openmm: {builder: martini}})y",
     "`martini` is not a value of `builder` (s.yaml: forces.openmm.builder, line 2): use one of "
     "`calvados2`, `calvados3`"},
    {"map_of_builder", R"y(chains: [{sequence: GGG, model: calvados2}]
forces: {openmm: {builder: calvados2, map: {a: [0, 2]}}})y",
     "key `map` does not apply to a builder (s.yaml: forces.openmm.map, line 2): leave it out or "
     "give `system`"},
    {"openmm_path", R"y(chains: [{sequence: GGG, model: calvados2}]
forces: {openmm: {builder: calvados2, path: remote}})y",
     "`remote` is not a value of `path` (s.yaml: forces.openmm.path, line 2): use one of `auto`, "
     "`device`, `host`, `inline`"},
    {"openmm_layers", R"y(chains: [{sequence: GGG, model: calvados2}]
forces: {openmm: {builder: calvados2, layers: two}})y",
     "`two` is not a value of `layers` (s.yaml: forces.openmm.layers, line 2): use one of `auto`, "
     "`all`, `none`"},
    {"openmm_in_si", R"y(units: si
chains: [{generator: {freely_jointed: {beads: 3, length: 1}}}]
forces: {openmm: {builder: calvados2}})y",
     "OpenMM's forces in SI units (s.yaml: forces.openmm, line 3): write `units: md`: OpenMM uses "
     "nm, ps, amu and kJ/mol only"},
    {"frozen_force_field", R"y(chains: [{sequence: GGG, model: calvados2}]
dynamics: {integrator: rattle, step: 1, temperature: 0}
forces: {openmm: {builder: calvados2}})y",
     "the force field's temperature is that of the run, 0 (s.yaml: forces.openmm, line 3): add "
     "`temperature: 300` here"},
    {"impossible_ph", R"y(chains: [{sequence: GGG, model: calvados2}]
forces: {openmm: {builder: calvados2, ph: 70}})y",
     "a pH of 70 (s.yaml: forces.openmm.ph, line 2): give a number from 0 to 14"},
    {"force_group", R"y(chains: [{sequence: GGG, model: calvados2}]
forces: {openmm: {builder: calvados2, force_groups: [32]}})y",
     "key `force_groups` does not apply to a builder (s.yaml: forces.openmm.force_groups, line 2): "
     "leave it out or give `system`"},
    {"tolerance_without_an_estimate", R"y(chains: [{generator: {pendulum: {links: 3}}}]
dynamics: {integrator: rk4, step: 1, tolerance: 1e-6})y",
     "integrator rk4 has no error estimate: its steps have the length `step` (s.yaml: "
     "dynamics.tolerance, line 2): leave it out, or use `integrator: dormand-prince` (joint "
     "coordinates)"},
    {"tolerance_under_rattle", R"y(chains: [{sequence: GGG, model: calvados2}]
dynamics: {integrator: rattle, step: 1, tolerance: 1e-6})y",
     "integrator rattle has no error estimate: its steps have the length `step` (s.yaml: "
     "dynamics.tolerance, line 2): leave it out, or use `integrator: dormand-prince` (joint "
     "coordinates)"},
    {"tolerance_of_noise", R"y(chains: [{generator: {pendulum: {links: 3}}}]
dynamics: {integrator: baoab, step: 1, tolerance: 1e-6})y",
     "integrator baoab has no error estimate: its steps have the length `step` (s.yaml: "
     "dynamics.tolerance, line 2): leave it out, or use `integrator: dormand-prince` (joint "
     "coordinates)"},
    {"negative_tolerance", R"y(chains: [{generator: {pendulum: {links: 3}}}]
dynamics: {integrator: dormand-prince, step: 1, tolerance: -1e-6})y",
     "tolerance -1e-06 is not positive (s.yaml: dynamics.tolerance, line 2): give a number above "
     "0"},
    {"tolerance_below_rounding", R"y(chains: [{generator: {pendulum: {links: 3}}}]
dynamics: {integrator: dormand-prince, step: 1, tolerance: 1e-14})y",
     "tolerance 1e-14 is below the resolution of double precision (s.yaml: dynamics.tolerance, "
     "line 2): give 1e-13 or more"},
    {"tolerance_above_all", R"y(chains: [{generator: {pendulum: {links: 3}}}]
dynamics: {integrator: dormand-prince, step: 1, tolerance: 1})y",
     "tolerance 1 is too large to bound the error (s.yaml: dynamics.tolerance, line 2): give 0.1 "
     "or less, such as 1e-8"},
    {"adaptive_links", R"y(chains: [{sequence: GGG, model: calvados2, name: asyn}]
dynamics: {integrator: dormand-prince, step: 1, tolerance: 1e-6})y",
     "integrator dormand-prince works in joint coordinates, chain `asyn` has links (s.yaml: "
     "dynamics.integrator, line 2): use `integrator: "
     "rattle` or `g-baoab`"},
};
INSTANTIATE_TEST_SUITE_P(Sections, Refused, testing::ValuesIn(sections_cases), name_of_case);

Refusal const together_cases[] = {
    {"rattle_of_revolute",
     R"y(chains: [{generator: {random: {bodies: 3, joint: revolute}}, name: arm}]
dynamics: {integrator: rattle, step: 1})y",
     "integrator rattle moves chains of links or spherical joints, chain `arm` has a revolute "
     "joint (joint 2) (s.yaml: "
     "dynamics.integrator, line 2): "
     "use `integrator: rk4`, `velocity-verlet` or `dormand-prince`"},
    {"g_baoab_of_revolute", R"y(chains: [{generator: {pendulum: {links: 3}}}]
dynamics: {integrator: g-baoab, step: 1})y",
     "integrator g-baoab moves chains of links or spherical joints, chain `chain-1` has a revolute "
     "joint (joint 1) (s.yaml: "
     "dynamics.integrator, line "
     "2): use `integrator: rk4`, `velocity-verlet` or `dormand-prince`"},
    {"rk4_of_links", R"y(chains: [{sequence: GGG, model: calvados2, name: asyn}]
dynamics: {integrator: rk4, step: 1})y",
     "integrator rk4 works in joint coordinates, chain `asyn` has links (s.yaml: "
     "dynamics.integrator, line 2): use `integrator: rattle` or "
     "`g-baoab`"},
    {"fixman_of_bodies",
     R"y(chains: [{generator: {random: {bodies: 9, joint: spherical}}, name: rods}]
dynamics: {integrator: rattle, step: 1, fixman: true})y",
     "the Fixman correction of chain `rods`, which does not consist of point beads only (s.yaml: "
     "dynamics.fixman, line 2): leave it out: only links between point beads have it"},
    {"fixman_without_a_temperature", R"y(chains: [{sequence: GGG, model: calvados2}]
dynamics: {integrator: rattle, step: 1, temperature: 0, fixman: true})y",
     "the Fixman correction without a temperature above 0 (s.yaml: dynamics.fixman, line 2): add "
     "`temperature: 300`"},
    {"damping_under_rattle", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: spherical}}
      - {mass: 1, inertia: [1, 1, 1], joint: {type: spherical, damping: 1}}
dynamics: {integrator: rattle, step: 1})y",
     "joint damping with integrator rattle (s.yaml: chains[0], body 2, line 2): use `integrator: "
     "rk4`, `velocity-verlet` or `dormand-prince`, or set `damping: 0` (g-baoab has `friction`)"},
    {"spring_along_one_coordinate", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: spherical, stiffness: [1, 0, 1]}}
dynamics: {integrator: staggered, step: 1})y",
     "a joint with springs or dampers along only some of its coordinates with integrator staggered "
     "(s.yaml: chains[0], body 1, line 2): give it some stiffness or damping along each, or none"},
    {"springs_far_apart", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: spherical, stiffness: [1, 1e11, 1]}}
dynamics: {integrator: staggered, step: 1})y",
     "a joint that is 1e+11 times as stiff along one coordinate as along another with integrator "
     "staggered "
     "(s.yaml: chains[0], body 1, line 2): keep this ratio within 1e+10"},
    {"damping_under_baoab", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: spherical, damping: 1}}
dynamics: {integrator: implicit-baoab, step: 1})y",
     "joint damping with integrator implicit-baoab (s.yaml: chains[0], body 1, line 2): use "
     "`integrator: rk4`, `velocity-verlet` or `dormand-prince`, or set `damping: 0` "
     "(implicit-baoab has `friction`)"},
    {"joint_forces_of_implicit_joints", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: spherical, stiffness: 1}}
dynamics: {integrator: staggered, step: 1}
output: {joint_forces: true})y",
     "not in this version: joint forces with integrator staggered (s.yaml: output.joint_forces, "
     "line 6): leave it out"},
    {"thermal_under_staggered", R"y(chains:
  - base: fixed
    velocities: thermal
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: spherical, stiffness: 1}}
dynamics: {integrator: staggered, step: 1, temperature: 300})y",
     "thermal velocities with integrator staggered, whose stiff joints rotate more slowly (s.yaml: "
     "chains[0].velocities, line 3): write `velocities: zero`, or give each joint its `qd`"},
    {"temperature_of_implicit_joints", R"y(chains:
  - base: fixed
    bodies:
      - {mass: 1, inertia: [1, 1, 1], joint: {type: spherical, stiffness: 1}}
dynamics: {integrator: staggered, step: 1}
output: {observables: [temperature]})y",
     "the temperature is undefined with integrator staggered, whose stiff joints rotate more "
     "slowly (s.yaml: output.observables[0], line 6): leave it out"},
    {"elastic_rod_of_soft_joints",
     "chains: [{generator: {elastic_rod: {bodies: 9, mass: 1, length: 3.4, radius: 1, bend: 0.1, "
     "twist: 100}}}]\n"
     "dynamics: {integrator: implicit-g-baoab, step: 1, temperature: 300}",
     "a persistence length of 0.1 for rods of 3.4 (s.yaml: chains[0].generator.elastic_rod.bend, "
     "line 1): use rods of at most ten times that length, or a freely jointed chain"},
    {"thermal_without_dynamics", "chains: [{sequence: GGG, model: calvados2, velocities: thermal}]",
     "thermal velocities without a temperature above 0 (s.yaml: chains[0].velocities, line 1): add "
     "`dynamics: {temperature: 300}`, or "
     "write `velocities: zero`"},
    {"thermal_without_temperature",
     R"y(chains: [{sequence: GGG, model: calvados2, velocities: thermal}]
dynamics: {integrator: rattle, step: 1})y",
     "thermal velocities without a temperature above 0 (s.yaml: chains[0].velocities, line 1): "
     "give `temperature: 300` in `dynamics`, "
     "or write `velocities: zero`"},
    {"thermal_at_zero", R"y(chains: [{sequence: GGG, model: calvados2, velocities: thermal}]
dynamics: {integrator: g-baoab, step: 1, temperature: 0})y",
     "thermal velocities without a temperature above 0 (s.yaml: chains[0].velocities, line 1): "
     "give `temperature: 300` in `dynamics`, "
     "or write `velocities: zero`"},
    {"thermal_revolute", R"y(chains: [{generator: {pendulum: {links: 3}}, velocities: thermal}]
dynamics: {integrator: rk4, step: 1, temperature: 300})y",
     "thermal velocities for revolute joints (s.yaml: chains[0].velocities, line 1): write "
     "`velocities: zero`, or give each joint its "
     "`qd`"},
    {"unknown_velocities", "chains: [{sequence: GGG, model: calvados2, velocities: hot}]",
     "`hot` is not a value of `velocities` (s.yaml: chains[0].velocities, line 1): use one of "
     "`thermal`, `zero`"},
    {"openmm_of_bodies", R"y(chains: [{generator: {pendulum: {links: 3}}}]
forces: {openmm: {builder: calvados2}})y",
     "OpenMM's forces act on beads, no chain of the scene has any (s.yaml: forces.openmm, line 2): "
     "add a chain of beads or leave `openmm` "
     "out"},
    {"openmm_of_unknown_residue", R"y(chains: [{generator: {freely_jointed: {beads: 3, length: 1}}}]
forces: {openmm: {builder: calvados2}})y",
     "residue `UNK` has no parameters in calvados2 (s.yaml: chains[0], bead 1, line 1): give the "
     "chain as `sequence`, its beads a `residue` among the twenty amino acids, or their table "
     "(`model: {residues: FILE.csv}`)"},
    {"no_replicas", "replicas: 0\nchains: [{sequence: GGG, model: calvados2}]",
     "replicas 0 is below 1 (s.yaml: replicas, line 1): give 1 or more"},
    {"replicas_in_a_box", R"y(replicas: 2
chains: [{sequence: GGG, model: calvados2}]
box: {periodic: [20, 20, 20]})y",
     "replicas in a periodic box (s.yaml: box, line 3): write `box: none`, since replicas never "
     "meet, or leave `replicas` out and run the scene with several seeds"},
    {"replicas_in_the_box_of_a_system", R"y(replicas: 2
chains: [{sequence: GGG, model: calvados2}]
forces: {openmm: {system: )y" CATENA_SOURCE_DIR R"y(/README.md, map: {chain-1: [0, 2]}}}
box: {periodic: [20, 20, 20]})y",
     "replicas in a periodic box (s.yaml: box, line 4): write `box: none` if no force of the "
     "System is periodic, else leave `replicas` out and run the scene with several seeds"},
    {"articulated_handles_beside_branches", R"y(chains: [{sequence: GGG, model: calvados2},
  {generator: {star: {arms: 3, arm_length: 2, length: 1}}}]
solver: {handles: articulated})y",
     "articulated handles for chain `chain-1`, which has links (s.yaml: solver.handles, line 3): "
     "use `projected`: articulated ones are for open chains of rigid bodies"},
    {"replicas_and_balance", R"y(replicas: 2
chains: [{sequence: GGG, model: calvados2}]
solver: {balance: true})y",
     "shares by speeds for replicas (s.yaml: solver.balance, line 3): leave it out: ranks get "
     "equal numbers of replicas"},
    {"replicas_and_replicate", R"y(replicas: 2
chains: [{sequence: GGG, model: calvados2}]
forces: {openmm: {builder: calvados2, replicate: true}})y",
     "`replicate` for replicas (s.yaml: forces.openmm.replicate, line 3): leave it out: ranks get "
     "whole replicas and exchange nothing"},
    {"replicas_and_split", R"y(replicas: 2
chains: [{sequence: GGG, model: calvados2}]
forces: {openmm: {builder: calvados2, split: pairs}})y",
     "`split` for replicas (s.yaml: forces.openmm.split, line 3): leave it out: ranks get "
     "whole replicas and exchange nothing"},
};
INSTANTIATE_TEST_SUITE_P(Together, Refused, testing::ValuesIn(together_cases), name_of_case);

Refusal const later_cases[] = {
    {"springs", R"y(chains: [{sequence: GGG, model: calvados2}]
forces: {springs: []})y",
     "not in this version: key `springs` (s.yaml: forces.springs, line 2)"},
    {"torques", R"y(chains: [{sequence: GGG, model: calvados2}]
forces: {torques: []})y",
     "not in this version: key `torques` (s.yaml: forces.torques, line 2)"},
    {"precision", R"y(chains: [{sequence: GGG, model: calvados2}]
solver: {precision: mixed})y",
     "not in this version: key `precision` (s.yaml: solver.precision, line 2)"},
    {"implicit_midpoint", R"y(chains: [{sequence: GGG, model: calvados2}]
dynamics: {integrator: implicit-midpoint, step: 1})y",
     "not in this version: `integrator: implicit-midpoint` (s.yaml: dynamics.integrator, line 2)"},
};
INSTANTIATE_TEST_SUITE_P(Later, Refused, testing::ValuesIn(later_cases), name_of_case);

}  // namespace
}  // namespace catena::test
