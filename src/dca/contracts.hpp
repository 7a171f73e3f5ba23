// What the solver's templates require of their arguments, as concepts: leaves, sweeps and Spaces.
// contracts.cpp, cuda/space/memory.cpp and cuda/space/contracts.cu assert them for the types there;
// TreeSolver takes no others.
#pragma once

#include <concepts>
#include <cstdint>
#include <vector>

#include "dca/host_space.hpp"
#include "dca/tree_sweeps.hpp"

namespace catena::dca {

/// A sweep with an inward pass (tree_sweeps.hpp): it reads bodies, makes the segments of parts,
/// joins segments and closes chains.
template <class Sweep>
concept InwardSweep = requires(Sweep const& sweep, typename Sweep::Segment const& segment,
                               typename Sweep::Part const& part, Run const& run, Root const& root,
                               JointAt const& at, std::int64_t k) {
    requires std::same_as<decltype(Sweep::descends), bool const>;
    requires std::same_as<decltype(Sweep::keeps_nodes), bool const>;
    requires std::same_as<decltype(Sweep::supports_short_chains), bool const>;
    { sweep.s.at(k) } -> std::same_as<JointAt>;
    { sweep.read(k, k) } -> std::same_as<typename Sweep::Part>;
    { sweep.part(run, 0, part) } -> std::same_as<typename Sweep::Segment>;
    { sweep.joined(segment, segment, at) } -> std::same_as<typename Sweep::Segment>;
    { sweep.load(k) } -> std::same_as<typename Sweep::Segment>;
    sweep.store(k, segment);
    sweep.close(root, segment);
};

/// An inward sweep with an outward pass: from the states at the two ends of a run, it finds those
/// of the joints within.
template <class Sweep>
concept OutwardSweep =
    InwardSweep<Sweep> && Sweep::descends &&
    requires(Sweep const& sweep, typename Sweep::Part const& part, typename Sweep::Node const& node,
             typename Sweep::Sweeps::State const& state, Run const& run, std::int64_t k) {
        requires Sweep::ShownNumbers::width > 0;
        { sweep.node(k) } -> std::same_as<typename Sweep::Node>;
        { sweep.force(node, state, state) } -> std::same_as<typename Sweep::Sweeps::State>;
        sweep.template down<true>(run, 0, part, state, state);
    };

/// A sweep that computes some runs as a whole.
template <class Sweep>
concept WholeRunSweep =
    OutwardSweep<Sweep> && takes_whole_runs<Sweep> &&
    requires(Sweep const& sweep, Run const& run, typename Sweep::Directions const& force) {
        { sweep.whole(run).is_on_revolutes() } -> std::same_as<bool>;
        { sweep.whole(run).climb() } -> std::same_as<typename Sweep::Segment>;
        sweep.whole(run).descend(force, force);
    };

/// A kind of body as the tree sees it: it has K directions per handle, is made from a group's
/// arrays, reads a configuration, and has a matrix sweep and a bias sweep (SweepsOf).
template <class Leaf>
concept TreeLeaf =
    std::constructible_from<Leaf, GroupView const&> && Leaf::K >= 1 && Leaf::K <= 6 &&
    requires(Leaf& leaf, Leaf const& seen, ConfigurationView const& configuration) {
        requires std::same_as<decltype(Leaf::beads), bool const>;
        requires std::same_as<decltype(Leaf::in_joints), bool const>;
        requires std::same_as<decltype(Leaf::projected), bool const>;
        leaf.set(configuration);
        { seen.group() } -> std::same_as<GroupView const&>;
    } && InwardSweep<typename SweepsOf<Leaf>::OfMatrices> &&
    OutwardSweep<typename SweepsOf<Leaf>::OfBiases>;

/// A leaf with floating handles: a body's matrix and bias need no other body's, and its
/// accelerations follow from the forces at its two joints.
template <class Leaf>
concept FloatingLeaf = TreeLeaf<Leaf> && requires(Leaf const& leaf, LoadsView const& loads,
                                                  Vector<double, Leaf::K> const& force,
                                                  AccelerationsView const& out, std::int64_t k) {
    { leaf.matrix(k) } -> std::same_as<SegmentMatrix<double, Leaf::K>>;
    { leaf.bias(loads, k) } -> std::same_as<SegmentBias<double, Leaf::K>>;
    leaf.accelerate(loads, k, force, force, out);
};

/// Work of a loop over items in checks of Spaces: none.
struct NoWork {
    CATENA_HD void operator()(std::int64_t) const {}
};
/// A value of each item in checks of Spaces.
struct NoValue {
    CATENA_HD double operator()(std::int64_t) const { return 0; }
};

/// Memory and loops (HostSpace specifies them): arrays, fields, the group's model, records and
/// trees in the Space's memory; loops, both passes of a sweep, and copies from and to the host.
template <class Space>
concept SolverSpace =
    std::copyable<Space> &&
    requires {
        typename Space::template Array<double>;
        typename Space::template HostArray<double>;
        typename Space::template List<std::int64_t>;
        typename Space::template FieldOf<3>;
        typename Space::template Fixed<3>;
        typename Space::template Mirror<3>;
        typename Space::template Records<SegmentMatrix<double, 1>, Order::plain>;
        typename Space::Directions;
        typename Space::Blocks;
        typename Space::Tree;
        typename Space::ScanTree;
        requires std::constructible_from<typename Space::Model, ChainGroup const&>;
        requires std::constructible_from<typename Space::template Fixed<3>, Field<3> const&>;
        requires std::constructible_from<typename Space::Directions, std::int64_t, int>;
        requires std::same_as<decltype(Space::answers_at_once), bool const>;
        { Space::template has_blocks<1> } -> std::convertible_to<bool>;
        { Space::template has_teams<1> } -> std::convertible_to<bool>;
    } &&
    requires(Space const& space, typename Space::Model const& model, ChainGroup const& group,
             typename Space::Tree const& tree, BiasSweep<BeadLeaf<1>> const& sweep,
             typename Space::template FieldOf<3>& field, typename Space::template Mirror<3>& mirror,
             double* number, std::int64_t count) {
        { model.view() } -> std::convertible_to<GroupView>;
        { model.restricted() } -> std::same_as<std::uint8_t const*>;
        { model.mass() } -> std::same_as<ConstView<1>>;
        { model.inertia() } -> std::same_as<ConstView<6>>;
        { space.model(group) } -> std::same_as<typename Space::Model>;
        space.for_each(count, NoWork{});
        { space.largest(count, NoValue{}) } -> std::same_as<double>;
        space.climb(tree, sweep);
        space.descend(tree, sweep);
        space.climb_and_descend(tree, sweep);
        { space.pays_by_blocks(group) } -> std::same_as<bool>;
        { space.has_threads_to_spare(count) } -> std::same_as<bool>;
        { space.get(number) } -> std::same_as<double>;
        space.put(number, 1.0);
        { space.pull(field, mirror) } -> std::same_as<View<3>>;
        space.push(field, mirror);
        { space.on_host() } -> std::same_as<Executor const&>;
        { space.threads() } -> std::same_as<int>;
        { space.time_chained(1, 1, false, NoWork{}) } -> std::same_as<std::vector<double>>;
        space.wait();
    };

}  // namespace catena::dca
