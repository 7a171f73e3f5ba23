// How many of the pairwise tree's lowest levels a GPU should have (chapter, Fig. 2.3, extended to
// the way down).
#pragma once

#include <vector>

#include "plan/level_costs.hpp"

namespace catena::plan {

/// A group of chains, and what its levels cost on the host and on the GPU.
struct LevelledShare {
    Share share;
    LevelCurve host, gpu;
};

/// Row 0: the bodies; row l: level l of merges, all groups together.
struct LevelRow {
    std::int64_t items = 0;  // bodies or merges
    double host_up = 0, host_down = 0, gpu_up = 0, gpu_down = 0;
    double cut_up = 0, cut_down = 0;  // what crosses where the tree is cut above this row
};

class LevelPlan {
  public:
    explicit LevelPlan(std::vector<LevelledShare> const&);
    std::vector<LevelRow> const& rows() const { return rows_; }
    int levels() const { return static_cast<int>(rows_.size()) - 1; }
    /// Seconds of both sweeps, transfers included.
    double seconds(GpuLevels) const;
    /// The cut that takes least.
    GpuLevels best() const;

  private:
    void add(LevelledShare const&);
    std::vector<LevelRow> rows_;
    std::vector<LevelledShare> shares_;
    double views_ = 0;  // what bodies on the GPU need of the host and give back
};

}  // namespace catena::plan
