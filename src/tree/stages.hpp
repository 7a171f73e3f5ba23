// How the runs, merges and roots of a tree are dealt out to blocks of threads: a block climbs
// several levels of its own subtrees before others need them, so that a sweep takes few launches.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "math/host_device.hpp"
#include "tree/tree.hpp"

namespace catena::dca {

struct Range {
    std::int64_t begin = 0, end = 0;
};

/// What a block starts from, a run or what another stage made. Item i has place i of the block's
/// segments, and its inboard joint place i of the block's forces.
struct StageItem {
    std::int64_t slot = 0, joint = 0;  // where its segment and its inboard joint are for everybody
    std::int32_t next = 0;             // place of the force after it
    bool given = false;                // its inboard joint's force comes from above
};
/// The joined segment takes the place of the inboard one.
struct StageMerge {
    std::int32_t inboard = 0, outboard = 0;
    std::int32_t next = 0;        // place of the force after it
    std::int32_t restricted = 0;  // directions of the joint
    std::int64_t joint = 0;
};
struct StageRoot {
    std::int32_t place = 0, restricted = 0;  // directions of its first joint
    Root root;
};
/// A segment or a force that comes from or goes to another stage.
struct StageTransfer {
    std::int32_t place = 0;
    std::int64_t at = 0;  // slot or joint
};

/// One launch upwards and one downwards. A block's merges stand together. Block b takes the items
/// of `item[b]`, does, level by level, the merges of `merge[b * levels + l]`, gives the segments of
/// `up[b]` away and closes `root[b]`; on its way back it is given the forces of `down[b]`. Between
/// blocks of a stage nothing is shared.
struct Stage {
    int levels = 0;
    bool of_runs = false;  // items are the schedule's runs
    bool gathers = false;  // the last one, of one block and no merges, which has what others have
                           // made for other ranks
    std::int64_t width = 0, forces = 0;  // most places of a block
    std::vector<StageItem> items;
    std::vector<StageMerge> merges;
    std::vector<StageRoot> roots;
    std::vector<StageTransfer> segments_up, forces_down;
    std::vector<Range> item, merge, root, up, down;
    std::int64_t blocks() const { return std::ssize(item); }
};

/// All ranges of a block, of `merges` those of all levels.
struct StageBlock {
    Range item, merge, root, up, down;
};
std::vector<StageBlock> blocks_of(Stage const&);
/// Of every block and level: where its merges end among the block's.
std::vector<std::int32_t> level_ends_of(Stage const&);

/// Where a stage has what the one below gives away and is given.
struct PlacesAbove {
    std::vector<std::int32_t> segment;  // of all segments_up: the item; -1: there is none
    std::vector<std::int32_t>
        force;  // of all forces_down: the force's place; -1: it comes from elsewhere
    std::vector<std::uint8_t> comes_from_below;  // of all items above: whether the stage below
                                                 // gives it, and not one before
};

struct StagePlan {
    std::vector<Stage> stages;  // from the leaves up
    bool runs_apart = false;    // runs come before all stages, which find them in their slots
};

struct StageSizes {
    std::int64_t threads = 0;   // of a block
    std::int64_t most = 0;      // items of a block, 2 or more
    std::int64_t together = 0;  // blocks that run at once beside one of the stage above: one launch
                                // takes all of them up and down
    bool runs_apart = false;    // also where they are few
    std::int64_t at_once = 0;   // merges that keep a block busy; 0: one for each of its threads
};
/// What a sweep keeps in a block: numbers of a segment with its biases, or of a joint's node in its
/// place, and of what is known at a joint on the way down; threads that find registers for merges;
/// whether a thread takes a whole run; where several threads share a merge, merges that keep a
/// block busy, and numbers of a place that a stage keeps for its way down.
struct StageRecords {
    int segment = 0, state = 0, threads = 0;
    bool whole_runs = false;
    int at_once = 0, kept = 0;
};
/// Directions of the handles that a thread merges alone, matrices and biases at once.
constexpr int most_directions_of_a_thread = 3;
/// Of mobilities along so many directions. `evaluates`: sweeps may take matrices and biases
/// together.
constexpr StageRecords stage_records(int directions, bool evaluates, bool whole_runs = false) {
    int const segment = directions * (2 * directions + 3),
              node = directions * (5 * directions + 3) / 2;
    if (directions <= most_directions_of_a_thread) return {segment, directions, 256, whole_runs};
    if (!evaluates) return {segment, directions, 128, whole_runs};
    int const place = segment > node ? segment : node;
    return {place, directions, 128, whole_runs, 32, place};
}
/// What `count` records of so many numbers take one after the other where neighbours, and those a
/// power of two apart, are not to meet in a bank of a GPU's shared memory.
CATENA_HD constexpr std::int64_t packed_numbers(int numbers, std::int64_t count) {
    return (numbers | 1) * count + count / 16 + 1;
}
/// That a stage keeps for its way down: none where its items are runs, which no threads share.
std::int64_t kept_numbers(Stage const&, StageRecords const&);
/// Of a GPU whose blocks may share so many bytes, and which runs so many blocks at once.
StageSizes stage_sizes(StageRecords const&, std::int64_t shared_bytes, std::int64_t at_once);
/// That a stage needs.
int threads_for(Stage const&, StageSizes const&);

/// With enough blocks together: five launches for a sweep up and down of any chain, one for a small
/// one. `restricted`: directions of every joint.
StagePlan plan_stages(std::vector<Run> const& runs, std::vector<std::vector<Merge>> const& levels,
                      std::vector<Root> const& roots, std::int64_t slots,
                      std::span<std::uint8_t const> restricted, StageSizes const& sizes);

/// The last two stages of a plan, where one launch takes both up and down again; else nothing.
struct StagesTogether {
    StagesTogether(StagePlan const&, StageSizes const&);
    explicit operator bool() const { return lower != nullptr; }
    Stage const *lower = nullptr, *upper = nullptr;  // of the plan
    PlacesAbove places;

    // Precondition of these: there are such stages. Numbers that go up and down between blocks, and
    // blocks.
    std::size_t numbers_up(StageRecords const& records) const {
        return static_cast<std::size_t>(upper->width * records.segment);
    }
    std::size_t numbers_down(StageRecords const& records) const {
        return static_cast<std::size_t>(upper->forces * records.state);
    }
    std::size_t blocks() const { return static_cast<std::size_t>(lower->blocks() + 1); }
};

/// A scan's launches, as a sweep's stages: values of segments join on the way up, what lies before
/// them is handed out on the way down. The joined value takes the inboard one's place, and that the
/// outboard one's, which needs it on the way down.
struct ScanMerge {
    std::int32_t inboard = 0, outboard = 0;  // places
};
/// What is complete in its block and has what lies before it from elsewhere.
struct ScanTop {
    std::int32_t place = 0, slot = 0;
};
struct ScanBlock {
    Range item, merge, top;
};
struct ScanStage {
    int levels = 0;
    bool of_runs = false;            // items are the schedule's runs
    std::int64_t width = 0;          // most items of a block
    std::vector<std::int32_t> slot;  // of items
    std::vector<ScanMerge> merges;
    std::vector<ScanTop> tops;
    std::vector<ScanBlock> blocks;
    std::vector<std::int32_t> level_end;  // as level_ends_of
};
/// Of a block, which has a thread for each.
constexpr std::int64_t most_of_scan = 256;
/// Up to `most` items to a block, a power of two. Precondition: slots find place in 32 bits.
std::vector<ScanStage> plan_scan(std::vector<Run> const& runs,
                                 std::vector<std::vector<Merge>> const& levels,
                                 std::vector<Root> const& roots, std::int64_t slots,
                                 std::int64_t most);

/// Chains that one thread of the host takes whole: nothing is shared.
struct BlockPlan {
    int levels = 0;
    std::vector<Range> body, tip;  // of every block: its bodies, and its chains' jointed tips
    std::vector<Range> run, root;  // of the schedule
    std::vector<Range> merge;  // merge[b * levels + l]: of all levels' merges, one after the other
    std::int64_t blocks() const { return std::ssize(body); }
};
/// A chain a block. `tip`: the last bodies of chains with a jointed tip. Precondition: no chain is
/// shared with other ranks.
BlockPlan plan_blocks(Schedule const&, std::vector<std::int64_t> const& tip);

}  // namespace catena::dca
