// The values that decide a scene's motion, one by one. A checkpoint stores them, so that a restart
// can name the values that differ.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scene/scene.hpp"
#include "terms/deciding_value.hpp"

namespace catena::scene {

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
