// Runs of bodies side by side, one in each lane of a vector, and merges of the tree above them:
// what the sources of the instruction sets offer. These sources must not share a function with the
// rest of the program, or the linker may keep the one that not every processor runs: nothing of the
// standard library but placement new passes this door, and all behind it is a template over their
// own vectors.
#pragma once

#include "dca/tree_sweeps.hpp"
#include "math/simd_level.hpp"

namespace catena::dca {

inline constexpr int most_lanes = 8;

/// Runs, one a lane, of `longest_run` columns; in the lanes that are left over the first one again.
/// A shorter one has the last columns: before its first body's own that body stands again, and what
/// comes of these is left out.
struct RunsInLanes {
    std::int64_t body[most_lanes], slot[most_lanes], next[most_lanes];
    std::int64_t
        column[most_lanes];   // where column 0 would be: that of the first body, less skipped
    int skipped[most_lanes];  // columns, longest_run - part_length at most
    std::uint8_t
        begins[longest_run];  // bit j: lane j's run begins in this column; in column 0 all do
    std::uint8_t late;        // bit j: lane j's is a shorter one
};
/// Part p of them: a lane's columns are of bodies first[j] on, its first skipped[j] ones aside,
/// where first[j] stands again.
template <class Real>
struct PartInLanes {
    static constexpr int lanes = Real::lanes;
    std::int64_t first[lanes];
    int skipped[lanes];
    bool short_ones;

    PartInLanes(RunsInLanes const& runs, int p) : short_ones(false) {
        for (int j = 0; j < lanes; ++j) first[j] = runs.column[j] + p * part_length;
        if (runs.late == 0) return;
        for (int j = 0; j < lanes; ++j) {
            int const before = runs.skipped[j] - p * part_length;
            skipped[j] = before < 0 ? 0 : before < part_length ? before : part_length;
            if (skipped[j] == 0) continue;
            first[j] = runs.body[j];
            short_ones = true;
        }
    }
};

/// action(view) for all of a group that bodies side by side do not turn over again in every sweep.
/// A bead has too little of it.
template <class Leaf, class Action>
constexpr void each_constant(GroupView& group, Action const& action) {
    if constexpr (!Leaf::beads) {
        if constexpr (Leaf::by_inertia) {
            action(group.mass);
            action(group.inertia);
        } else {
            action(group.inverse_mass);
            action(group.inverse_inertia);
        }
        action(group.r1);
        action(group.r2);
        if constexpr (Leaf::Frames::in_joints) {
            action(group.axes1);
            action(group.axes2);
        }
    }
}
template <class Leaf>
consteval int count_constants() {
    GroupView group;
    int count = 0;
    each_constant<Leaf>(group, [&count]<int D>(ConstView<D> const&) { count += D; });
    return count;
}
/// Of its inboard joint's frame against the body before, where bodies go by their revolute joints.
template <class Leaf>
inline constexpr int frame_constants = Leaf::by_inertia ? 4 : 0;
/// Numbers a body.
template <class Leaf>
inline constexpr int constants_of = count_constants<Leaf>() + frame_constants<Leaf>;

template <class Leaf>
struct RunWork {
    TreeSweeps<Leaf> sweeps;
    GroupView group;
    ConfigurationView configuration;
    LoadsView loads;
    AccelerationsView out;
    RunsInLanes const* runs = nullptr;
    double const* constants = nullptr;  // [part of an item of `runs`][number][body][lane]
    double* nodes = nullptr;  // kept_of_run_of<Leaf> vectors for every item, from climb to descend
    bool keeps_all = false;   // of every body too, or joints between parts alone, the others being
                              // eliminated again
    bool asks_ahead = false;  // as asks_ahead()
};
/// Vectors of a joint between segments, and of what a body passes on to the way down.
template <int K>
inline constexpr int node_numbers =
    static_cast<int>((sizeof(JointMatrix<double, K>) + sizeof(Vector<double, K>)) / sizeof(double));
template <int K>
inline constexpr int passed_numbers =
    static_cast<int>(sizeof(OneSided<double, K>) / sizeof(double));
template <int K>
constexpr int kept_of_run(bool keeps_all) {
    return (parts_of_run - 1) * node_numbers<K> +
           (keeps_all ? static_cast<int>(longest_run) * passed_numbers<K> : 0);
}

/// Of a run that goes by its inertias: its revolute joints with the bodies outboard of them, of
/// which the way back wants some angular velocities; and its end, with the last revolute joint's
/// axes and the last body's orientation.
inline constexpr int released_numbers =
    static_cast<int>(sizeof(ReleasedRevolute<double>) / sizeof(double));
inline constexpr int passed_body_numbers =
    static_cast<int>(sizeof(BodyInRun<double>) / sizeof(double));
inline constexpr int revolute_numbers = released_numbers + passed_body_numbers + 3 + 6;
inline constexpr int met_numbers = static_cast<int>(sizeof(RunsEnd<double>) / sizeof(double));
inline constexpr int end_numbers = met_numbers + 9 + 9;
inline constexpr int kept_of_revolute_run =
    (static_cast<int>(longest_run) - 1) * revolute_numbers + end_numbers;
template <class Leaf>
constexpr int kept_of_run_of(bool keeps_all) {
    return Leaf::by_inertia ? kept_of_revolute_run : kept_of_run<Leaf::K>(keeps_all);
}

/// Merges of one level of the tree.
struct MergesInLanes {
    std::int64_t inboard[most_lanes], outboard[most_lanes], slot[most_lanes];
    std::int64_t first[most_lanes], joint[most_lanes], next[most_lanes];
};
template <class Leaf>
struct MergeWork {
    TreeSweeps<Leaf> const& sweeps;
    MergesInLanes const* merges;
    double* nodes;  // node_numbers<K> vectors an item, from climb to descend
    bool asks_ahead;
};

/// For items [begin, end) of RunWork::runs. climb: from the bodies to the runs' slots, matrices and
/// biases at once; descend: from the forces at the runs' ends to the bodies' accelerations.
/// climb_merges, descend_merges: the same of MergeWork::merges.
template <class Leaf>
struct RunKernels {
    void (*climb)(RunWork<Leaf> const&, std::int64_t begin, std::int64_t end);
    void (*descend)(RunWork<Leaf> const&, std::int64_t begin, std::int64_t end);
    void (*climb_merges)(MergeWork<Leaf> const&, std::int64_t begin, std::int64_t end);
    void (*descend_merges)(MergeWork<Leaf> const&, std::int64_t begin, std::int64_t end);
};

/// Precondition: simd_levels() has them.
template <class Leaf>
RunKernels<Leaf> avx2_kernels();
template <class Leaf>
RunKernels<Leaf> avx512_kernels();

/// Whether runs of these leaves go side by side: those with handles projected on the joints'
/// directions.
template <class Leaf>
inline constexpr bool goes_side_by_side = Leaf::projected;

/// instantiate(Leaf) for each of them.
// clang-format off
#define CATENA_LEAVES_IN_LANES(instantiate)           \
    instantiate(BeadLeaf<1>)                          \
    instantiate(BodyLeaf<1, LinkFrames<1>>)           \
    instantiate(BodyLeaf<3, GroundFrames<3>>)         \
    instantiate(BodyLeaf<2, JointFrameHandles<2, false>>) \
    instantiate(BodyLeaf<3, JointFrameHandles<3, false>>) \
    instantiate(BodyLeaf<4, JointFrameHandles<4, false>>) \
    instantiate(BodyLeaf<5, JointFrameHandles<5, false>>) \
    instantiate(BodyLeaf<5, JointFrameHandles<5, true>>)
// clang-format on

}  // namespace catena::dca
