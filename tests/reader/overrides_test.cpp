// --set key.path=value.
#include "reader/load_scene.hpp"
#include "tests/reader/refusal.hpp"

namespace catena::test {
namespace {

std::string const walk =
    "chains: [{name: a, generator: {freely_jointed: {beads: 3, length: 1}}}, {name: b, generator: "
    "{random: {bodies: 4, joint: link, seed: "
    "2}}}]";

Scene with(std::vector<std::string> const& overrides) {
    return parse_scene(walk, "s.yaml", overrides);
}

TEST(Overrides, reach_into_lists_and_maps) {
    Scene const s = with({"chains[0].generator.freely_jointed.beads=7", "chains[1].name=c"});
    EXPECT_EQ(s.chains[0].size(), 7u);
    EXPECT_EQ(s.chains[1].name, "c");
}

TEST(Overrides, make_missing_keys) {
    Scene const s = with({"dynamics.integrator=rattle", "dynamics.step=1e-3", "title=two words",
                          "forces.gravity=[0, 0, -1]"});
    EXPECT_TRUE(s.dynamics.given);
    EXPECT_EQ(s.dynamics.step, 1e-3);
    EXPECT_EQ(s.title, "two words");
    EXPECT_EQ(s.forces.gravity[2], -1);
}

TEST(Overrides, values_are_yaml) {
    Scene const s = with(
        {"box={periodic: [20, 30, 40]}", "chains[1]={name: d, sequence: GG, model: calvados2}"});
    EXPECT_EQ(s.box->data[1], 30);
    EXPECT_EQ(s.chains[1].beads.residue[0], "GLY");
}

TEST(Overrides, the_last_one_counts) {
    EXPECT_EQ(with({"chains[0].name=x", "chains[0].name=y"}).chains[0].name, "y");
}

TEST(Overrides, elements_of_a_vector) {
    EXPECT_EQ(with({"box={periodic: [20, 20, 20]}", "box.periodic[2]=50"}).box->data[2], 50);
}

TEST(Overrides, null_removes_a_key) {
    Scene const s = with({"title=a", "title=null", "box.periodic=[20, 20, 20]", "box=~"});
    EXPECT_EQ(s.title, "s");
    EXPECT_FALSE(s.box.has_value());
}

TEST(Overrides, are_the_same_as_writing_it) {
    std::string const longer =
        "chains: [{name: a, generator: {freely_jointed: {beads: 9, length: 1}}}, {name: b, "
        "generator: {random: {bodies: 4, joint: link, "
        "seed: 2}}}]";
    EXPECT_EQ(with({"chains[0].generator.freely_jointed.beads=9"}).hash,
              parse_scene(longer, "s.yaml").hash);
}

struct Bad {
    char const* set;
    char const* message;
};
Bad const bad[] = {
    {"dynamics.step",
     "not of the form `key.path=value` (--set dynamics.step): write, e.g., --set "
     "dynamics.steps=1000"},
    {"=3", "not of the form `key.path=value` (--set =3): write, e.g., --set dynamics.steps=1000"},
    {"title=", "the value is empty (--set title=): give one, or `null` to remove the key"},
    {"chains..count=1",
     "a key in the path is empty (--set chains..count=1): write, e.g., chains[0].count"},
    {"chains[x].count=1",
     "`[x]` is not a list index (--set chains[x].count=1): write a whole number from 0 in "
     "brackets, as in chains[0]"},
    {"chains[0.count=1",
     "`[0` is not a list index (--set chains[0.count=1): write a whole number from 0 in brackets, "
     "as in chains[0]"},
    {"chains[2].count=1",
     "index 2 is beyond the list `chains` of 2 (--set chains[2].count=1): indices are counted from "
     "0"},
    {"chains.count=1",
     "`chains` is a list and has no key `count` (--set chains.count=1): correct the path"},
    {"chains[0].name.x=1",
     "`name` is `a` and has no key `x` (--set chains[0].name.x=1): correct the path"},
    {"chain[0].count=3", "there is no list `chain` (--set chain[0].count=3): correct the path"},
    {"chains[0].name[0]=1",
     "`name` is not a list (--set chains[0].name[0]=1): leave the index out"},
    {"title=[1, 2",
     "a key is not plain text (--set title=[1, 2): write `name: value`, and close every bracket"},
    {"box={a: 1, a: 2}", "key `a` is given twice (--set box={a: 1, a: 2}): keep one of them"},
    {"chains[0].coutn=1",
     "unknown key `coutn` (s.yaml: chains[0].coutn, set outside the file): did you mean `count`?"},
    {"chains[0].count=0",
     "count 0 is below 1 (s.yaml: chains[0].count, set outside the file): give 1 or more"},
};

TEST(Overrides, bad_ones) {
    for (Bad const& b : bad) EXPECT_EQ(refusal_of(walk, {b.set}), b.message);
}

}  // namespace
}  // namespace catena::test
