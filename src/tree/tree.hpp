// The canonical tree: a function of a chain's length and the run length alone, never of ranks or
// threads, so that the same scene gives the same bits on any number of them.
//
// A chain's bodies form runs of `run_length`; node i of level l covers runs [i 2^l, (i + 1) 2^l).
// The nodes of the cut level (at most `max_units` a chain) are the units: ranks own whole units,
// and above them every rank finishes the tree itself.
#pragma once

#include <cstdint>
#include <vector>

#include "math/host_device.hpp"

namespace catena::dca {

/// Stands in reports and checkpoints: another version may give other bits.
inline constexpr int tree_table_version = 2;
inline constexpr std::int64_t max_units = 64;
inline constexpr std::int64_t longest_run = 16;
/// A run's bodies are joined in parts of so many, which are independent of each other until they
/// join.
inline constexpr int part_length = 4, parts_of_run = static_cast<int>(longest_run) / part_length;

/// `pairwise`: the chapter's tree of pairs.
inline std::int64_t run_length_for(bool pairwise) { return pairwise ? 1 : longest_run; }

struct ChainTree {
    std::int64_t bodies = 0, run_length = 1;
    std::int64_t runs = 0;
    int cut_level = 0;
    std::int64_t units = 0;

    ChainTree(std::int64_t bodies, std::int64_t run_length);
    std::int64_t nodes(int level) const { return ((runs - 1) >> level) + 1; }
    std::int64_t first_run(int level, std::int64_t node) const { return node << level; }
    /// First body of a node; for node = nodes(level) the number of bodies.
    std::int64_t first_body(int level, std::int64_t node) const;
    std::int64_t first_body_of_unit(std::int64_t unit) const { return first_body(cut_level, unit); }
    /// Levels of merges above the runs, and merges from the first body to the root along the
    /// longest way.
    int levels() const;
    std::int64_t depth() const { return run_length - 1 + levels(); }
};

/// What a chain's last body is joined to.
enum class TipTo : std::uint8_t { nothing, ground, first_body };

/// Chains laid one after the other, cut into whole units for the ranks.
class Partition {
  public:
    Partition() = default;
    /// `lengths` of the chains; every rank gets a run of units of about equal numbers of bodies.
    /// Ranks may be left without any. `tips`: one a chain; empty: free.
    Partition(std::vector<std::int64_t> const& lengths, bool pairwise, int ranks,
              std::vector<TipTo> const& tips = {});

    std::vector<ChainTree> trees;              // one a chain
    std::vector<std::int64_t> first_of_chain;  // chains + 1
    std::vector<std::int64_t> first_of_rank;   // ranks + 1
    std::vector<TipTo> tip;                    // one a chain

    std::int64_t bodies() const { return first_of_chain.back(); }
    int chains() const { return static_cast<int>(trees.size()); }
    int owner(std::int64_t body) const;
    int chain_of(std::int64_t body) const;
    bool has_jointed_tip(int chain) const { return tip[chain] != TipTo::nothing; }
    bool is_split(int chain) const {
        return owner(first_of_chain[chain]) != owner(first_of_chain[chain + 1] - 1);
    }
};

/// The part of one chain that a rank owns. Indices: `local` counts the rank's bodies over all its
/// pieces, `body` the chain's.
struct Piece {
    int chain = 0;
    std::int64_t local = 0, body = 0, count = 0;
    std::int64_t first_unit = 0, units = 0;
    bool starts = false, ends = false;  // holds the chain's first, last body
    bool whole() const { return starts && ends; }
};
std::vector<Piece> pieces_of(Partition const&, int rank);

/// What a driver iterates over: plain lists, level by level. Joint forces live in one storage,
/// indexed by `joint`, `first`, `next` (see JointStorage); segments in another, indexed by slots.
struct Run {
    std::int64_t body = 0, count = 0, slot = 0;  // local bodies [body, body + count)
    std::int64_t next = 0;                       // storage index of the joint that follows the run
};
CATENA_HD int parts_of(Run const& run) {
    return static_cast<int>((run.count + part_length - 1) / part_length);
}
CATENA_HD std::int64_t begin_of(Run const& run, int part) { return run.body + part * part_length; }
CATENA_HD std::int64_t end_of(Run const& run, int part) {
    std::int64_t const end = (part + 1) * part_length;
    return run.body + (end < run.count ? end : run.count);
}
struct Merge {
    std::int64_t inboard = 0, outboard = 0, slot = 0;
    std::int64_t first = 0, joint = 0, next = 0;
};
struct Root {
    std::int64_t slot = 0;
    std::int64_t first = 0, next = 0;
    int chain = 0;
    TipTo tip = TipTo::nothing;  // whether `next` is a joint to the ground, or the same as `first`:
                                 // that of a ring
};
/// A unit of a chain that several ranks share.
struct FrontierUnit {
    std::int64_t slot =
        0;  // where its segment lies; on other ranks than the owner, after the gather
    int owner = 0;
    bool is_own = false;
};

struct Schedule {
    // Storage of joints: [0, bodies): own ones; `halo`: the joint after the last body; `none`:
    // always 0; then the jointed tips of chains that end here; then those at the top of shared
    // chains that are none of these.
    std::int64_t bodies = 0;
    std::int64_t halo = 0, none = 0, joints = 0;
    std::int64_t slots = 0;
    std::vector<Run> runs;
    std::vector<std::vector<Merge>>
        levels;                        // below the roots of whole chains and below shared units
    std::vector<Root> roots;           // of whole chains
    std::vector<FrontierUnit> shared;  // of all shared chains, in order; the same list on every
                                       // rank (but for slots and whose they are)
    std::vector<std::vector<Merge>> top_levels;  // of the shared chains this rank takes part in
    std::vector<Root> top_roots;
    std::vector<int> tip_chain;           // of the jointed tips that end here
    std::vector<int> top_chain_of_joint;  // of the joints stored for the top: chain and body (a
                                          // tip: the number of bodies)
    std::vector<std::int64_t> top_body_of_joint;
    std::int64_t first_tip() const { return none + 1; }
    std::int64_t first_top_joint() const {
        return first_tip() + static_cast<std::int64_t>(tip_chain.size());
    }
};
Schedule make_schedule(Partition const&, int rank);

}  // namespace catena::dca
