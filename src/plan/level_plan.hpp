// Finds how many of the pairwise tree's lowest levels a GPU should compute (chapter, Fig. 2.3,
// extended to the outward pass).
#pragma once

#include <vector>

#include "plan/level_costs.hpp"

namespace catena::plan {

/// A group of chains with the measured times of its levels on the host and on the GPU.
struct LevelledShare {
    Share share;
    LevelCurve host, gpu;
};

/// Predicted seconds of one row of the tree, summed over all groups. Row 0 holds the bodies, row l
/// the merges of level l. `up` is the assembly, `down` the disassembly.
struct LevelRow {
    /// Number of bodies or merges.
    std::int64_t items = 0;
    double host_up = 0, host_down = 0, gpu_up = 0, gpu_down = 0;
    /// Seconds of the transfers if the tree is cut above this row.
    double cut_up = 0, cut_down = 0;
};

/// Predicted times of all possible cuts of the tree between GPU and host.
class LevelPlan {
  public:
    explicit LevelPlan(std::vector<LevelledShare> const&);
    /// Predicted seconds, row by row from the bodies to the root.
    std::vector<LevelRow> const& rows() const { return rows_; }
    /// Number of levels of merges.
    int levels() const { return static_cast<int>(rows_.size()) - 1; }
    /// Returns the seconds of both sweeps, transfers included.
    double seconds(GpuLevels) const;
    /// Returns the cut with the shortest time.
    GpuLevels best() const;

  private:
    void add(LevelledShare const&);
    std::vector<LevelRow> rows_;
    std::vector<LevelledShare> shares_;
    /// Seconds in which bodies on the GPU receive inputs from the host and return results.
    double views_ = 0;
};

}  // namespace catena::plan
