// The canonical tree of a chain. It depends on the chain's length and the run length alone, never
// on ranks or threads. The same scene therefore gives the same bits on any number of ranks and
// threads.
//
// A chain's bodies form runs of `run_length` bodies. Node i of level l covers runs
// [i 2^l, (i + 1) 2^l); levels count from the leaves upwards. The nodes of the cut level (at most
// `max_units` per chain) are the units. A rank owns whole units, and every rank of a shared chain
// computes the levels above the units itself.
#pragma once

#include <cstdint>
#include <vector>

#include "math/host_device.hpp"

namespace catena::dca {

/// Version of the tree's construction, written to reports and checkpoints. Another version may give
/// other bits.
inline constexpr int tree_table_version = 2;
/// Largest number of units per chain.
inline constexpr std::int64_t max_units = 64;
/// Number of bodies of a run; the last run of a chain may be shorter, and pairwise trees have none.
inline constexpr std::int64_t longest_run = 16;
/// Number of bodies in a part of a run, and largest number of parts. The parts of a run are joined
/// independently, then merged with each other.
inline constexpr int part_length = 4, parts_of_run = static_cast<int>(longest_run) / part_length;

/// Number of bodies per run. `pairwise` selects the tree of pairs of the chapter, without runs.
inline std::int64_t run_length_for(bool pairwise) { return pairwise ? 1 : longest_run; }

/// Shape of the tree of one chain.
struct ChainTree {
    std::int64_t bodies = 0, run_length = 1;
    /// Number of leaves of the tree.
    std::int64_t runs = 0;
    /// Level whose nodes are the units.
    int cut_level = 0;
    std::int64_t units = 0;

    ChainTree(std::int64_t bodies, std::int64_t run_length);
    std::int64_t nodes(int level) const { return ((runs - 1) >> level) + 1; }
    /// Index of the first run that a node covers.
    std::int64_t first_run(int level, std::int64_t node) const { return node << level; }
    /// Index of a node's first body in the chain; for node = nodes(level) the number of bodies.
    std::int64_t first_body(int level, std::int64_t node) const;
    std::int64_t first_body_of_unit(std::int64_t unit) const { return first_body(cut_level, unit); }
    /// Number of merge levels above the runs; depth() counts the steps from the first body to the
    /// root along the longest path.
    int levels() const;
    std::int64_t depth() const { return run_length - 1 + levels(); }
};

/// Partner of the joint at the outboard end of a chain's last body.
enum class TipTo : std::uint8_t { nothing, ground, first_body };

/// Chains laid one after the other, and cut into whole units for the ranks.
class Partition {
  public:
    Partition() = default;
    /// Cuts chains of the given `lengths` (bodies) into one contiguous range of units per rank,
    /// with about equal numbers of bodies. Ranks may be left without bodies. `tips` has one entry
    /// per chain; empty: all tips are free.
    Partition(std::vector<std::int64_t> const& lengths, bool pairwise, int ranks,
              std::vector<TipTo> const& tips = {});

    // Trees, one per chain.
    std::vector<ChainTree> trees;
    // First body of each chain, and the number of bodies; [chains + 1].
    std::vector<std::int64_t> first_of_chain;
    // First body of each rank, and the number of bodies; [ranks + 1].
    std::vector<std::int64_t> first_of_rank;
    // Partner of the tip joint, one per chain.
    std::vector<TipTo> tip;
    // True if no chain may be shared by ranks. cut_by_shares() reads it.
    bool whole_chains = false;

    std::int64_t bodies() const { return first_of_chain.back(); }
    int chains() const { return static_cast<int>(trees.size()); }
    /// Rank that owns a body.
    int owner(std::int64_t body) const;
    int chain_of(std::int64_t body) const;
    /// True if the chain's last body has an outboard joint.
    bool has_jointed_tip(int chain) const { return tip[chain] != TipTo::nothing; }
    /// True if several ranks own bodies of the chain.
    bool is_split(int chain) const {
        return owner(first_of_chain[chain]) != owner(first_of_chain[chain + 1] - 1);
    }
};

/// Part of one chain that a rank owns. `local` is the first body's index among the rank's bodies,
/// `body` its index in the chain.
struct Piece {
    int chain = 0;
    std::int64_t local = 0, body = 0, count = 0;
    std::int64_t first_unit = 0, units = 0;
    /// True if the piece contains the chain's first (`starts`) or last (`ends`) body.
    bool starts = false, ends = false;
    bool whole() const { return starts && ends; }
};
/// Returns the pieces of a rank along the chains.
std::vector<Piece> pieces_of(Partition const&, int rank);

/// Run of consecutive bodies: a leaf of the tree.
struct Run {
    std::int64_t body = 0, count = 0, slot = 0;  // local bodies [body, body + count)
    std::int64_t next = 0;                       // storage index of the joint after the run
};
/// Number of parts of a run; part p covers local bodies [begin_of(run, p), end_of(run, p)).
CATENA_HD int parts_of(Run const& run) {
    return static_cast<int>((run.count + part_length - 1) / part_length);
}
CATENA_HD std::int64_t begin_of(Run const& run, int part) { return run.body + part * part_length; }
CATENA_HD std::int64_t end_of(Run const& run, int part) {
    std::int64_t const end = (part + 1) * part_length;
    return run.body + (end < run.count ? end : run.count);
}
/// Merge of two neighbouring segments: eliminates the joint between them.
struct Merge {
    /// Slots of the two segments and of their union.
    std::int64_t inboard = 0, outboard = 0, slot = 0;
    /// Storage indices: the inboard segment's first joint, the eliminated joint, and the joint
    /// after the outboard segment.
    std::int64_t first = 0, joint = 0, next = 0;
};
/// Root of a chain's tree.
struct Root {
    std::int64_t slot = 0;
    std::int64_t first = 0, next = 0;
    int chain = 0;
    /// Kind of joint at `next`: a joint to the ground, or the closing joint of a ring; in a ring
    /// `next` equals `first`.
    TipTo tip = TipTo::nothing;
};
/// Unit of a chain that several ranks share.
struct FrontierUnit {
    /// Slot of the unit's segment; on ranks other than the owner it is valid after the gather.
    std::int64_t slot = 0;
    /// Rank that owns the unit.
    int owner = 0;
    bool is_own = false;
};

/// Work lists of one rank: runs, merges and roots, over which a driver iterates level by level.
/// Joint forces have one storage, indexed by `joint`, `first` and `next` (see JointStorage).
/// Segments have another, indexed by slots.
struct Schedule {
    // Storage of joints: indices [0, bodies) are the inboard joints of own bodies. `halo` is the
    // joint after the last body; `none` is always 0. Jointed tips of chains that end on this rank
    // follow, then the remaining joints above the units of shared chains.
    std::int64_t bodies = 0;
    /// Storage indices, and the number of joints stored.
    std::int64_t halo = 0, none = 0, joints = 0;
    /// Number of segments.
    std::int64_t slots = 0;
    std::vector<Run> runs;
    /// Merges below the roots of whole chains and below shared units, one list per level.
    std::vector<std::vector<Merge>> levels;
    /// Roots of whole chains.
    std::vector<Root> roots;
    /// Units of all shared chains, in order. Every rank has the same list except for `slot` and
    /// `is_own`.
    std::vector<FrontierUnit> shared;
    /// Merges above the units of those shared chains of which this rank owns a part.
    std::vector<std::vector<Merge>> top_levels;
    std::vector<Root> top_roots;
    /// Chains of the jointed tips that end on this rank.
    std::vector<int> tip_chain;
    /// Chain and body of every joint stored for the top; a tip's body is the chain's number of
    /// bodies.
    std::vector<int> top_chain_of_joint;
    std::vector<std::int64_t> top_body_of_joint;
    /// Storage index of the first jointed tip, and of the first joint stored for the top.
    std::int64_t first_tip() const { return none + 1; }
    std::int64_t first_top_joint() const {
        return first_tip() + static_cast<std::int64_t>(tip_chain.size());
    }
};
/// Returns the work lists of a rank. Not collective: every rank knows the whole partition.
Schedule make_schedule(Partition const&, int rank);

}  // namespace catena::dca
