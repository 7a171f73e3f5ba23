// Declarations of keys: name, type, default, unit and one sentence each. The reader of scenes knows
// no other keys. `catena keys` prints the declarations, and the tables of inputs/ are made of them.
#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace catena::scene {

/// One key of a map in a scene. Every text but `unit` and `example` has at least one character.
struct Key {
    std::string_view name;
    /// Type in words, such as "number > 0". Names in backquotes are all values of a choice.
    std::string_view type;
    /// Value that the reader takes for an absent key, or "required". In backquotes: a value of a
    /// choice, as one writes it.
    std::string_view fallback;
    /// Unit in words, such as "mass / time"; empty for texts, choices and plain numbers. Length,
    /// mass, time and energy are those of the scene's `units`.
    std::string_view unit;
    /// One sentence with its full stop that says what the key does.
    std::string_view meaning;
    /// The key with a value, such as "step: 0.01"; empty if the type says enough.
    std::string_view example = {};
};

/// All keys that one kind of map may have.
struct KeyMap {
    /// Name for `catena keys`, unique among all maps, such as "forces.openmm".
    std::string_view name;
    /// Path of such a map in a scene, such as "chains[i].bodies[k].joint".
    std::string_view place;
    /// Declared keys; their order is that of messages and tables.
    std::span<Key const> keys;
    /// Names that are reserved for later versions. The reader refuses them by name.
    std::span<std::string_view const> later = {};

    /// Returns the declaration of a key, or nullptr for a name that is not declared.
    constexpr Key const* find(std::string_view wanted) const {
        for (Key const& key : keys)
            if (key.name == wanted) return &key;
        return nullptr;
    }
    /// Returns the names of the declared keys in their order.
    std::vector<std::string_view> names() const {
        std::vector<std::string_view> all;
        for (Key const& key : keys) all.push_back(key.name);
        return all;
    }
};

}  // namespace catena::scene
