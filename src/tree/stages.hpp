// Distribution of a tree's runs, merges and roots over the blocks of a GPU. A block merges several
// levels of its own subtrees before other blocks need the result, so that a sweep takes few
// launches.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "math/host_device.hpp"
#include "tree/tree.hpp"

namespace catena::dca {

/// Half-open range [begin, end) of indices.
struct Range {
    std::int64_t begin = 0, end = 0;
};

/// Input of a block: a run, or a segment that another stage produced. Item i has place i among the
/// block's segments; its inboard joint has place i among the block's forces.
struct StageItem {
    /// Slot of its segment and storage index of its inboard joint, in global memory.
    std::int64_t slot = 0, joint = 0;
    std::int32_t next = 0;  // place of the force at its outboard joint
    bool given = false;     // true if a root or a later stage supplies its inboard force
};
/// Merge within a block, by places. The merged segment replaces the inboard one.
struct StageMerge {
    std::int32_t inboard = 0, outboard = 0;
    std::int32_t next = 0;  // place of the force at the outboard joint
    /// Number of handle directions that the eliminated joint constrains.
    std::int32_t restricted = 0;
    /// Storage index of the eliminated joint.
    std::int64_t joint = 0;
};
/// Root that a block closes.
struct StageRoot {
    std::int32_t place = 0, restricted = 0;  // `restricted`: as StageMerge, first joint
    Root root;
};
/// Segment or force that a block receives from another stage or passes to it.
struct StageTransfer {
    std::int32_t place = 0;
    std::int64_t at = 0;  // slot or storage index of the joint
};

/// Work of one launch of the inward pass and one of the outward pass. Inward, block b loads the
/// items of `item[b]` and does the merges of `merge[b * levels + l]`, level by level. It then
/// stores the segments of `up[b]` and closes the roots of `root[b]`. Outward, it loads the forces
/// of `down[b]` first. Blocks of one stage share no data; the merges of a block are consecutive.
struct Stage {
    int levels = 0;
    bool of_runs = false;  // true if items are the schedule's runs
    /// True for a last stage of one block without merges, which collects the segments that other
    /// ranks need.
    bool gathers = false;
    std::int64_t width = 0, forces = 0;  // largest numbers of places of a block
    std::vector<StageItem> items;
    std::vector<StageMerge> merges;
    std::vector<StageRoot> roots;
    std::vector<StageTransfer> segments_up, forces_down;
    std::vector<Range> item, merge, root, up, down;
    /// Number of blocks.
    std::int64_t blocks() const { return std::ssize(item); }
};

/// Ranges of one block; `merge` covers all levels.
struct StageBlock {
    Range item, merge, root, up, down;
};
/// Returns the ranges of every block.
std::vector<StageBlock> blocks_of(Stage const&);
/// Returns, for every block and level, the end of its merges, counted within the block.
std::vector<std::int32_t> level_ends_of(Stage const&);

/// Places in a stage of the segments and forces that it exchanges with the stage below.
struct PlacesAbove {
    /// Item of the upper stage for each of the lower stage's segments_up; -1: none.
    std::vector<std::int32_t> segment;
    /// Place in the upper stage of each of the lower stage's forces_down; -1: another stage has it.
    std::vector<std::int32_t> force;
    /// For each item of the upper stage: 1 if the lower stage produces it, 0 if an earlier one
    /// does.
    std::vector<std::uint8_t> comes_from_below;
};

/// Stages of a sweep.
struct StagePlan {
    std::vector<Stage> stages;  // order: from the leaves upwards
    /// True if a separate launch processes the runs before all stages, which then load the runs'
    /// segments from their slots. It is true if merges need segments of other trees besides, which
    /// in turn need the forces next to runs.
    bool runs_apart = false;
};

/// Limits of a device for the planning of stages.
struct StageSizes {
    std::int64_t threads = 0;  // threads per block
    std::int64_t most = 0;     // items per block, 2 or more
    /// Number of blocks that are resident together with one block of the stage above. One launch
    /// can execute both stages, inwards and outwards, if the lower one has no more blocks.
    std::int64_t together = 0;
    /// True if a separate launch processes the runs even if they are few.
    bool runs_apart = false;
    /// Number of merges that keep a block busy; 0: one per thread.
    std::int64_t at_once = 0;
};
/// Sizes of what a sweep keeps in a block, in doubles. `segment`: a segment with its bias terms, or
/// the record of an eliminated joint in the same place. `state`: what the outward pass knows at a
/// joint. `threads`: threads per block for which the registers suffice. `whole_runs`: one thread
/// processes a whole run. `at_once`: if several threads share a merge, the number of merges that
/// keep a block busy. `kept`: numbers per place that a stage keeps for its outward pass.
struct StageRecords {
    int segment = 0, state = 0, threads = 0;
    bool whole_runs = false;
    int at_once = 0, kept = 0;
};
/// Largest number of handle directions with which one thread merges alone, matrix and bias
/// together.
constexpr int most_directions_of_a_thread = 3;
/// Returns the sizes for mobilities along `directions` directions. `evaluates`: sweeps may compute
/// matrices and biases together.
constexpr StageRecords stage_records(int directions, bool evaluates, bool whole_runs = false) {
    int const segment = directions * (2 * directions + 3),
              node = directions * (5 * directions + 3) / 2;
    if (directions <= most_directions_of_a_thread) return {segment, directions, 256, whole_runs};
    if (!evaluates) return {segment, directions, 128, whole_runs};
    int const place = segment > node ? segment : node;
    return {place, directions, 128, whole_runs, 32, place};
}
/// Number of doubles for `count` consecutive records of `numbers` doubles in shared memory. The
/// padding keeps neighbouring records, and records a power of two apart, in different banks.
CATENA_HD constexpr std::int64_t packed_numbers(int numbers, std::int64_t count) {
    return (numbers | 1) * count + count / 16 + 1;
}
/// Number of doubles that a stage keeps for its outward pass; 0 if its items are runs, whose merges
/// are not shared by threads.
std::int64_t kept_numbers(Stage const&, StageRecords const&);
/// Returns the limits for a GPU with `shared_bytes` of shared memory per block and `at_once`
/// resident blocks.
StageSizes stage_sizes(StageRecords const&, std::int64_t shared_bytes, std::int64_t at_once);
/// Number of threads per block that a stage needs.
int threads_for(Stage const&, StageSizes const&);

/// Plans the stages of a sweep. With enough resident blocks, a sweep in both directions takes five
/// launches for any chain, and one for a small chain. `restricted`: number of constrained
/// directions of every joint.
StagePlan plan_stages(std::vector<Run> const& runs, std::vector<std::vector<Merge>> const& levels,
                      std::vector<Root> const& roots, std::int64_t slots,
                      std::span<std::uint8_t const> restricted, StageSizes const& sizes);

/// The last two stages of a plan if one launch can execute both, inwards and outwards; else empty.
struct StagesTogether {
    StagesTogether(StagePlan const&, StageSizes const&);
    explicit operator bool() const { return lower != nullptr; }
    Stage const *lower = nullptr, *upper = nullptr;  // stages of the plan
    PlacesAbove places;

    // Precondition of the following functions: the object is not empty. They return the numbers
    // exchanged between blocks in either direction, and the number of blocks.
    std::size_t numbers_up(StageRecords const& records) const {
        return static_cast<std::size_t>(upper->width * records.segment);
    }
    std::size_t numbers_down(StageRecords const& records) const {
        return static_cast<std::size_t>(upper->forces * records.state);
    }
    std::size_t blocks() const { return static_cast<std::size_t>(lower->blocks() + 1); }
};

/// Merge of a scan along chains, whose launches have stages like those of a sweep. The inward pass
/// combines the values of segments; the outward pass distributes to each segment the combined value
/// of all before it. The combined value replaces the inboard one; the inboard value replaces the
/// outboard one, because the outward pass needs it.
struct ScanMerge {
    std::int32_t inboard = 0, outboard = 0;  // places
};
/// Segment that is complete within its block; the value of all before it comes from another stage.
struct ScanTop {
    std::int32_t place = 0, slot = 0;
};
/// Ranges of one block.
struct ScanBlock {
    Range item, merge, top;
};
/// Work of one launch of a scan in each direction.
struct ScanStage {
    int levels = 0;
    bool of_runs = false;            // true if items are the schedule's runs
    std::int64_t width = 0;          // largest number of items of a block
    std::vector<std::int32_t> slot;  // slots of the items
    std::vector<ScanMerge> merges;
    std::vector<ScanTop> tops;
    std::vector<ScanBlock> blocks;
    std::vector<std::int32_t> level_end;  // see level_ends_of()
};
/// Largest number of items of a scan's block, which has one thread for each.
constexpr std::int64_t most_of_scan = 256;
/// Plans the stages of a scan with up to `most` items per block, a power of two. Precondition:
/// slots fit in 32 bits.
std::vector<ScanStage> plan_scan(std::vector<Run> const& runs,
                                 std::vector<std::vector<Merge>> const& levels,
                                 std::vector<Root> const& roots, std::int64_t slots,
                                 std::int64_t most);

/// Plan for a host in which one thread processes whole chains. Blocks share no data.
struct BlockPlan {
    int levels = 0;
    /// Ranges per block of its bodies, and of its chains' jointed tips.
    std::vector<Range> body, tip;
    /// Ranges per block of the schedule's runs and roots.
    std::vector<Range> run, root;
    /// Range of merges at merge[b * levels + l], counted over the lists of all levels one after the
    /// other.
    std::vector<Range> merge;
    /// Number of blocks.
    std::int64_t blocks() const { return std::ssize(body); }
};
/// Plans one block per chain. `tip`: last bodies of the chains with a jointed tip, ascending.
/// Precondition: no chain is shared with other ranks.
BlockPlan plan_blocks(Schedule const&, std::vector<std::int64_t> const& tip);

}  // namespace catena::dca
