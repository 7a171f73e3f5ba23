// One value that decides a scene's motion, as text under its key.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

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
using DecidingValues = std::vector<DecidingValue>;

/// Appends a value.
template <class Number>
void add(DecidingValues& values, std::string key, Number const& number, Role role = Role::free) {
    values.push_back({std::move(key), fmt::format("{}", number), role});
}

}  // namespace catena::scene
