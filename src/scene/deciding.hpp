// What decides a scene's motion, value by value: a checkpoint keeps it, so that a restart can name
// what differs.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace catena::scene {

/// `fixed`: a branch keeps it. `start`: of the scene's first state, in whose place a checkpoint's
/// stands. `free`: a branch may change it.
enum class Role { free, fixed, start };

struct DecidingValue {
    std::string key, value;  // "dynamics.temperature", "300"; of many numbers their fingerprint
    Role role = Role::free;
};

/// Of everything that fingerprint() goes by, dynamics first, chains last. Chains beyond the first
/// thousand share an entry. Throws InputError when a file that the scene names cannot be read any
/// more.
std::vector<DecidingValue> deciding_values(Scene const& scene);

struct ChangedValue {
    std::string key, before, now;  // "none" where a scene has no such key
    Role role = Role::free;
};
/// In the order of `now`; keys that are gone come last.
std::vector<ChangedValue> changes(std::map<std::string, std::string> const& before,
                                  std::vector<DecidingValue> const& now);

}  // namespace catena::scene
