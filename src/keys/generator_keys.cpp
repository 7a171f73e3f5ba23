// Declares the keys of generators and distributions.
#include "keys/maps.hpp"

namespace catena::scene::keys {
namespace {

// Keys that several generators share.
constexpr std::string_view drawn = "number > 0, or a distribution";
constexpr Key seed{"seed",
                   "integer, 0 to 2^64 - 1",
                   "the scene's",
                   "",
                   "What is drawn follows from this number.",
                   "seed: 7"};
constexpr Key bodies{
    "bodies",      "integer >= 1", "required", "", "The chain has this number of bodies.",
    "bodies: 1000"};
constexpr Key mass{"mass", drawn, "1", "mass", "A body or bead has this mass.", "mass: 12"};
constexpr Key rod_length{"length", drawn, "1", "length", "A rod is this long.", "length: 1"};
constexpr Key link_length{"length",      drawn, "required", "length", "A link is this long.",
                          "length: 0.38"};
constexpr Key radius{
    "radius",      drawn, "0.05 `length`", "length", "Rods are solid cylinders of this radius.",
    "radius: 0.01"};
constexpr Key turn{"turn",     "number", "0.3", "radians", "Every joint stands at this angle.",
                   "turn: 0.1"};
constexpr Key excluded{
    "excluded",
    "number >= 0",
    "the mean `length`; with a `model` its bead diameter",
    "length",
    "Beads that no link joins start at least this far apart, where there is room.",
    "excluded: 0.9"};
constexpr Key tree_mass{
    "mass", drawn, "1, or that of the `model`", "mass", "A bead has this mass.", "mass: 12"};
constexpr Key tree_length{
    "length",      drawn, "required without a `model`", "length", "A link is this long.",
    "length: 0.97"};
constexpr Key tree_residue{"residue",
                           "text",
                           "`UNK`, or the only one of the `model`",
                           "",
                           "Topology and force field know all beads by this name.",
                           "residue: KGB"};
constexpr Key only_mass{"mass",    "number > 0", "1", "mass", "A rod or bead has this mass.",
                        "mass: 12"};

constexpr Key generator_keys[] = {
    {"random", "map", "none", "",
     "Random chains have about unit size, mass and speed and physically possible inertias.",
     "random: {bodies: 1e6, joint: spherical, seed: 1}"},
    {"pendulum", "map", "none", "",
     "Rods on revolute joints about +z lie along +x, at rest, from the origin of the ground.",
     "pendulum: {links: 2048}"},
    {"coil", "map", "none", "", "Equal rods on revolute joints wind up into a helix.",
     "coil: {bodies: 1000}"},
    {"dill", "map", "none", "", "Rods of self-similar sizes stand on revolute joints.",
     "dill: {bodies: 1000}"},
    {"elastic_rod", "map", "none", "",
     "Rods on spherical joints have springs that give them persistence lengths.",
     "elastic_rod: {bodies: 2000, mass: 650, length: 0.34, radius: 1, bend: 50, twist: 100}"},
    {"polygon", "map", "none", "", "Rods or beads stand on a regular polygon.",
     "polygon: {bodies: 12, joint: spherical}"},
    {"freely_jointed", "map", "none", "", "Beads on links have independent uniform directions.",
     "freely_jointed: {beads: 100, length: 0.38}"},
    {"worm_like", "map", "none", "",
     "Beads on links are drawn from the exact discrete worm-like chain.",
     "worm_like: {bodies: 200, persistence: 50, length: 3.4}"},
    {"star", "map", "none", "", "Arms of beads on links hang on bead 1.",
     "star: {arms: 6, arm_length: 50, length: 0.97}"},
    {"brush", "map", "none", "", "Side chains of beads on links hang on a backbone of such beads.",
     "brush: {backbone: 200, side_length: 20, length: 0.97}"},
    {"dendrimer", "map", "none", "", "Beads on links form a regular tree around bead 1.",
     "dendrimer: {generations: 5, spacer: 2, length: 0.97}"},
    {"random_tree", "map", "none", "", "Each bead hangs on a random earlier one by a link.",
     "random_tree: {beads: 1000, length: 0.97}"},
};

constexpr Key random_keys[] = {
    bodies,
    {"joint",
     "`link`, `planar`, `revolute`, `universal`, `spherical`, `weld`, `prismatic`, `helical`, "
     "`cylindrical`, `planar3`, `mixed`",
     "required", "", "All joints have this type; `mixed` draws each from `revolute` to `helical`.",
     "joint: revolute"},
    {"rigid", "number, 0 to 1", "0", "",
     "With `joint: link` this fraction of the beads becomes rigid bodies.", "rigid: 0.3"},
    {"mass", drawn, "`{log_uniform: [0.5, 2]}`", "mass", "A body has this mass.", "mass: 1"},
    {"length", drawn, "`{uniform: [0.5, 1.5]}`", "length",
     "Joints are this far apart; a link is this long.", "length: {normal: [1, 0.1]}"},
    {"inertia", drawn, "`{uniform: [0.05, 0.15]}`", "length^2",
     "The inertia is made of three such numbers a, b, c.", "inertia: {log_uniform: [1e-8, 1]}"},
    seed,
    {"loads", "true, false", "true", "",
     "Random joint torques and wrenches act; without them energy is conserved.", "loads: false"},
};

constexpr Key pendulum_keys[] = {
    {"links", "integer >= 1", "required", "", "The chain has this number of rods.", "links: 8"},
    mass,
    rod_length,
    radius,
    seed};

constexpr Key coil_keys[] = {
    bodies,
    mass,
    rod_length,
    radius,
    seed,
    turn,
    {"twist", "number", "0.1", "radians",
     "Each axis is turned by this angle about its rod against the one before.", "twist: 0.02"},
};

constexpr Key dill_keys[] = {
    bodies,
    mass,
    rod_length,
    radius,
    seed,
    turn,
    {"ratio", "number > 0, at most 1", "0.5", "",
     "Every fourth rod is smaller by this factor, every eighth by its square, and so on.",
     "ratio: 0.7"},
};

constexpr Key elastic_rod_keys[] = {
    bodies,
    {"mass", "number > 0", "required", "mass", "A rod has this mass.", "mass: 650"},
    {"length", "number > 0", "required", "length", "A rod is this long.", "length: 3.4"},
    {"radius", "number > 0", "required", "length", "Rods are solid cylinders of this radius.",
     "radius: 1"},
    {"bend", "number >= 0.1 `length`", "required", "length",
     "The chain has this persistence length of bending.", "bend: 50"},
    {"twist", "number >= 0.1 `length`", "required", "length",
     "The chain has this persistence length of twisting.", "twist: 100"},
    seed,
};

constexpr Key polygon_keys[] = {
    {"bodies", "integer >= 3", "required", "", "The polygon has this number of sides.",
     "bodies: 12"},
    {"joint", "`spherical`, `revolute`, `link`", "required", "",
     "Rods stand on these joints, `revolute` about z; `link` means beads.", "joint: link"},
    only_mass,
    {"length", "number > 0", "1", "length", "A side is this long.", "length: 3.4"},
    {"radius", "number > 0", "0.05 `length`", "length", "Rods are solid cylinders of this radius.",
     "radius: 1"},
    {"spin", "3 numbers", "`[0, 0, 0]`", "radians / time",
     "Rods start as if the polygon rotated as one rigid body with this angular velocity, in W.",
     "spin: [0, 0, 1]"},
};

constexpr Key freely_jointed_keys[] = {
    {"beads", "integer >= 1", "required", "", "The chain has this number of beads.", "beads: 100"},
    link_length,
    mass,
    seed};

constexpr Key worm_like_keys[] = {
    bodies,
    {"persistence", "number > 0", "required", "length", "The chain has this persistence length.",
     "persistence: 50"},
    link_length,
    mass,
    seed,
};

constexpr Key star_keys[] = {
    {"arms", "integer >= 1", "required", "", "This number of arms hangs on bead 1.", "arms: 6"},
    {"arm_length", "integer >= 1", "required", "",
     "An arm has this number of beads, numbered outward, arm by arm.", "arm_length: 50"},
    tree_length,
    tree_mass,
    tree_residue,
    excluded,
    seed,
};

constexpr Key brush_keys[] = {
    {"backbone", "integer >= 1", "required", "",
     "The backbone has this number of beads, which come first.", "backbone: 200"},
    {"side_length", "integer >= 1", "required", "",
     "A side chain has this number of beads, numbered outward, side chain by side chain.",
     "side_length: 20"},
    {"every", "integer >= 1", "1", "",
     "Side chains hang on every so many beads of the backbone, from bead 1 on.", "every: 2"},
    tree_length,
    tree_mass,
    tree_residue,
    excluded,
    seed,
};

constexpr Key dendrimer_keys[] = {
    {"generations", "integer >= 1", "required", "",
     "From bead 1 to an end of the tree lie this number of segments.", "generations: 4"},
    {"functionality", "integer >= 3", "3", "",
     "This number of segments meets at bead 1 and at each branch point.", "functionality: 4"},
    {"spacer", "integer >= 0", "0", "",
     "A segment has this number of beads between two branch points.", "spacer: 3"},
    tree_length,
    tree_mass,
    tree_residue,
    excluded,
    seed,
};

constexpr Key random_tree_keys[] = {
    {"beads", "integer >= 1", "required", "", "The chain has this number of beads.", "beads: 100"},
    {"max_children", "integer >= 1", "2", "",
     "A bead carries at most this number of others; all that carry fewer are equally likely.",
     "max_children: 3"},
    tree_length,
    tree_mass,
    tree_residue,
    excluded,
    seed,
};

constexpr Key distribution_keys[] = {
    {"uniform", "[least, most]", "none", "",
     "All numbers between the two bounds are equally likely.", "uniform: [0.5, 1.5]"},
    {"log_uniform", "[least, most]", "none", "",
     "The logarithm is uniform between those of the bounds.", "log_uniform: [1e-8, 1]"},
    {"normal", "[mean, standard deviation]", "none", "",
     "The distribution is normal; a number is drawn again until it is above 0.",
     "normal: [1, 0.1]"},
    {"choice", "list of numbers > 0", "none", "", "Each of these numbers is equally likely.",
     "choice: [1, 2, 4]"},
};

}  // namespace

constinit KeyMap const generator{"generator", "chains[i].generator", generator_keys};
constinit KeyMap const random{"generator.random", "chains[i].generator.random", random_keys};
constinit KeyMap const pendulum{"generator.pendulum", "chains[i].generator.pendulum",
                                pendulum_keys};
constinit KeyMap const coil{"generator.coil", "chains[i].generator.coil", coil_keys};
constinit KeyMap const dill{"generator.dill", "chains[i].generator.dill", dill_keys};
constinit KeyMap const elastic_rod{"generator.elastic_rod", "chains[i].generator.elastic_rod",
                                   elastic_rod_keys};
constinit KeyMap const polygon{"generator.polygon", "chains[i].generator.polygon", polygon_keys};
constinit KeyMap const freely_jointed{"generator.freely_jointed",
                                      "chains[i].generator.freely_jointed", freely_jointed_keys};
constinit KeyMap const worm_like{"generator.worm_like", "chains[i].generator.worm_like",
                                 worm_like_keys};
constinit KeyMap const star{"generator.star", "chains[i].generator.star", star_keys};
constinit KeyMap const brush{"generator.brush", "chains[i].generator.brush", brush_keys};
constinit KeyMap const dendrimer{"generator.dendrimer", "chains[i].generator.dendrimer",
                                 dendrimer_keys};
constinit KeyMap const random_tree{"generator.random_tree", "chains[i].generator.random_tree",
                                   random_tree_keys};
constinit KeyMap const distribution{
    "distribution", "mass, length, radius or inertia of a generator", distribution_keys};

}  // namespace catena::scene::keys
