// Branched chains as paths. Each chain is cut into heavy paths, and each path is to a solver what
// an unbranched chain is: bodies one after the other, with a tree of its own. The paths depend on
// the parents alone, never on threads.
//
// A path goes on with the child that has most bodies outboard of it; among equals with the one of
// the smallest number. The other children are heads of paths of their own, side paths, which hang
// on the body.
//
// Phases count from the tips. The phase of a body without side paths is 0, that of another one more
// than the largest of its side paths, and that of a segment or path the largest of its bodies. The
// work of a phase needs that of the phases before it. There are at most floor(log2(bodies)) + 1.
//
// The tree of a path is cut where the weights of both sides are nearest to each other, and inboard
// among equals. A body counts a quarter of one of the next phase, so that what is ready late is
// merged late and waits for little. Segments of one phase are merged in pairs as in ChainTree;
// unbranched paths have that tree. Bodies of phases 0 and 1 form runs, others are leaves alone.
//
// Places number the bodies anew, path after path: first the paths of the chains' first bodies, then
// all side paths on these, then the side paths on those. Within each of these sets, paths stand in
// the order of the places on which they hang. All paths on one body are therefore consecutive.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "tree/tree.hpp"

namespace catena::dca {

/// A body with side paths, and its paths [first_path, end_path).
struct Fork {
    std::int64_t place = 0;
    std::int64_t first_path = 0, end_path = 0;
    CATENA_HD std::int64_t paths() const { return end_path - first_path; }
};

/// Work lists of one phase, as in Schedule. Merges may need segments of earlier phases, and later
/// phases may need segments that are no roots.
struct PhaseLists {
    std::vector<Run> runs;
    std::vector<std::vector<Merge>> levels;
    std::vector<Root> roots;
};

/// Counts of the paths of branched chains on all ranks.
struct BranchCounts {
    std::int64_t paths = 0, runs = 0;
    /// Largest number of phases, and of levels of merges in one of them.
    std::int64_t phases = 0, levels = 0;
    /// Largest depth, as Branches::depth().
    std::int64_t depth = 0;
};

/// The paths of branched chains on one rank.
struct Branches {
    Branches() = default;
    /// Cuts chains into paths. `inboard` is the inboard body of each body, -1 for the first bodies
    /// of chains; it is smaller than the body's own number. `pairwise` as in Partition.
    Branches(std::span<std::int64_t const> inboard, bool pairwise);

    /// Body at each place.
    std::vector<std::int64_t> body;
    /// First place of each path; [paths + 1].
    std::vector<std::int64_t> first_of_path;
    /// First path of each generation: of the chains' first bodies, of the side paths on these, and
    /// so on; [generations + 1].
    std::vector<std::int64_t> first_of_generation{0};
    /// Bodies with side paths, sorted by phase and place, and the first fork of each phase;
    /// [phases + 1]. The side paths of a phase's forks are roots of phases before.
    std::vector<Fork> forks;
    std::vector<std::int64_t> first_fork_of_phase{0};
    /// Work lists of each phase. Joints have the numbers of places, `none` follows them.
    std::vector<PhaseLists> lists;
    /// Numbers of segments and joints in the lists.
    std::int64_t slots = 0, joints = 0;
    /// Counts of all ranks, which those who know the ranks set.
    BranchCounts of_all_ranks;

    /// First side path; the paths before it are those of the chains' first bodies.
    std::int64_t first_side() const { return paths() == 0 ? 0 : first_of_generation[1]; }
    std::int64_t phases() const { return static_cast<std::int64_t>(lists.size()); }
    std::int64_t paths() const { return std::max<std::int64_t>(0, std::ssize(first_of_path) - 1); }
    /// Steps of all phases, one after the other: eliminations in the longest run, levels of merges,
    /// and the longest sum over side paths.
    std::int64_t depth() const { return depth_; }
    /// Counts of this rank.
    BranchCounts counts() const;

  private:
    std::int64_t depth_ = 0;
};

}  // namespace catena::dca
