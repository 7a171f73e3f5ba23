// Interface of the kernels that process runs of bodies side by side, one in each lane of a vector,
// and the merges of the tree above them.
//
// The sources of the instruction sets must not share a function with the rest of the program: the
// linker might keep the version that not every processor can execute. They therefore use nothing of
// the standard library but placement new, and all their code is templates over their own vector
// types.
#pragma once

#include "dca/tree_sweeps.hpp"
#include "math/simd_level.hpp"

namespace catena::dca {

inline constexpr int most_lanes = 8;

/// Runs in the lanes of a vector, each with `longest_run` columns. Free lanes repeat the first run.
/// A shorter run occupies the last columns. Columns before its first body repeat that body, and
/// their results are discarded.
struct RunsInLanes {
    std::int64_t body[most_lanes], slot[most_lanes], next[most_lanes];
    /// Body that column 0 corresponds to: the first body minus the skipped columns.
    std::int64_t column[most_lanes];
    int skipped[most_lanes];  // Number of skipped columns, longest_run - part_length at most.
    /// Bit j: the run in lane j begins in this column; set for all lanes in column 0.
    std::uint8_t begins[longest_run];
    std::uint8_t late;  // Bit j: the run in lane j is a shorter one.
};
/// Part p of runs in lanes. The columns of lane j start with body first[j]; its first skipped[j]
/// columns repeat that body.
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

/// Calls action(view) for all constants of a group that sweeps side by side read in lane order,
/// without transposing them again. Beads have too few constants for that.
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
/// Returns the number of doubles per body that each_constant() visits.
template <class Leaf>
consteval int count_constants() {
    GroupView group;
    int count = 0;
    each_constant<Leaf>(group, [&count]<int D>(ConstView<D> const&) { count += D; });
    return count;
}
/// Number of doubles per body for the inboard joint's frame in the axes of the body before, for
/// leaves that are computed by articulated-body inertias.
template <class Leaf>
inline constexpr int frame_constants = Leaf::by_inertia ? 4 : 0;
/// Number of doubles per body in RunWork::constants.
template <class Leaf>
inline constexpr int constants_of = count_constants<Leaf>() + frame_constants<Leaf>;

/// Arguments of the kernels for runs.
template <class Leaf>
struct RunWork {
    TreeSweeps<Leaf> sweeps;
    GroupView group;
    ConfigurationView configuration;
    LoadsView loads;
    AccelerationsView out;
    RunsInLanes const* runs = nullptr;
    /// Array [part of an item of `runs`][number][body][lane] of each_constant() and joint frames.
    double const* constants = nullptr;
    /// Storage of kept_of_run_of<Leaf> vectors per item between inward and outward pass.
    double* nodes = nullptr;
    /// True if `nodes` has the data of all bodies. Otherwise it has only the joints between parts,
    /// and the outward pass eliminates the others again.
    bool keeps_all = false;
    bool prefetches = false;  // True if the kernels prefetch, see prefetches().
};
/// Number of vectors for a joint between segments.
template <int K>
inline constexpr int node_numbers =
    static_cast<int>((sizeof(JointMatrix<double, K>) + sizeof(Vector<double, K>)) / sizeof(double));
/// Number of vectors that the outward pass needs for a body.
template <int K>
inline constexpr int passed_numbers =
    static_cast<int>(sizeof(OneSided<double, K>) / sizeof(double));
/// Number of vectors for a run that is joined body by body.
template <int K>
constexpr int kept_of_run(bool keeps_all) {
    return (parts_of_run - 1) * node_numbers<K> +
           (keeps_all ? static_cast<int>(longest_run) * passed_numbers<K> : 0);
}

/// Numbers of vectors for a run computed by articulated-body inertias. `revolute_numbers` belongs
/// to a joint with the body outboard of it, with its angular velocity and its velocity bias.
/// `end_numbers` belongs to the run's end, with the last revolute joint's axes and the last body's
/// orientation.
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

/// Merges of one level of the tree in the lanes of a vector.
struct MergesInLanes {
    std::int64_t inboard[most_lanes], outboard[most_lanes], slot[most_lanes];
    std::int64_t first[most_lanes], joint[most_lanes], next[most_lanes];
};
/// Arguments of the kernels for merges.
template <class Leaf>
struct MergeWork {
    TreeSweeps<Leaf> const& sweeps;
    MergesInLanes const* merges;
    double* nodes;  // Storage of node_numbers<K> vectors per item between inward and outward pass.
    bool prefetches;
};

/// Kernels of one vector type for the items [begin, end) of RunWork::runs and MergeWork::merges.
///
/// `climb` computes matrices and biases, from the bodies to the runs' slots. `descend` computes the
/// bodies' accelerations from the forces at the runs' ends. `climb_merges` and `descend_merges` are
/// the same passes over merges.
template <class Leaf>
struct RunKernels {
    void (*climb)(RunWork<Leaf> const&, std::int64_t begin, std::int64_t end);
    void (*descend)(RunWork<Leaf> const&, std::int64_t begin, std::int64_t end);
    void (*climb_merges)(MergeWork<Leaf> const&, std::int64_t begin, std::int64_t end);
    void (*descend_merges)(MergeWork<Leaf> const&, std::int64_t begin, std::int64_t end);
};

/// Returns the kernels of an instruction set. Precondition: simd_levels() contains it.
template <class Leaf>
RunKernels<Leaf> avx2_kernels();
template <class Leaf>
RunKernels<Leaf> avx512_kernels();

/// True if runs of this leaf can be processed side by side: its handles are projected on the
/// joints' directions.
template <class Leaf>
inline constexpr bool goes_side_by_side = Leaf::projected;

/// Call instantiate(Leaf) for each leaf whose runs can be processed side by side: with up to four
/// directions, with five directions, and all. Both lists take equally long to compile.
// clang-format off
#define CATENA_LEAVES_OF_FEW_DIRECTIONS(instantiate)      \
    instantiate(BeadLeaf<1>)                              \
    instantiate(BodyLeaf<1, LinkFrames<1>>)               \
    instantiate(BodyLeaf<3, GroundFrames<3>>)             \
    instantiate(BodyLeaf<2, JointFrameHandles<2, false>>) \
    instantiate(BodyLeaf<3, JointFrameHandles<3, false>>) \
    instantiate(BodyLeaf<4, JointFrameHandles<4, false>>)
#define CATENA_LEAVES_OF_FIVE_DIRECTIONS(instantiate)     \
    instantiate(BodyLeaf<5, JointFrameHandles<5, false>>) \
    instantiate(BodyLeaf<5, JointFrameHandles<5, true>>)
#define CATENA_LEAVES_IN_LANES(instantiate)      \
    CATENA_LEAVES_OF_FEW_DIRECTIONS(instantiate) \
    CATENA_LEAVES_OF_FIVE_DIRECTIONS(instantiate)
// clang-format on

}  // namespace catena::dca
