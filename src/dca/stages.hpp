// How the runs, merges and roots of a tree are dealt out to blocks of threads: a block climbs several levels of its own subtrees before
// others need them, so that a sweep takes few launches.
#pragma once

#include <cstdint>
#include <vector>

#include "dca/tree.hpp"

namespace catena::dca {

struct Range {
    std::int64_t begin = 0, end = 0;
};

/// One launch upwards and one downwards. Block b does the runs of `run[b]`, then, level by level, the merges of `merge[b * levels + l]` and
/// at last the roots of `root[b]`. Between blocks of a stage nothing is shared.
struct Stage {
    int levels = 0;
    std::vector<Range> run;    // in the schedule's runs; empty but in the first stage
    std::vector<Range> merge;  // in the list of all levels' merges, one after the other
    std::vector<Range> root;   // in StagePlan::roots
    int blocks() const { return static_cast<int>(root.size()); }
};

struct StagePlan {
    std::vector<Stage> stages;  // from the leaves up
    std::vector<Root> roots;    // the schedule's, in the order of stages and blocks
    bool runs_apart = false;    // runs are in no stage: they come before all of them
};

/// Blocks of `threads`. There are at most two stages, runs apart: five launches for a sweep up and down.
StagePlan plan_stages(std::vector<Run> const& runs, std::vector<std::vector<Merge>> const& levels, std::vector<Root> const& roots,
                      std::int64_t slots, std::int64_t threads);

/// For work that whole chains do alone, one block each: no block needs another.
struct BlockPlan {
    Stage stage;
    std::vector<Root> roots;
    std::vector<Range> body, tip;  // of every block: its bodies, and its chains' jointed tips
    std::int64_t blocks() const { return std::ssize(body); }
};

/// Neighbouring chains share a block while they have at most `width` runs together. `tip`: the last bodies of chains with a jointed tip.
/// Precondition: no chain is shared with other ranks.
BlockPlan plan_blocks(Schedule const&, std::vector<std::int64_t> const& tip, std::int64_t width);

}  // namespace catena::dca
