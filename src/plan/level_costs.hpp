// Times of the parts of one level of the pairwise tree, on the host or on the GPU, and of transfers
// between the two (chapter, Fig. 2.3).
#pragma once

#include "dca/level_solver.hpp"
#include "plan/phases.hpp"

namespace catena::plan {

/// Parts of a level, for a chain of n bodies. `bodies_up` and `bodies_down` are the assembly and
/// disassembly of its bodies, `merges_up` and `merges_down` those of one level of n / 2 merges. The
/// others are transfers to or from the place: views of n bodies, n segments on the inward pass, n
/// forces on the outward pass, n eliminated joints.
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
/// Names of the parts, in the order of LevelCost.
inline constexpr std::array<char const*, level_costs> level_cost_names{
    "bodies up", "bodies down", "merges up",   "merges down",
    "views",     "segments up", "forces down", "joints across"};
/// Seconds of each part.
using LevelSeconds = std::array<double, level_costs>;
/// Seconds of each part as functions of the number of bodies.
using LevelCurve = Curve<level_costs>;

/// Returns the shortest of several times, on the place whose parts `maker` makes. Runs on one rank.
/// Precondition: bodies >= 2.
LevelSeconds measure_level_costs(Family const&, std::int64_t bodies,
                                 dca::LevelPartMaker const& maker, Effort const& = {});

}  // namespace catena::plan
