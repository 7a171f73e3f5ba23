// Whole scenes: every section's values and defaults, and the hash.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

#include "reader/load_scene.hpp"
#include "terms/deciding.hpp"
#include "tests/io/temporary_folder.hpp"
#include "tests/reader/refusal.hpp"

namespace catena::test {
namespace {

std::string const sketch = R"(
title: alpha-synuclein, CALVADOS 2
units: md
chains:
  - name: asyn
    count: 1
    sequence: MDVFMKGLSK
    model: calvados2
    links: model
    base: free
    tip: free
box: {periodic: [60, 50, 40]}
forces:
  gravity: [0, 1, 2]
  openmm: {builder: calvados2, temperature: 310, ionic_strength: 0.1, ph: 7.4, switch_width: 0.2, platform: CPU, precision: mixed, threads: 2, device: 1, path: inline,
           overlap: false, layers: none, split: pairs, replicate: true, audit: true}
dynamics: {integrator: g-baoab, step: 0.01, steps: 1e4, temperature: 300, friction: 0.5, seed: 12345678901234567890, constraint_tolerance: 1e-9}
solver: {backend: segments, handles: full, threads: 3, refine: 2, gpu_levels: "4,2", balance: true}
output: {every: 10, checkpoint_every: 1000, observables: [energy, radius_of_gyration], joint_forces: true, velocities: true}
)";

TEST(Scenes, every_section) {
    Scene const s = parse_scene(sketch, "folder/s.yaml");
    EXPECT_EQ(s.title, "alpha-synuclein, CALVADOS 2");
    EXPECT_EQ(s.file, "folder/s.yaml");
    EXPECT_FALSE(s.si);
    EXPECT_EQ(s.bodies(), 10);
    EXPECT_EQ(s.box->data[2], 40);
    EXPECT_EQ(s.forces.gravity[2], 2);
    OpenMmSpec const& o = *s.forces.openmm;
    EXPECT_EQ(o.builder, "calvados2");
    EXPECT_EQ(o.temperature, 310);
    EXPECT_EQ(o.ionic_strength, 0.1);
    EXPECT_EQ(o.ph, 7.4);
    EXPECT_EQ(o.switch_width, 0.2);
    EXPECT_EQ(o.platform, "CPU");
    EXPECT_EQ(o.precision, "mixed");
    EXPECT_EQ(o.threads, 2);
    EXPECT_EQ(o.device, 1);
    EXPECT_EQ(o.path, "inline");
    EXPECT_FALSE(o.overlap);
    EXPECT_EQ(o.layers, "none");
    EXPECT_EQ(o.split, "pairs");
    EXPECT_TRUE(o.replicate);
    EXPECT_TRUE(o.audit);
    DynamicsSpec const& d = s.dynamics;
    EXPECT_TRUE(d.given);
    EXPECT_EQ(d.integrator, Integrator::g_baoab);
    EXPECT_EQ(d.step, 0.01);
    EXPECT_EQ(d.steps, 10000);
    EXPECT_EQ(d.temperature, 300);
    EXPECT_EQ(d.friction, 0.5);
    EXPECT_EQ(d.seed, 12345678901234567890u);
    EXPECT_EQ(d.constraint_tolerance, 1e-9);
    EXPECT_EQ(s.solver.backend, Backend::segments);
    EXPECT_EQ(s.solver.handles, Handles::full);
    EXPECT_EQ(s.solver.threads, 3);
    EXPECT_EQ(s.solver.refine, 2);
    EXPECT_EQ(s.solver.gpu_levels, "4,2");
    EXPECT_TRUE(s.solver.balance);
    EXPECT_EQ(s.output.every, 10);
    EXPECT_EQ(s.output.checkpoint_every, 1000);
    EXPECT_EQ(s.output.observables, (std::vector<std::string>{"energy", "radius_of_gyration"}));
    EXPECT_TRUE(s.output.joint_forces);
    EXPECT_TRUE(s.output.velocities);
}

TEST(Scenes, defaults) {
    Scene const s = parse_scene(
        "units: si\nchains: [{generator: {freely_jointed: {beads: 3, length: 1}}}]\nbox: none",
        "folder/walk.yaml");
    EXPECT_EQ(s.title, "walk");
    EXPECT_TRUE(s.si);
    EXPECT_EQ(s.boltzmann(), 1.380649e-23);
    EXPECT_EQ(s.chains[0].name, "chain-1");
    EXPECT_FALSE(s.box.has_value());
    EXPECT_FALSE(s.forces.openmm.has_value());
    EXPECT_FALSE(s.dynamics.given);
    EXPECT_EQ(s.solver.backend, Backend::automatic);
    EXPECT_EQ(s.solver.handles, Handles::projected);
    EXPECT_FALSE(s.solver.balance);
    EXPECT_EQ(s.output.every, 100);
}

TEST(Scenes, the_force_field_takes_the_temperature_of_the_run) {
    std::string const chain =
        "chains: [{sequence: GG, model: calvados2}]\nforces: {openmm: {builder: calvados2}}\n";
    EXPECT_EQ(parse_scene(chain, "s.yaml").forces.openmm->temperature, 300);
    EXPECT_EQ(parse_scene(chain + "dynamics: {integrator: g-baoab, step: 0.01, temperature: 350}",
                          "s.yaml")
                  .forces.openmm->temperature,
              350);
    EXPECT_FALSE(parse_scene(chain, "s.yaml").forces.openmm->ph.has_value());
}

TEST(Scenes, layers_of_forces) {
    auto const layers = [](std::string const& key) {
        return parse_scene(
                   "chains: [{sequence: GG, model: calvados2}]\nforces: {openmm: {builder: "
                   "calvados2" +
                       key + "}}",
                   "s.yaml")
            .forces.openmm->layers;
    };
    EXPECT_EQ(layers(""), "auto");
    for (char const* const value : {"auto", "all", "none"})
        EXPECT_EQ(layers(std::string(", layers: ") + value), value);
}

TEST(Scenes, numbers_are_read_to_the_last_bit) {
    auto const gravity = [](std::string const& x) {
        return parse_scene("chains: [{sequence: G, model: calvados2}]\nforces: {gravity: [" + x +
                               ", 0, 0]}",
                           "s.yaml")
            .forces.gravity[0];
    };
    EXPECT_EQ(gravity("0.1"), 0.1);
    EXPECT_EQ(gravity("+1.5e-3"), 1.5e-3);
    EXPECT_EQ(gravity("-.5"), -0.5);
    EXPECT_EQ(gravity("5."), 5.0);
    EXPECT_EQ(gravity("1E5"), 1e5);
    EXPECT_EQ(gravity("4.9406564584124654e-324"), 4.9406564584124654e-324);
    EXPECT_EQ(gravity("1.7976931348623157e308"), 1.7976931348623157e308);
}

TEST(Scenes, friction_that_no_thermostat_uses_is_noted) {
    auto const notes = [](std::string const& integrator, std::string const& friction) {
        std::string const chain = integrator != "rattle" && integrator != "g-baoab"
                                      ? "{pendulum: {links: 3}}"
                                      : "{freely_jointed: {beads: 3, length: 1}}";
        std::string told;
        for (std::string const& note : parse_scene("chains: [{generator: " + chain +
                                                       "}]\ndynamics: {integrator: " + integrator +
                                                       ", step: 1e-3" + friction + "}",
                                                   "s.yaml")
                                           .notes)
            if (note.starts_with("dynamics.friction")) told += note;
        return told;
    };
    EXPECT_EQ(notes("rattle", ", friction: 0.2"),
              "dynamics.friction = 0.2 has no effect: integrator rattle has no thermostat, g-baoab "
              "has one");
    EXPECT_EQ(
        notes("leapfrog", ", friction: 1"),
        "dynamics.friction = 1 has no effect: integrator leapfrog has no thermostat, baoab has "
        "one");
    for (char const* const integrator : {"rattle", "rk4", "velocity-verlet"}) {
        EXPECT_EQ(notes(integrator, ""), "");
        EXPECT_EQ(notes(integrator, ", friction: 0"), "");
    }
    EXPECT_EQ(notes("g-baoab", ", friction: 0.2"), "");
    EXPECT_EQ(notes("baoab", ", friction: 0.2"), "");
}

TEST(Hash, tells_what_decides_the_motion) {
    auto const hash = [](std::vector<std::string> const& overrides) {
        return parse_scene(sketch, "s.yaml", overrides).hash;
    };
    std::string const plain = hash({});
    EXPECT_EQ(plain.size(), 32u);
    for (char const* const same :
         {"title=other", "dynamics.steps=5", "solver.backend=serial", "solver.threads=1",
          "output.every=7", "output.observables=[energy]", "forces.openmm.platform=Reference",
          "forces.openmm.threads=1", "forces.openmm.path=host", "forces.openmm.layers=all",
          "forces.openmm.split=ghosts", "forces.openmm.replicate=false",
          "forces.openmm.audit=false"})
        EXPECT_EQ(hash({same}), plain) << same;
    for (char const* const other :
         {"dynamics.step=0.011", "dynamics.seed=2", "dynamics.friction=0.4",
          "dynamics.temperature=301", "dynamics.integrator=rattle",
          "dynamics.constraint_tolerance=1e-8", "box.periodic[0]=61", "box=none",
          "forces.gravity=[0, 1, 3]", "forces.openmm.ph=7", "forces.openmm.temperature=300",
          "forces.openmm.switch_width=0", "forces.openmm=null", "chains[0].sequence=MDVFMKGLSS",
          "chains[0].velocities=zero", "chains[0].name=b", "chains[0].conformation=self_avoiding"})
        EXPECT_NE(hash({other}), plain) << other;
}

/// A checkpoint of today must fit the scene of tomorrow: these values change only with a new
/// version of the hash.
TEST(Hash, stays_the_same) {
    EXPECT_EQ(parse_scene("chains: [{base: fixed, bodies: [{mass: 1.5, inertia: [1, 1, 1.5], "
                          "joint: {type: revolute, axis: [0, 0, 1], q: 0.25}}]}]",
                          "s.yaml")
                  .hash,
              "82852a9ae651130dec0961ac9813f517");
    EXPECT_EQ(parse_scene("chains: [{bodies: [{mass: 1, position: [0, 0, 0], joint: {type: link}}, "
                          "{mass: 1, position: [0, 0, 1], joint: "
                          "{type: link}}]}]",
                          "s.yaml")
                  .hash,
              "6388f9d9a6fc53d23975b7b8d3de31c0");
}

std::map<std::string, std::string> deciding_values_of(std::string const& yaml) {
    std::map<std::string, std::string> values;
    for (scene::DecidingValue const& each : scene::deciding_values(parse_scene(yaml, "s.yaml")))
        values[each.key] = each.value;
    return values;
}

/// What changes the hash can be named.
TEST(Deciding, relaxation_is_among_what_a_restart_compares) {
    std::string const chain = "chains: [{sequence: GG, model: calvados2}]\n";
    auto const changed =
        scene::changes(deciding_values_of(chain),
                       scene::deciding_values(parse_scene(chain + "relax: true", "s.yaml")));
    ASSERT_EQ(changed.size(), 1U);
    EXPECT_EQ(changed[0].key, "relax");
    EXPECT_EQ(changed[0].role, scene::Role::start);
}

TEST(Deciding, replicas_come_first_and_without_them_there_is_one) {
    std::string const chain = "chains: [{sequence: GG, model: calvados2}]\n";
    auto const changed =
        scene::changes(deciding_values_of(chain + "replicas: 4"),
                       scene::deciding_values(parse_scene(chain + "relax: true", "s.yaml")));
    ASSERT_GE(changed.size(), 2U);
    EXPECT_EQ(changed[0].key, "replicas");
    EXPECT_EQ(changed[0].before, "4");
    EXPECT_EQ(changed[0].now, "1");
    EXPECT_EQ(changed[0].role, scene::Role::fixed);
}

TEST(Deciding, ends_of_many_chains_fit_a_line) {
    std::string const few =
        "forces: {openmm: {builder: calvados2}}\nchains: [{name: a, sequence: GG, model: "
        "calvados2, charge_termini: N}]";
    EXPECT_EQ(deciding_values_of(few).at("forces.openmm.charge_termini"), "a: [1, 0]");
    std::string const many =
        "forces: {openmm: {builder: calvados2}}\nchains: [{count: 500, sequence: GG, model: "
        "calvados2, charge_termini: N}]";
    std::string const value = deciding_values_of(many).at("forces.openmm.charge_termini");
    EXPECT_EQ(value.substr(0, 12), "500 entries ");
    EXPECT_LT(value.size(), 40U);
}

TEST(Names, of_what_can_be_chosen) {
    EXPECT_STREQ(name_of(Integrator::g_baoab), "g-baoab");
    EXPECT_STREQ(name_of(Backend::automatic), "auto");
    EXPECT_STREQ(name_of(Backend::cuda_levels), "cuda-levels");
    EXPECT_STREQ(name_of(Handles::projected), "projected");
    EXPECT_STREQ(name_of(JointType::spherical), "spherical");
}

std::string const peptides = R"y(
chains: [{name: a, sequence: GASGAS, model: calvados2, conformation: self_avoiding, count: 2},
         {name: b, sequence: GAS, model: calvados2}]
dynamics: {integrator: g-baoab, step: 0.01, steps: 10, temperature: 300, seed: 9}
)y";

/// Shape of a chain: distance of its ends.
double ends_apart(ChainSpec const& chain) {
    return norm(chain.beads.position.back() - chain.beads.position.front());
}

TEST(Replicas, HaveNamesAndSeedsOfTheirOwn) {
    Scene const one = parse_scene(peptides, "s.yaml"),
                all = parse_scene(peptides, "s.yaml", {"replicas=3"});
    EXPECT_EQ(one.replicas, 1);
    EXPECT_EQ(all.replicas, 3);
    ASSERT_EQ(all.chains.size(), 9U);
    EXPECT_EQ(all.chains_a_replica(), 3U);
    EXPECT_EQ(all.chains[0].name, "a-1-1");
    EXPECT_EQ(all.chains[5].name, "b-2");
    EXPECT_EQ(all.name_in_file(5), "b");
    EXPECT_EQ(all.name_in_file(6), "a-1");
    // The first replica is the scene; the third is that of the next seed but one.
    Scene const third = parse_scene(peptides, "s.yaml", {"dynamics.seed=11"});
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_EQ(norm(all.chains[c].beads.position[0] - one.chains[c].beads.position[0]), 0);
        EXPECT_NEAR(ends_apart(all.chains[6 + c]), ends_apart(third.chains[c]), 1e-12);
    }
    EXPECT_GT(std::abs(ends_apart(all.chains[0]) - ends_apart(all.chains[3])), 1e-3);
    EXPECT_NE(all.hash, one.hash);
    EXPECT_TRUE(all.notes == one.notes);
}

TEST(Replicas, OfAWrittenStartDifferInPlaceAlone) {
    Scene const all = parse_scene(
        "replicas: 9\nchains: [{name: a, bodies: [{mass: 1, position: [1, 2, 3], joint: {type: "
        "link}}, {mass: 1, position: [1, 2, 4], joint: {type: link}}]}]",
        "s.yaml");
    ASSERT_EQ(all.chains.size(), 9U);
    EXPECT_EQ(all.chains[0].beads.position[0][2], 3);
    for (std::size_t r = 1; r < 9; ++r) {
        Vec3 const along = all.chains[r].beads.position[1] - all.chains[r].beads.position[0];
        EXPECT_NEAR(along[2], 1, 1e-15);
        for (std::size_t s = 0; s < r; ++s)
            EXPECT_GT(norm(all.chains[r].beads.position[0] - all.chains[s].beads.position[0]), 1);
    }
}

/// Notes of a scene of three replicas that have `part`.
std::size_t notes_with(std::string const& part, std::string const& yaml) {
    Scene const all = parse_scene("replicas: 3\n" + yaml, "s.yaml");
    return static_cast<std::size_t>(std::count_if(
        all.notes.begin(), all.notes.end(),
        [&](std::string const& note) { return note.find(part) != std::string::npos; }));
}

std::string const g_baoab =
    "dynamics: {integrator: g-baoab, step: 0.001, steps: 10, temperature: 300, friction: 1}\n";

TEST(Replicas, ThatMoveAlikeAreNoted) {
    std::string const alike = "all 3 replicas move alike",
                      beads =
                          "chains: [{name: a, bodies: [{mass: 1, position: [1, 2, 3]}, {mass: 1, "
                          "position: [1, 2, 4], joint: {type: link}}]}]\n";
    auto const rattle = [](std::string const& temperature) {
        return "dynamics: {integrator: rattle, step: 0.001, steps: 10" + temperature + "}\n";
    };
    EXPECT_EQ(notes_with(alike, beads + rattle("")), 1U);
    EXPECT_EQ(notes_with(alike, beads + rattle(", temperature: 300")), 0U);  // thermal velocities
    EXPECT_EQ(notes_with(alike, beads + g_baoab), 0U);
    EXPECT_EQ(notes_with(alike, beads), 0U);  // nothing moves
    EXPECT_EQ(notes_with(alike, "chains: [{generator: {freely_jointed: {beads: 9, length: 1}}}]\n" +
                                    rattle("")),
              0U);
}

TEST(Replicas, WithASeedOfTheirOwnStartAlikeAndAreNoted) {
    auto const tree = [](std::string const& seed) {
        return "chains: [{name: t, generator: {random_tree: {beads: 30, length: 1" + seed +
               "}}}]\n" + g_baoab;
    };
    EXPECT_EQ(notes_with("the generator of chain `t` has a `seed` of its own", tree(", seed: 7")),
              1U);
    EXPECT_EQ(notes_with("anew", tree(", seed: 7")), 0U);
    EXPECT_EQ(notes_with("`seed` of its own", tree("")), 0U);
    EXPECT_EQ(notes_with("each replica draws chain `t` anew", tree("")), 1U);
    Scene const alike = parse_scene("replicas: 3\n" + tree(", seed: 7"), "s.yaml"),
                others = parse_scene("replicas: 3\n" + tree(""), "s.yaml");
    EXPECT_EQ(alike.chains[0].parent, alike.chains[2].parent);
    EXPECT_NE(others.chains[0].parent, others.chains[2].parent);
}

/// Positions that are written do not make the masses of all replicas those of the first.
TEST(Replicas, DrawTheirMassesEachBesideWrittenPositions) {
    TemporaryFolder const folder;
    std::ofstream(folder / "two.csv") << "0,0,0\n0,0,1\n";
    Scene const all = parse_scene(
        "replicas: 3\nchains: [{generator: {freely_jointed: {beads: 2, length: 1, mass: {uniform: "
        "[1, 2]}}}, positions: two.csv}]\n",
        folder / "s.yaml");
    for (std::size_t r = 1; r < 3; ++r)
        EXPECT_NE(all.chains[r].beads.mass[0], all.chains[0].beads.mass[0]) << r;
}

TEST(Replicas, AreLookedAtBeforeTheyAreMade) {
    std::size_t chains = 0;
    parse_scene(peptides, "s.yaml", {"replicas=3"},
                [&](Scene const& first) { chains = first.chains.size(); });
    EXPECT_EQ(chains, 3U);
}

TEST(Replicas, OneIsTheSceneItself) {
    EXPECT_EQ(parse_scene(peptides, "s.yaml", {"replicas=1"}).hash,
              parse_scene(peptides, "s.yaml").hash);
}

}  // namespace
}  // namespace catena::test
