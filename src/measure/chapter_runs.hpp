// Measurements of the DCA chapter repeated: its pendulum, released from rest, takes one step of RK4
// on every combination of CPU and GPU that this machine has.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "measure/timing.hpp"

namespace catena {

/// Returns the chapter's scene with `links` links. `overrides` has the meaning it has in
/// parse_scene().
Scene chapter_pendulum(std::int64_t links, std::vector<std::string> const& overrides);

/// One backend in the figures.
struct FigureCase {
    std::string name;  // name in the figures: "serial", "cuda-levels 3"
    Backend backend;
    // solver.gpu_levels: number of tree levels on the GPU
    std::string gpu_levels = "auto";
};
/// Returns all cases that this machine can run. `left_out` gets one line for each of the others.
std::vector<FigureCase> figure_cases(std::vector<std::string>& left_out);

/// Times of one case, in seconds.
struct FigurePoint {
    FigureCase what;
    Handles handles = Handles::full;
    std::int64_t bodies = 0;
    int threads = 1;
    Spread step;   // one RK4 step: four solves, kinematics and everything else
    Spread solve;  // both sweeps of one evaluation, transfers included
    /// Parts of one solve if the tree is cut into levels (cuda-levels): transfers, levels below and
    /// above the cut.
    std::optional<Spread> upload, download, lower, upper;
    double residual = 0, residual_bound = 0;  // backward error of the evaluation at the start
    /// True if the residual is within its bound.
    bool valid() const { return residual <= residual_bound; }
};
/// Measures all cases. They run alternately, so that a disturbance of the machine affects all of
/// them. Collective.
std::vector<FigurePoint> measure_steps(std::vector<FigureCase> const&, Handles, std::int64_t bodies,
                                       int threads, int repeat, Communicator const&);

/// Times of one tree level; the first level includes the bodies' own work. They are seconds per
/// solve: medians of differences between trees cut below and above the level. NaN if noise exceeds
/// the difference, so that it is not resolved.
struct LevelSeconds {
    double assembly = 0, disassembly = 0;
};
/// One tree level on one core, on several threads and on the GPU.
struct LevelPoint {
    int level = 1;
    std::int64_t merges = 0;
    LevelSeconds one_core;
    std::optional<LevelSeconds> threads, gpu;
    // Seconds of transfers to and from the GPU if the tree is cut above this level.
    std::optional<double> transfers;
};
/// Times of all tree levels of the chapter's pendulum.
struct LevelStudy {
    Handles handles = Handles::full;
    std::int64_t bodies = 0;
    int threads = 1;  // threads of LevelPoint::threads
    std::vector<LevelPoint> levels;
    double residual = 0, residual_bound = 0;  // largest of all cuts
    bool valid() const { return residual <= residual_bound; }
};
/// Measures all levels. Precondition: one rank.
LevelStudy measure_levels(Handles, std::int64_t bodies, int threads, int repeat);

/// Returns the number of merges in each level of the pairwise tree.
std::vector<std::int64_t> merges_of_levels(std::int64_t bodies);

}  // namespace catena
