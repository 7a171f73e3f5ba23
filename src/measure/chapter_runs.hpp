// The founding chapter's measurements done again: its pendulum, released from rest, one step of
// RK4, on every arrangement of CPU and GPU that this machine has.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "measure/timing.hpp"

namespace catena {

/// The chapter's case with so many links; `overrides` as parse_scene's.
Scene chapter_pendulum(std::int64_t links, std::vector<std::string> const& overrides);

struct FigureCase {
    std::string name;  // "serial", "cuda-levels 3"
    Backend backend;
    std::string gpu_levels = "auto";
};
/// All that figures compare, as far as this machine has it; `left_out` gets a line for each of the
/// others.
std::vector<FigureCase> figure_cases(std::vector<std::string>& left_out);

/// Seconds.
struct FigurePoint {
    FigureCase what;
    Handles handles = Handles::full;
    std::int64_t bodies = 0;
    int threads = 1;
    Spread step;   // of RK4: four solves, kinematics, everything
    Spread solve;  // both sweeps of one evaluation, transfers included
    std::optional<Spread> upload, download, lower,
        upper;                                // of one solve; where the tree is cut into levels
    double residual = 0, residual_bound = 0;  // at the start
    bool valid() const { return residual <= residual_bound; }
};
/// The cases turn about, so that what disturbs the machine disturbs all of them. Collective.
std::vector<FigurePoint> measure_steps(std::vector<FigureCase> const&, Handles, std::int64_t bodies,
                                       int threads, int repeat, Communicator const&);

/// One level of the tree; the first one includes the bodies' own work. Seconds of one solve,
/// medians of differences between trees cut below and above the level; NaN where noise is larger
/// than the difference: not resolved.
struct LevelSeconds {
    double assembly = 0, disassembly = 0;
};
struct LevelPoint {
    int level = 1;
    std::int64_t merges = 0;
    LevelSeconds one_core;
    std::optional<LevelSeconds> threads, gpu;
    std::optional<double> transfers;  // up and down where the tree is cut above this level
};
struct LevelStudy {
    Handles handles = Handles::full;
    std::int64_t bodies = 0;
    int threads = 1;  // of `threads`
    std::vector<LevelPoint> levels;
    double residual = 0, residual_bound = 0;  // the worst of all cuts
    bool valid() const { return residual <= residual_bound; }
};
/// On one rank.
LevelStudy measure_levels(Handles, std::int64_t bodies, int threads, int repeat);

/// Merges of each level of the pairwise tree.
std::vector<std::int64_t> merges_of_levels(std::int64_t bodies);

}  // namespace catena
