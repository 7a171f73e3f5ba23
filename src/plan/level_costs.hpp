// What a level of the pairwise tree costs where it may be computed, and what crosses between two
// such places (chapter, Fig. 2.3).
#pragma once

#include "dca/level_solver.hpp"
#include "plan/phases.hpp"

namespace catena::plan {

/// Of a chain of n bodies: `bodies_up`, `bodies_down` of its bodies; `merges_up`, `merges_down` of
/// one level of n / 2 merges; then what it takes that so many items come to the place or leave it:
/// n bodies' views, n segments up, n forces down, n eliminated joints.
enum LevelCost : std::size_t {
    bodies_up,
    bodies_down,
    merges_up,
    merges_down,
    views,
    segments_up,
    forces_down,
    joints_across,
    level_costs
};
inline constexpr std::array<char const*, level_costs> level_cost_names{
    "bodies up", "bodies down", "merges up",   "merges down",
    "views",     "segments up", "forces down", "joints across"};
using LevelSeconds = std::array<double, level_costs>;
using LevelCurve = Curve<level_costs>;

/// The shortest of several times, at a place whose parts `maker` makes. On one rank; bodies >= 2.
LevelSeconds measure_level_costs(Family const&, std::int64_t bodies,
                                 dca::LevelPartMaker const& maker, Effort const& = {});

}  // namespace catena::plan
