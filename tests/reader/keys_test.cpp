// The declared keys are those that the reader reads, with the values and defaults that it has.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>

#include "keys/maps.hpp"
#include "scene/fields.hpp"
#include "scene/node.hpp"
#include "tests/domains/helix.hpp"
#include "tests/frames/dcd_bytes.hpp"
#include "tests/io/temporary_folder.hpp"
#include "tests/reader/refusal.hpp"
#include "tests/reader/scene_files.hpp"

namespace catena::test {
namespace {

using scene::Key;
using scene::KeyMap;

/// A scene without notes on its keys, and the path of a map in it.
struct Place {
    std::string yaml;
    std::string path;
};

std::string const sequence = "chains: [{sequence: GGG, model: calvados2}]\n";

/// A chain of two rigid bodies on a fixed base, and what the second has beside its mass. The first
/// has loads and a damper, so that the arrays of loads are there in any case.
std::string arm(std::string const& joint, std::string const& chain = "") {
    return "chains: [{base: fixed, bodies: [{mass: 1, inertia: [1, 1, 1], wrench: {force: [0, 0, "
           "1]}, joint: {type: revolute, axis: [0, 0, 1], torque: 1, stiffness: 1, damping: 1}}, "
           "{mass: 1, inertia: [1, 1, 1], joint: " +
           joint + "}]" + chain + "}]\n";
}

/// A loop that the second body of arm() closes with the ground.
std::string looped(std::string const& joint) {
    return ", loops: [{bodies: [2, 0], joint: " + joint + "}]";
}

/// Three beads on links, not on one line, with given velocities.
std::string beads(std::string const& chain = "") {
    return "chains: [{bodies: [{mass: 1, position: [0, 0, 0], velocity: [0, 0, 0]}, {mass: 1, "
           "position: [1, 0, 0], joint: {type: link}}, {mass: 1, position: [1, 1, 0], joint: "
           "{type: link}}]" +
           chain + "}]\n";
}

/// Rigid bodies and a bead on links, with given velocities.
std::string linked_chain() {
    std::string const body = "{mass: 1, inertia: [1, 1, 1], com: [0.1, 0.1, 0.1], position: ";
    return "chains: [{bodies: [" + body +
           "[0, 0, 0], velocity: [0, 0, 0]}, {mass: 1, position: [1, 0, 0], "
           "joint: {type: link}}, " +
           body + "[2, 0, 0], joint: {type: link}}, " + body +
           "[3, 0, 0], joint: {type: link}}]}]\n";
}

std::string generated(std::string const& generator) {
    return "chains: [{generator: " + generator + "}]\n";
}

/// Path of a file that goes when the tests end.
std::string file(std::string const& name) {
    static TemporaryFolder const folder;
    return folder / name;
}

/// Writes a FASTA file and returns its path.
std::string fasta_file() {
    std::string const path = file("keys_test.fasta");
    std::ofstream(path) << ">a\nGGG\n";
    return path;
}

/// Writes a PDB file of three residues and returns its path.
std::string pdb_file() {
    std::string const path = file("keys_test.pdb");
    std::ofstream(path) << atom(1, "CA", "GLY", 'A', 1, 0) << atom(2, "CA", "GLY", 'A', 2, 3.8)
                        << atom(3, "CA", "GLY", 'A', 3, 7.6);
    return path;
}

/// Writes a predicted helix with its errors. Returns a chain of it without the end of its `rigid`.
std::string prediction() {
    std::string const name = file("keys_test_prediction");
    std::vector<AtomLine> atoms = helix(25, "A");
    for (AtomLine& each : atoms) each.b_factor = 90;
    std::ofstream(name + ".pdb") << pdb_text(atoms);
    std::vector<int> const row(25, 1);
    std::ofstream(name + ".json") << fmt::format(
        "{{\"pae\": [{}]}}",
        fmt::join(std::vector<std::string>(25, fmt::format("[{}]", fmt::join(row, ", "))), ", "));
    return "chains: [{model: calvados2, pdb: " + name + ".pdb, rigid: {pae: " + name + ".json";
}

/// Types of joints that differ in their keys.
std::vector<std::string> const joints{
    "{type: revolute, axis: [0, 0, 1]}", "{type: universal, axes: [[1, 0, 0], [0, 1, 0]]}",
    "{type: helical, axis: [0, 0, 1], pitch: 0.1}", "{type: spherical}",
    "{type: planar3, axes: [[1, 0, 0], [0, 0, 1]]}"};

/// Writes a DCD file of a frame of three beads on links and returns its path.
std::string dcd_file() {
    std::string const path = file("keys_test.dcd");
    std::ofstream(path, std::ios::binary)
        << dcd_bytes({{Vec3{{0, 0, 0}}, Vec3{{0.38, 0, 0}}, Vec3{{0.38, 0.38, 0}}}}, std::nullopt);
    return path;
}

/// Regions and starts from frames.
std::map<std::string, std::vector<Place>> places_of_starts() {
    std::string const box = sequence + "box: {periodic: [30, 30, 30]}\n";
    return {{"box.cubic", {{sequence + "box: {cubic: {}}\n", "box.cubic."}}},
            {"place", {{box + "place: {}\n", "place."}}},
            {"place.slab", {{box + "place: {slab: {thickness: 9}}\n", "place.slab."}}},
            {"place.region",
             {{box + "place: {region: {from: [0, 0, 0], to: [9, 9, 9]}}\n", "place.region."}}},
            {"start", {{sequence + "start: {from: " + dcd_file() + "}\n", "start."}}}};
}

std::map<std::string, std::vector<Place>> places_of_sections() {
    std::string const openmm = sequence + "forces: {openmm: {builder: calvados2}}\n",
                      system = sequence + "forces: {openmm: {system: " CATENA_SOURCE_DIR
                                          "/README.md, map: {chain-1: [0, 2]}}}\n";
    return {{"scene", {{sequence, ""}}},
            {"box",
             {{sequence + "box: {periodic: [30, 30, 30]}\n", "box."},
              {sequence + "box: {}\n", "box."}}},
            {"forces", {{sequence, "forces."}}},
            {"forces.drag", {{arm(joints[0]), "forces.drag."}}},
            {"forces.openmm", {{openmm, "forces.openmm."}, {system, "forces.openmm."}}},
            {"dynamics",
             {{sequence + "dynamics: {integrator: g-baoab, step: 0.01}\n", "dynamics."},
              {arm(joints[0]) + "dynamics: {integrator: dormand-prince, step: 1}\n", "dynamics."}}},
            {"solver", {{sequence, "solver."}}},
            {"output", {{sequence, "output."}}}};
}

std::map<std::string, std::vector<Place>> places_of_chains() {
    std::string const start = "chains: [{model: calvados2, ";
    std::vector<Place> const kinds{
        {sequence, "chains[0]."},
        {"chains: [{model: calvados2}]\n", "chains[0]."},
        {"chains: [{base: fixed}]\n", "chains[0]."},
        {start + "fasta: " + fasta_file() + "}]\n", "chains[0]."},
        {start + "pdb: " + pdb_file() + "}]\n", "chains[0]."},
        {start + "sequence: GGG, base: fixed}]\n", "chains[0]."},
        {start + "sequence: GGG, positions: lost.csv}]\n", "chains[0]."}};
    std::map<std::string, std::vector<Place>> places{
        {"chains", kinds},
        {"chains.model", {{"chains: [{sequence: GGG, model: {}}]\n", "chains[0].model."}}},
        {"chains.conformation", {{sequence, "chains[0].conformation."}}},
        {"chains.rigid",
         {{prediction() + "}}]\n", "chains[0].rigid."},
          {start + "pdb: " + pdb_file() + ", rigid: {domains: lost.yaml}}]\n",
           "chains[0].rigid."}}},
        {"tip", {{arm(joints[0]), "chains[0].tip."}}},
        {"loops", {{arm(joints[0], looped(joints[0])), "chains[0].loops[0]."}}}};
    for (std::string const& joint : joints) {
        std::string const at = joint.substr(0, joint.size() - 1) + ", translation: [1, 0, 0]}}";
        places["loops.joint"].push_back(
            {arm(joints[0], looped(joint)), "chains[0].loops[0].joint."});
        places["tip.joint"].push_back(
            {arm(joints[0], ", tip: {joint: " + at), "chains[0].tip.joint."});
        places["tip.ring"].push_back(
            {arm(joints[0], ", tip: {ring: " + at), "chains[0].tip.ring."});
    }
    places["tip.joint"].push_back(
        {beads(", tip: {joint: {type: link, anchor: [1, 1, 1]}}"), "chains[0].tip.joint."});
    places["tip.ring"].push_back({beads(", tip: {ring: {type: link}}"), "chains[0].tip.ring."});
    return places;
}

std::map<std::string, std::vector<Place>> places_of_bodies() {
    std::string const one = "chains[0].bodies[1].", two = "chains[0].bodies[2].";
    std::string const flying =
        "chains: [{bodies: [{mass: 1, inertia: [1, 1, 1], joint: {type: free}}]}]\n";
    std::map<std::string, std::vector<Place>> places{
        {"bodies", {{arm(joints[0]), one}}},
        {"bodies.wrench", {{arm(joints[0] + ", wrench: {}"), one + "wrench."}}},
        {"bodies.beads",
         {{arm(joints[0] + ", beads: [{position: [0, 0, 0]}]"), one + "beads[0]."}}},
        {"bodies.joint.q", {{flying, "chains[0].bodies[0].joint.q."}}},
        {"bodies.joint.qd", {{flying, "chains[0].bodies[0].joint.qd."}}},
        {"bodies.joint.motion",
         {{arm("{type: revolute, axis: [0, 0, 1], motion: {offset: 0, rate: 0}}"),
           one + "joint.motion."}}},
        {"bodies.hdf5", {{"chains: [{bodies: {hdf5: lost.h5}}]\n", "chains[0].bodies."}}},
        {"beads", {{beads(), one}}},
        {"beads.joint", {{beads(), one + "joint."}}},
        {"linked", {{linked_chain(), one}, {linked_chain(), two}}},
        {"linked.joint", {{linked_chain(), "chains[0].bodies[3].joint."}}}};
    for (std::string const& joint : joints)
        places["bodies.joint"].push_back({arm(joint), one + "joint."});
    return places;
}

std::map<std::string, std::vector<Place>> places_of_generators() {
    std::map<std::string, std::string> const kinds{
        {"random", "{bodies: 3, joint: link}"},
        {"pendulum", "{links: 3}"},
        {"coil", "{bodies: 3}"},
        {"dill", "{bodies: 3}"},
        {"elastic_rod", "{bodies: 3, mass: 1, length: 1, radius: 1, bend: 9, twist: 9}"},
        {"polygon", "{bodies: 3, joint: spherical}"},
        {"freely_jointed", "{beads: 3, length: 1}"},
        {"worm_like", "{bodies: 3, length: 1, persistence: 9}"},
        {"star", "{arms: 3, arm_length: 2, length: 1}"},
        {"brush", "{backbone: 3, side_length: 2, length: 1}"},
        {"dendrimer", "{generations: 2, length: 1}"},
        {"random_tree", "{beads: 9, length: 1}"}};
    std::map<std::string, std::vector<Place>> places{
        {"generator", {{generated("{}"), "chains[0].generator."}}},
        {"distribution",
         {{generated("{pendulum: {links: 3, mass: {}}}"), "chains[0].generator.pendulum.mass."}}}};
    for (auto const& [kind, parameters] : kinds)
        places["generator." + kind].push_back(
            {generated(fmt::format("{{{}: {}}}", kind, parameters)),
             "chains[0].generator." + kind + "."});
    return places;
}

/// Scenes for every map that is a part of the scene itself.
std::map<std::string, std::vector<Place>> all_places() {
    std::map<std::string, std::vector<Place>> places = places_of_sections();
    places.merge(places_of_starts());
    places.merge(places_of_chains());
    places.merge(places_of_bodies());
    places.merge(places_of_generators());
    return places;
}

/// Calls `check(map, key, places)` for all declared keys of scenes.
template <class Check>
void for_each_key(Check check) {
    auto const places = all_places();
    for (KeyMap const* const map : scene::keys::all()) {
        if (map->name == "datasets") continue;  // of HDF5 files: tests/bodies
        auto const found = places.find(std::string(map->name));
        ASSERT_NE(found, places.end()) << "no scene has a map " << map->name;
        for (Key const& key : map->keys) check(*map, key, found->second);
    }
}

/// Refusal of the scene with that value of the key.
std::string refusal_with(Place const& place, Key const& key, std::string const& value) {
    return refusal_of(place.yaml, {place.path + std::string(key.name) + "=" + value});
}

/// True if the message is about the value of the key, not about its presence.
bool is_about_value(std::string const& message, Place const& place, Key const& key) {
    static std::regex const of_presence(
        "does not apply|unknown key|has both|both `|neither|not in this version|beside|chooses "
        "among|"
        "without a fixed base|without positions|generators|kinds|is prescribed|which has no link|"
        "is missing");
    // The type of a link decides what kind of chain is read, which the message is about.
    bool const of_type = key.name == "type" && message.find("in a chain of links") != message.npos;
    return (of_type || message.find(place.path + std::string(key.name)) != message.npos) &&
           !std::regex_search(message, of_presence);
}

// A key that the reader does not read would be accepted with any value.
TEST(Keys, a_declared_key_refuses_an_absurd_value) {
    for_each_key([](KeyMap const& map, Key const& key, std::vector<Place> const& places) {
        std::string said;
        bool const read = std::any_of(places.begin(), places.end(), [&](Place const& place) {
            std::string const message = refusal_with(place, key, "[[]]");
            said += "\n" + message;
            return is_about_value(message, place, key);
        });
        EXPECT_TRUE(read) << map.name << " " << key.name << said;
    });
}

/// Names in backquotes, without those that hold more than a name.
std::set<std::string> quoted_names(std::string_view text) {
    static std::regex const name("`([A-Za-z0-9_-]+)`");
    std::string const all(text);
    std::set<std::string> names;
    for (std::sregex_iterator it(all.begin(), all.end(), name), end; it != end; ++it)
        names.insert((*it)[1]);
    return names;
}

TEST(Keys, the_declared_type_of_a_choice_names_all_values) {
    int choices = 0;
    for_each_key([&](KeyMap const& map, Key const& key, std::vector<Place> const& places) {
        for (Place const& place : places) {
            std::string const message = refusal_with(place, key, "[[]]");
            std::size_t const list = message.find(": use one of `");
            if (list == std::string::npos || !is_about_value(message, place, key)) continue;
            if (message.find("is not a value of") == std::string::npos) continue;
            std::set<std::string> values = quoted_names(message.substr(list));
            if (map.name.starts_with("tip.") || map.name.starts_with("loops."))
                values.erase("free");
            if (map.name.starts_with("loops.")) values.erase("link"), values.erase("planar");
            EXPECT_EQ(quoted_names(key.type), values) << map.name << " " << key.name;
            ++choices;
            break;
        }
    });
    EXPECT_GE(choices, 22);
}

/// The default as one would write it, or nothing for a default in words.
std::optional<std::string> written_default(Key const& key) {
    static std::regex const literal("`([^`]+)`|([0-9.e-]+)|(true|false)");
    std::string text(key.fallback.substr(0, key.fallback.find(": ")));
    if (key.fallback.starts_with("`{")) text = key.fallback;
    std::smatch found;
    if (!std::regex_match(text, found, literal)) return std::nullopt;
    std::string const name = found[1].matched ? found[1].str() : text;
    return name.find('.') != std::string::npos && std::isalpha(static_cast<unsigned char>(name[0]))
               ? std::nullopt  // a path of another key
               : std::optional(name);
}

/// Everything that the reader takes from a scene's keys.
std::string values_of(Scene const& s) {
    SolverSpec const& v = s.solver;
    OutputSpec const& o = s.output;
    std::string text = fmt::format(
        "{} {} {} {} {} {} {} {} {} {} {} {} {} {} {}", s.hash, s.relax,
        static_cast<int>(v.backend), static_cast<int>(v.handles), v.threads, v.gpu_levels,
        v.simd ? static_cast<int>(*v.simd) : -1, v.refine, v.balance, o.every, o.checkpoint_every,
        o.checkpoint_minutes, o.joint_forces, o.velocities, o.coordinates);
    if (!s.forces.openmm) return text;
    OpenMmSpec const& f = *s.forces.openmm;
    return text + fmt::format(" {} {} {} {} {} {} {}", f.threads, f.path, f.overlap, f.layers,
                              f.split, f.replicate, f.audit);
}

/// Values of the scene without the key and with its default; nothing if either is refused.
std::optional<std::pair<std::string, std::string>> values_with_default(Place const& place,
                                                                       std::string const& key,
                                                                       std::string const& value) {
    std::vector<std::string> removed{place.path + key + "=null"};
    std::vector<std::string> const given{place.path + key + "=" + value};
    // Where the whole map is absent, there is nothing to remove.
    if (refusal_of(place.yaml, removed) != "accepted") removed.clear();
    if (refusal_of(place.yaml, removed) != "accepted" ||
        refusal_of(place.yaml, given) != "accepted")
        return std::nullopt;
    return std::pair(values_of(parse_scene(place.yaml, "s.yaml", removed)),
                     values_of(parse_scene(place.yaml, "s.yaml", given)));
}

TEST(Keys, the_declared_default_changes_nothing) {
    int defaults = 0;
    for_each_key([&](KeyMap const& map, Key const& key, std::vector<Place> const& places) {
        std::optional<std::string> const value = written_default(key);
        // Written termini are kept for restarts, also if they are the default.
        if (!value || key.name == "charge_termini") return;
        ++defaults;
        bool accepted = false;
        for (Place const& place : places) {
            auto const values = values_with_default(place, std::string(key.name), *value);
            accepted = accepted || values;
            if (values) {
                EXPECT_EQ(values->first, values->second) << map.name << " " << key.name;
            }
        }
        EXPECT_TRUE(accepted) << map.name << " " << key.name << ": "
                              << refusal_with(places[0], key, *value);
    });
    EXPECT_GE(defaults, 60);
}

TEST(Keys, each_declaration_is_whole) {
    std::set<std::string_view> maps;
    for (KeyMap const* const map : scene::keys::all()) {
        EXPECT_TRUE(maps.insert(map->name).second) << map->name;
        EXPECT_FALSE(map->place.empty()) << map->name;
        std::set<std::string_view> names;
        for (Key const& key : map->keys) {
            std::string const which = fmt::format("{} {}", map->name, key.name);
            EXPECT_TRUE(names.insert(key.name).second) << which;
            EXPECT_FALSE(key.type.empty() || key.fallback.empty()) << which;
            EXPECT_TRUE(key.meaning.ends_with(".")) << which;
            EXPECT_EQ(key.meaning.find(". "), std::string_view::npos) << which << ": one sentence";
            EXPECT_LE(std::count(key.meaning.begin(), key.meaning.end(), ' '), 29) << which;
        }
    }
}

TEST(Keys, each_example_is_the_key_with_a_value) {
    for (KeyMap const* const map : scene::keys::all())
        for (Key const& key : map->keys) {
            if (key.example.empty()) continue;
            scene::Node const node =
                scene::parse_value("{" + std::string(key.example) + "}", "example");
            ASSERT_EQ(node.items.size(), 1u) << map->name << " " << key.name;
            EXPECT_EQ(node.items[0].key, key.name);
            EXPECT_NE(node.items[0].kind, scene::Node::Kind::null) << key.example;
        }
}

TEST(Keys, an_undeclared_key_cannot_be_read) {
    scene::Node const node = scene::parse_value("{periodic: [1, 1, 1]}", "s.yaml");
    scene::Fields const fields(node, scene::keys::box);
    EXPECT_NE(fields.find("periodic"), nullptr);
    EXPECT_EQ(fields.find("fill"), nullptr);
    EXPECT_THROW(fields.find("edges"), std::logic_error);
}

}  // namespace
}  // namespace catena::test
