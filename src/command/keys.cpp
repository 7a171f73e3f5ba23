// Implements `keys`: its options, and the declared keys of a scene as text and JSON.
#include <fmt/format.h>

#include <vector>

#include "command/commands.hpp"
#include "command/shared_options.hpp"
#include "console/option_values.hpp"
#include "console/text.hpp"
#include "error.hpp"
#include "keys/maps.hpp"

namespace catena::command {
namespace {

using scene::Key;
using scene::KeyMap;

/// Declared keys of one map, all or some.
struct Chosen {
    KeyMap const& map;
    std::vector<Key> keys;
};

/// True for the map itself, for the maps within it, and for the last part of its name.
bool is_named(KeyMap const& map, std::string const& name) {
    return map.name == name || map.name.starts_with(name + ".") || map.name.ends_with("." + name);
}

/// Returns the maps that `name` names; an empty name means all.
std::vector<Chosen> maps_named(std::string const& name) {
    std::vector<Chosen> chosen;
    for (KeyMap const* const map : scene::keys::all())
        if (name.empty() || is_named(*map, name))
            chosen.push_back({*map, {map->keys.begin(), map->keys.end()}});
    return chosen;
}

/// Returns the declarations of the key `name` in all maps that have it.
std::vector<Chosen> keys_named(std::string const& name) {
    std::vector<Chosen> chosen;
    for (KeyMap const* const map : scene::keys::all())
        if (Key const* const key = map->find(name)) chosen.push_back({*map, {*key}});
    return chosen;
}

/// Returns what `name` names: maps, before them keys that take another value in place of such a
/// map, as `model` does; or else keys.
std::vector<Chosen> declarations(std::string const& name) {
    std::vector<Chosen> const maps = maps_named(name), keys = keys_named(name);
    if (maps.empty()) return keys;
    std::vector<Chosen> chosen;
    for (Chosen const& each : keys)
        if (each.keys.front().type.find("or a map") != std::string_view::npos)
            chosen.push_back(each);
    for (Chosen const& each : maps) chosen.push_back(each);
    return chosen;
}

/// Throws InputError that suggests the nearest name of a map or key.
[[noreturn]] void refuse_name(std::string const& name) {
    std::vector<std::string_view> known;
    for (KeyMap const* const map : scene::keys::all()) {
        known.push_back(map->name);
        for (Key const& key : map->keys) known.push_back(key.name);
    }
    std::string const remedy = remedy_for(name, known);
    throw InputError("`" + name + "` is neither a key nor a map of keys", "command line",
                     remedy.starts_with("did") ? remedy : "catena keys prints all of them");
}

void add(Text& text, Key const& key) {
    text.entry(std::string(key.name),
               fmt::format("{}{}{}; default: {}", key.type,
                           key.unit.empty() ? "" : "; unit: ", key.unit, key.fallback));
    text.entry("", std::string(key.meaning));
    if (!key.example.empty()) text.entry("", std::string(key.example));
}

Text text_of(std::vector<Chosen> const& chosen) {
    Text text;
    for (auto const& [map, keys] : chosen) {
        text.heading(fmt::format("{} ({})", map.name, map.place));
        for (Key const& key : keys) add(text, key);
    }
    return text;
}

Json json_of(Chosen const& chosen) {
    Json keys = Json::array();
    for (Key const& key : chosen.keys)
        keys.push_back({{"key", key.name},
                        {"type", key.type},
                        {"default", key.fallback},
                        {"unit", key.unit},
                        {"meaning", key.meaning},
                        {"example", key.example}});
    return {{"map", chosen.map.name}, {"place", chosen.map.place}, {"keys", keys}};
}

class KeysCommand final : public Command {
  public:
    std::string name() const override { return "keys"; }
    std::string meaning() const override {
        return "print the keys that a scene may have: type, default, unit, meaning";
    }
    SharedOptions shared() const override { return SharedOptions::answer; }
    void add_options(OptionList& list, CommonOptions&) override {
        list.argument("NAME", key_,
                      "a map, such as dynamics or forces.openmm, or a key, such as friction "
                      "(default: all maps)");
        list.footer(
            "Examples:\n  catena keys dynamics\n  catena keys friction\n  catena keys --json "
            "keys.json");
    }
    Request request(CommonOptions const& common) const override {
        auto request = common_request<KeysRequest>(common);
        request.name = key_;
        return request;
    }

  private:
    std::string key_;
};

}  // namespace

std::unique_ptr<Command> keys_command() { return std::make_unique<KeysCommand>(); }

Outcome declared_keys(KeysRequest const& request) {
    std::vector<Chosen> const chosen = declarations(request.name);
    if (chosen.empty()) refuse_name(request.name);
    Outcome outcome;
    outcome.text = text_of(chosen).str();
    outcome.json["maps"] = Json::array();
    for (Chosen const& each : chosen) outcome.json["maps"].push_back(json_of(each));
    return outcome;
}

}  // namespace catena::command
