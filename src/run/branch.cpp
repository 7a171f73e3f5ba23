// Implements the comparison of a checkpoint's scene with the present one.
#include "run/branch.hpp"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "error.hpp"
#include "scene/fields.hpp"

namespace catena {
namespace {

using nlohmann::json;
using Values = std::map<std::string, std::string>;

constexpr char const* note_of_scene = "scene";

/// Values of the scene in a checkpoint; empty if an earlier version wrote it.
Values values_in(Checkpoint const& c) {
    auto const note = c.notes.find(note_of_scene);
    if (note == c.notes.end()) return {};
    json const kept = json::parse(note->second, nullptr, false);
    Values values;
    if (kept.is_object())
        for (auto const& [key, value] : kept.items())
            if (value.is_string()) values[key] = value.get<std::string>();
    return values;
}

/// Throws InputError if the scene's integrator uses other coordinates than the checkpoint's state.
void require_same_coordinates(Checkpoint const& c, Scene const& scene, std::string const& file) {
    bool const joint = uses_joint_coordinates(scene.dynamics.integrator),
               was_joint = c.arrays.contains("q");
    if (joint == was_joint) return;
    auto const kind = [](bool in_joint) {
        return std::string(in_joint ? "joint" : "absolute") + " coordinates";
    };
    throw InputError("the state is in " + kind(was_joint) + ", but integrator " +
                         name_of(scene.dynamics.integrator) + " works in " + kind(joint),
                     file,
                     was_joint
                         ? "use an integrator in joint coordinates (rk4, velocity-verlet, ...)"
                         : "use rattle, g-baoab or implicit-g-baoab");
}

/// What differs if a value under a key that ends so does. Such values are fingerprints, which say
/// nothing to a reader.
constexpr std::pair<std::string_view, char const*> prints[] = {
    {", bodies and joints", "another name, or other bodies, links or joints"},
    {", springs and loads", "other springs or loads"},
    {", start positions", "other start positions"},
    {", start velocities", "other start velocities"}};

/// Returns the name in backticks of the chain behind "chain 3", else the words themselves.
std::string named(std::string_view chain, Scene const& scene) {
    std::string_view constexpr word = "chain ";
    std::size_t number = 0;
    if (chain.starts_with(word))
        std::from_chars(chain.data() + word.size(), chain.data() + chain.size(), number);
    if (number == 0 || number > scene.chains.size()) return std::string(chain);
    return "chain `" + scene::shown(scene.chains[number - 1].name) + "`";
}

/// True if the values are fingerprints of files.
bool is_content(scene::ChangedValue const& each) {
    std::string_view constexpr content = "content ";
    return each.before.starts_with(content) && each.now.starts_with(content);
}

/// Returns what differs as a clause: "dynamics.step was 1, now it is 2", "chain `a` has other start
/// positions".
std::string clause_of(scene::ChangedValue const& each, Scene const& scene) {
    std::string_view const key = each.key;
    for (auto const& [ending, what] : prints)
        if (key.ends_with(ending)) {
            std::string_view const whose = key.substr(0, key.size() - ending.size());
            return named(whose, scene) + (whose.starts_with("chains") ? " have " : " has ") + what;
        }
    if (is_content(each)) return each.key + " has another content";
    return each.key + " was " + each.before + ", now it is " + each.now;
}

/// True if the values are fingerprints.
bool is_print(scene::ChangedValue const& each) {
    return is_content(each) ||
           std::any_of(std::begin(prints), std::end(prints),
                       [&](auto const& print) { return each.key.ends_with(print.first); });
}

/// Returns a change in few words: "dynamics.step 1 -> 2".
std::string text_of(scene::ChangedValue const& each) {
    return each.key + (is_print(each) ? " changed" : " " + each.before + " -> " + each.now);
}

/// Returns the first value that no branch may change, or nullptr.
scene::ChangedValue const* first_fixed(std::vector<scene::ChangedValue> const& changed) {
    auto const found = std::find_if(
        changed.begin(), changed.end(),
        [](scene::ChangedValue const& each) { return each.role == scene::Role::fixed; });
    return found == changed.end() ? nullptr : &*found;
}

}  // namespace

void keep_values(Scene const& scene, std::map<std::string, std::string>& notes) {
    json kept = json::object();
    for (scene::DecidingValue const& each : scene::deciding_values(scene))
        kept[each.key] = each.value;
    notes[note_of_scene] = kept.dump(-1, ' ', true, json::error_handler_t::replace);
}

void require_own(Checkpoint const& c, Scene const& scene, std::string const& file) {
    if (c.scene_hash == scene.hash) return;
    std::string const other = "the checkpoint belongs to another scene";
    std::string const may =
        "restart with its own scene (solver, number of steps and output intervals may differ)";
    Values const before = values_in(c);
    std::vector<scene::ChangedValue> const changed =
        before.empty() ? std::vector<scene::ChangedValue>()
                       : scene::changes(before, scene::deciding_values(scene));
    if (changed.empty()) throw InputError(other, file, may);
    // What no branch can have is named first, and no branch is advised then.
    scene::ChangedValue const* const fixed = first_fixed(changed);
    throw InputError(other + ": " + clause_of(fixed ? *fixed : changed.front(), scene), file,
                     may + (fixed ? ", or start this scene anew"
                                  : ", or branch off with --branch --output OTHER"));
}

std::vector<scene::ChangedValue> branch_changes(Checkpoint const& c, Scene const& scene,
                                                std::string const& file) {
    Values const before = values_in(c);
    if (before.empty())
        throw InputError("the checkpoint does not contain the values of its scene", file,
                         "branch from a checkpoint that this version wrote");
    std::vector<scene::ChangedValue> changed =
        scene::changes(before, scene::deciding_values(scene));
    if (scene::ChangedValue const* const fixed = first_fixed(changed))
        throw InputError(
            "a branch keeps its chains, replicas and units: " + clause_of(*fixed, scene), file,
            "start this scene anew");
    require_same_coordinates(c, scene, file);
    std::erase_if(changed,
                  [](scene::ChangedValue const& each) { return each.role == scene::Role::start; });
    return changed;
}

std::string note_of_branch(std::string const& file, std::int64_t step,
                           std::vector<scene::ChangedValue> const& changes) {
    std::string text = "branched at step " + std::to_string(step) + " from " + file + ": ";
    if (changes.empty()) text += "with the values of its scene";
    for (std::size_t i = 0; i < changes.size(); ++i)
        text += (i > 0 ? ", " : "") + text_of(changes[i]);
    return text + "; the verdict covers the branch only";
}

json json_of_branch(std::string const& file, std::int64_t step,
                    std::vector<scene::ChangedValue> const& changes) {
    json list = json::array();
    for (scene::ChangedValue const& each : changes)
        list.push_back({{"key", each.key}, {"before", each.before}, {"now", each.now}});
    return {{"from", file}, {"step", step}, {"changes", list}};
}

}  // namespace catena
