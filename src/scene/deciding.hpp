// The values that decide a scene's motion, one by one. A checkpoint stores them, so that a restart
// can name the values that differ.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace catena::scene {

/// Effect of a changed value on a branch. `fixed`: a branch must keep the value. `start`: the value
/// belongs to the scene's first state, which a checkpoint replaces. `free`: a branch may change the
/// value.
enum class Role { free, fixed, start };

/// One value as text, under its key.
struct DecidingValue {
    std::string key, value;  // "dynamics.temperature", "300"; a fingerprint for many numbers
    Role role = Role::free;
};

/// Returns everything that enters fingerprint(), dynamics first, chains last. Chains beyond the
/// first thousand share an entry. Throws InputError if a file named by the scene can no longer be
/// read.
std::vector<DecidingValue> deciding_values(Scene const& scene);

/// One difference between two scenes.
struct ChangedValue {
    std::string key, before, now;  // "none" where a scene has no such key; one replica is "1"
    Role role = Role::free;
};
/// Returns the differing values in the order of `now`, but `replicas` first. Keys absent from `now`
/// come last.
std::vector<ChangedValue> changes(std::map<std::string, std::string> const& before,
                                  std::vector<DecidingValue> const& now);

}  // namespace catena::scene
