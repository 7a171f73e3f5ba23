// Chains that are hard to solve, each for one reason.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace catena {

struct StabilityCase {
    std::string family;  // what makes it hard
    std::string name;    // and how hard
    std::int64_t bodies = 0;
    std::function<Scene(std::uint64_t seed)> scene;
};

/// Coils and dills of 2^4 to `longest` bodies; chains of `hard_bodies` with extreme masses,
/// inertias, shapes, rates, springs, dampers and units. `quick`: every other one.
std::vector<StabilityCase> stability_cases(std::int64_t longest, bool quick);

/// Of these sizes alone.
std::vector<StabilityCase> coils_and_dills(std::vector<std::int64_t> const& sizes);

inline constexpr std::int64_t hard_bodies = 64;

}  // namespace catena
