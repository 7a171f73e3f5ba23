// One item of every sweep over the canonical tree, host and device: a run, a merge, a root. Who calls them for which items is the
// driver's business (tree_solver.hpp).
#pragma once

#include "dca/leaves.hpp"
#include "dca/tree.hpp"

namespace catena::dca {

template <class Leaf_>
struct TreeSweeps {
    using Leaf = Leaf_;
    static constexpr int K = Leaf::K;
    using Matrices = SegmentMatrix<double, K>;
    using Biases = SegmentBias<double, K>;
    using Joint = JointMatrix<double, K>;
    using Directions = Vector<double, K>;

    Leaf leaf;
    std::uint8_t const* restricted = nullptr;  // of every joint (ChainGroup::restricted_of_joint)
    Matrices* matrices = nullptr;              // by slot
    Biases* biases = nullptr;
    Joint* joints = nullptr;  // by joint
    Directions* offsets = nullptr;
    Directions* forces = nullptr;

    static std::int64_t bytes(Schedule const& schedule) {
        return schedule.slots * static_cast<std::int64_t>(sizeof(Matrices) + sizeof(Biases)) +
               schedule.joints * static_cast<std::int64_t>(sizeof(Joint) + 2 * sizeof(Directions));
    }

    CATENA_HD void assemble_matrices(Run const& run) const {
        Matrices segment = leaf.matrix(run.body);
        for (std::int64_t k = run.body + 1; k < run.body + run.count; ++k)
            segment = assemble(segment, leaf.matrix(k), restricted[k], joints[k]);
        matrices[run.slot] = segment;
    }
    CATENA_HD void assemble_matrices(Merge const& m) const {
        matrices[m.slot] = assemble(matrices[m.inboard], matrices[m.outboard], restricted[m.joint], joints[m.joint]);
    }
    CATENA_HD void close_matrices(Root const& root) const {
        Matrices segment = matrices[root.slot];
        if (root.jointed_tip) segment = assemble(segment, Matrices::zero(), restricted[root.next], joints[root.next]);
        joints[root.first].factor = factorize(segment.z11, restricted[root.first]);
        if (root.jointed_tip) refuse_redundant(root);
    }

    CATENA_HD void assemble_biases(LoadsView const& loads, Run const& run) const {
        Biases segment = leaf.bias(loads, run.body);
        for (std::int64_t k = run.body + 1; k < run.body + run.count; ++k)
            segment = assemble(segment, leaf.bias(loads, k), joints[k], offsets[k]);
        biases[run.slot] = segment;
    }
    CATENA_HD void assemble_biases(LoadsView const&, Merge const& m) const {
        biases[m.slot] = assemble(biases[m.inboard], biases[m.outboard], joints[m.joint], offsets[m.joint]);
    }
    /// Ground is a segment with zeta = 0: its acceleration stands in the biases of the joints to it.
    CATENA_HD void close_biases(Root const& root) const {
        Biases segment = biases[root.slot];
        if (root.jointed_tip) segment = assemble(segment, Biases::zero(), joints[root.next], offsets[root.next]);
        forces[root.first] = solve_upper(joints[root.first].factor, solve_lower(joints[root.first].factor, -segment.b1));
        if (root.jointed_tip)
            forces[root.next] = disassemble(joints[root.next], offsets[root.next], forces[root.first], Directions::zero());
    }

    /// Whether the matrix of joint k is positive definite, as its pivots say.
    CATENA_HD bool definite(std::int64_t k) const {
        for (int i = 0; i < restricted[k]; ++i)
            if (double const p = joints[k].factor(i, i); !(p > 0) || p - p != 0) return false;
        return true;
    }

    CATENA_HD void disassemble_forces(Merge const& m) const {
        forces[m.joint] = disassemble(joints[m.joint], offsets[m.joint], forces[m.first], forces[m.next]);
    }
    CATENA_HD void disassemble_forces(LoadsView const& loads, AccelerationsView const& out, Run const& run) const {
        Directions const first = forces[run.body];
        Directions next = forces[run.next];
        for (std::int64_t k = run.body + run.count - 1; k >= run.body; --k) {
            Directions const force = k == run.body ? first : disassemble(joints[k], offsets[k], first, next);
            leaf.accelerate(loads, k, force, next, out);
            if (out.joint_force) out.joint_force.template store<K>(k, force);
            if (out.tip_force && leaf.group().has_jointed_tip(k)) out.tip_force.template store<K>(k, next);
            next = force;
        }
    }

  private:
    /// Where base and tip hold a chain more than once nothing but rounding is left of a pivot: it is made to fail. What was there before:
    /// the chain as it floats.
    CATENA_HD void refuse_redundant(Root const& root) const {
        mark_lost(joints[root.next].factor, matrices[root.slot].z22, restricted[root.next]);
        mark_lost(joints[root.first].factor, matrices[root.slot].z11, restricted[root.first]);
    }
    CATENA_HD static void mark_lost(Symmetric<double, K>& factor, Symmetric<double, K> const& floating, int restricted) {
        double constexpr lost = 0x1p-33;  // fewer than six digits would be left
        for (int i = 0; i < restricted; ++i)
            if (1 / factor(i, i) < lost * floating(i, i)) factor(i, i) = __builtin_nan("");
    }
};

}  // namespace catena::dca
