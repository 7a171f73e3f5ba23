// Implements the memory estimate by constructing solvers and dynamics over MemoryEstimator.
#include "cuda/space/memory.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cuda/space/memory_estimator.hpp"
#include "dca/leaf_choice.hpp"
#include "dca/solvers/branched_solver.hpp"
#include "dca/solvers/tree_solver.hpp"
#include "dca/space_levels.hpp"
#include "dynamics/bead_dynamics.hpp"
#include "dynamics/joint/joint_dynamics_in.hpp"
#include "dynamics/rigid/rigid_dynamics.hpp"
#include "math/with_number.hpp"

namespace catena::cuda {
namespace {

using namespace dca;

static_assert(SolverSpace<MemoryEstimator>);

/// Calls use(Of<Leaf>) with one leaf type per number of directions. For floating runs the tree's
/// memory depends on the number of directions only, so that one leaf type represents all.
template <class Use>
auto with_directions(ChainGroup const& group, Use const& use) {
    if (group.directions == 1) return use(Of<BeadLeaf<1>>{});
    return with_number<2, 6>(group.directions, [&](auto directions) {
        constexpr int K = decltype(directions)::value;
        return use(Of<BodyLeaf<K, JointFrameHandles<K, false>>>{});
    });
}

/// Calls use(Of<Leaf>) with a leaf type that needs the same memory as the group's.
template <class Use>
auto with_leaf(ChainGroup const& group, Use const& use) {
    return group.handles == Handles::articulated ? use(Of<ArticulatedLeaf<false>>{})
                                                 : with_directions(group, use);
}

/// Makes the tree solver of the group over MemoryEstimator.
std::unique_ptr<ChainSolver> tree_of(ChainGroup const& group, MemoryEstimator const& space,
                                     Communicator const& communicator) {
    auto const make = [&](auto leaf) -> std::unique_ptr<ChainSolver> {
        return std::make_unique<TreeSolver<typename decltype(leaf)::type, MemoryEstimator>>(
            group, space, communicator);
    };
    return with_leaf(group, make);
}

/// Counts the memory of the tree's lowest levels and of the items that cross the cut between GPU
/// and host. At most these are the bodies' segments, forces and joints.
void count_levels(ChainGroup const& group, Scene const& scene) {
    GpuLevels const levels = scene.solver.levels_on_gpu();
    Schedule const& s = group.schedule;
    auto const within = [&](int l) {
        return std::min(static_cast<std::size_t>(l), s.levels.size());
    };
    LevelCut const cut = cut_levels(s, levels);
    with_leaf(group, [&](auto leaf) {
        using Leaf = typename decltype(leaf)::type;
        using Sweeps = typename SweepsOf<Leaf>::Sweeps;
        using Part = SpaceLevels<Leaf, MemoryEstimator, CountingCrossing>;
        LevelWork const work{
            levels.up > 0, levels.down > 0, 0, within(levels.up), 0, within(levels.down), false};
        Part part(group, work, MemoryEstimator());
        for (auto const* places : {&cut.segments, &cut.forces, &cut.joints_up, &cut.joints_down})
            part.choose(*places);
        std::size_t const items = std::max(cut.segments.size() * sizeof(typename Sweeps::Matrices),
                                           std::max(cut.joints_up.size(), cut.joints_down.size()) *
                                               sizeof(typename Sweeps::Joint));
        Count::add(static_cast<std::int64_t>(items));
    });
}

/// Counts the memory of the group's solver and dynamics.
void count_group(ChainGroup const& group, Scene const& scene, Backend backend,
                 Communicator const& communicator) {
    if (backend == Backend::cuda_levels) return count_levels(group, scene);
    if (group.is_branched()) {
        BeadDynamics<MemoryEstimator, BranchedFields>(
            group, scene, MemoryEstimator(), communicator,
            std::make_unique<BranchedSolver<MemoryEstimator>>(group, MemoryEstimator(),
                                                              communicator));
        return;
    }
    if (group.axes != Axes::joint && group.directions == 1 && group.schedule.shared.empty())
        MemoryEstimator::Blocks{group};  // allocated at the first step, if blocks are used
    MemoryEstimator const space;         // Shares the model between solver and dynamics.
    if (group.beads) {
        BeadDynamics<MemoryEstimator>(group, scene, space, communicator,
                                      tree_of(group, space, communicator));
    } else if (!group.linked && group.axes == Axes::joint) {
        JointDynamicsIn<MemoryEstimator>(group, scene, space, communicator,
                                         tree_of(group, space, communicator));
    } else {
        RigidDynamics<MemoryEstimator>(group, scene, space, communicator,
                                       tree_of(group, space, communicator));
    }
}

}  // namespace

DeviceMemory& DeviceMemory::operator+=(DeviceMemory const& other) {
    bytes += other.bytes;
    transient = std::max(transient, other.transient);
    allocations += other.allocations;
    return *this;
}

DeviceMemory memory_needed(ChainGroup const& group, Scene const& scene, Backend backend,
                           Communicator const& communicator) {
    Count const count;
    count_group(group, scene, backend, communicator);
    return count.sum();
}

std::string too_little_memory(std::int64_t needed, std::int64_t free) {
    if (needed <= free) return {};
    double constexpr gib = 1 << 30;
    return fmt::format("{:.3g} GiB of GPU memory are needed and {:.3g} GiB are free",
                       static_cast<double>(needed) / gib, static_cast<double>(free) / gib);
}

}  // namespace catena::cuda
