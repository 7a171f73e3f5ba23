// Implements the comparison of a checkpoint's scene with the present one.
#include "run/branch.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "error.hpp"

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
    scene::ChangedValue const& first = changed.front();
    throw InputError(other + ": " + first.key + " was " + first.before + ", now it is " + first.now,
                     file, may + ", or branch off with --branch --output OTHER");
}

std::vector<scene::ChangedValue> branch_changes(Checkpoint const& c, Scene const& scene,
                                                std::string const& file) {
    Values const before = values_in(c);
    if (before.empty())
        throw InputError("the checkpoint does not contain the values of its scene", file,
                         "branch from a checkpoint that this version wrote");
    std::vector<scene::ChangedValue> changed =
        scene::changes(before, scene::deciding_values(scene));
    for (scene::ChangedValue const& each : changed)
        if (each.role == scene::Role::fixed)
            throw InputError("a branch keeps its chains and units: " + each.key + " was " +
                                 each.before + ", now it is " + each.now,
                             file, "start this scene anew");
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
        text += (i > 0 ? ", " : "") + changes[i].key + " " + changes[i].before + " -> " +
                changes[i].now;
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
