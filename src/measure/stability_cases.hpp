// Chains that are difficult to solve, each for one reason.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace catena {

/// A family of random scenes with one difficulty.
struct StabilityCase {
    std::string family;  // kind of difficulty
    std::string name;    // degree of difficulty
    std::int64_t bodies = 0;
    std::function<Scene(std::uint64_t seed)> scene;
};

/// Returns all cases: coils and dills of 2^4 to `longest` bodies, and chains of `hard_bodies`
/// bodies with extreme masses, inertias, shapes, rates, springs, dampers and units. `quick`: only
/// the first and the last power of ten of each.
std::vector<StabilityCase> stability_cases(std::int64_t longest, bool quick);

/// Returns coils and dills of these sizes only.
std::vector<StabilityCase> coils_and_dills(std::vector<std::int64_t> const& sizes);

// bodies of the cases other than coils and dills
inline constexpr std::int64_t hard_bodies = 64;

}  // namespace catena
