// The driver: which segment meets which, and when ranks speak. All mathematics is in segment.hpp and leaf.hpp.
#pragma once

#include <chrono>
#include <cmath>
#include <limits>
#include <vector>

#include "dca/leaves.hpp"
#include "error.hpp"

namespace catena::dca {

template <class Leaf>
class TreeSolver final : public ChainSolver {
    static constexpr int K = Leaf::K;
    using Matrices = SegmentMatrix<double, K>;
    using Biases = SegmentBias<double, K>;

  public:
    TreeSolver(ChainGroup const& group, Executor const& executor, Communicator const& communicator)
        : group_(group), schedule_(group.schedule), executor_(executor), communicator_(communicator), leaf_(group) {
        matrices_.resize(static_cast<std::size_t>(schedule_.slots));
        biases_.resize(matrices_.size());
        joints_.resize(static_cast<std::size_t>(schedule_.joints));
        offsets_.resize(joints_.size());
        forces_.resize(joints_.size(), Vector<double, K>::zero());
    }

    void assemble_matrices(ConfigurationView const& configuration) override {
        auto const start = now();
        leaf_.set(configuration);
        executor_.for_each(count(schedule_.runs), [this](std::int64_t i) { assemble_run(schedule_.runs[i]); });
        for (auto const& level : schedule_.levels) assemble_level(level);
        if (!schedule_.shared.empty()) gather_shared(matrices_);
        for (auto const& level : schedule_.top_levels) assemble_level(level);
        for_roots([this](Root const& root) {
            Matrices segment = matrices_[root.slot];
            if (root.jointed_tip) segment = assemble(segment, Matrices::zero(), restricted(root.next), joints_[root.next]);
            joints_[root.first].factor = factorize(segment.z11, restricted(root.first));
            if (root.jointed_tip) refuse_redundant(root);
        });
        ++report_.matrix_sweeps;
        report_.matrix_seconds += now() - start;
        check_definite();
    }

    void solve(LoadsView const& loads, AccelerationsView const& out) override {
        auto const start = now();
        executor_.for_each(count(schedule_.runs), [&](std::int64_t i) { assemble_run_bias(schedule_.runs[i], loads); });
        for (auto const& level : schedule_.levels) assemble_level_bias(level);
        if (!schedule_.shared.empty()) gather_shared(biases_);
        for (auto const& level : schedule_.top_levels) assemble_level_bias(level);
        for_roots([this](Root const& root) {
            // Ground is a segment with zeta = 0: its acceleration stands in the biases of the joints to it.
            Biases segment = biases_[root.slot];
            if (root.jointed_tip) segment = assemble(segment, Biases::zero(), joints_[root.next], offsets_[root.next]);
            forces_[root.first] = solve_upper(joints_[root.first].factor, solve_lower(joints_[root.first].factor, -segment.b1));
            if (root.jointed_tip)
                forces_[root.next] = disassemble(joints_[root.next], offsets_[root.next], forces_[root.first], Vector<double, K>::zero());
        });
        for (std::size_t l = schedule_.top_levels.size(); l-- > 0;) disassemble_level(schedule_.top_levels[l]);
        for (TopCopy const& copy : schedule_.top_copies) forces_[copy.to] = forces_[copy.from];
        for (std::size_t l = schedule_.levels.size(); l-- > 0;) disassemble_level(schedule_.levels[l]);
        executor_.for_each(count(schedule_.runs), [&](std::int64_t i) { disassemble_run(schedule_.runs[i], loads, out); });
        if (out.joint_force) out.joint_force.store(schedule_.bodies, forces_[schedule_.halo]);
        ++report_.bias_sweeps;
        report_.bias_seconds += now() - start;
    }

    SolverReport report() const override {
        SolverReport r = report_;
        r.directions = K;
        r.threads = executor_.threads();
        r.ranks = communicator_.size();
        for (ChainTree const& tree : group_.partition.trees) {
            r.run_length = std::max(r.run_length, tree.run_length);
            r.depth = std::max(r.depth, tree.depth());
        }
        r.memory_bytes = static_cast<std::int64_t>(matrices_.size() * (sizeof(Matrices) + sizeof(Biases)) +
                                                   joints_.size() * (sizeof(JointMatrix<double, K>) + 2 * sizeof(Vector<double, K>)));
        return r;
    }

  private:
    template <class T>
    static std::int64_t count(std::vector<T> const& items) {
        return static_cast<std::int64_t>(items.size());
    }
    static double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }
    int restricted(std::int64_t joint) const { return group_.restricted_of_joint[joint]; }

    void assemble_run(Run const& run) {
        Matrices segment = leaf_.matrix(run.body);
        for (std::int64_t k = run.body + 1; k < run.body + run.count; ++k)
            segment = assemble(segment, leaf_.matrix(k), restricted(k), joints_[k]);
        matrices_[run.slot] = segment;
    }
    void assemble_run_bias(Run const& run, LoadsView const& loads) {
        Biases segment = leaf_.bias(loads, run.body);
        for (std::int64_t k = run.body + 1; k < run.body + run.count; ++k)
            segment = assemble(segment, leaf_.bias(loads, k), joints_[k], offsets_[k]);
        biases_[run.slot] = segment;
    }
    void disassemble_run(Run const& run, LoadsView const& loads, AccelerationsView const& out) {
        Vector<double, K> const first = forces_[run.body];
        Vector<double, K> next = forces_[run.next];
        for (std::int64_t k = run.body + run.count - 1; k >= run.body; --k) {
            Vector<double, K> const force = k == run.body ? first : disassemble(joints_[k], offsets_[k], first, next);
            leaf_.accelerate(loads, k, force, next, out);
            if (out.joint_force) out.joint_force.store(k, force);
            if (out.tip_force && group_.has_jointed_tip(k)) out.tip_force.store(k, next);
            next = force;
        }
    }

    void assemble_level(std::vector<Merge> const& level) {
        executor_.for_each(count(level), [&](std::int64_t i) {
            Merge const& m = level[i];
            matrices_[m.slot] = assemble(matrices_[m.inboard], matrices_[m.outboard], restricted(m.joint), joints_[m.joint]);
        });
    }
    void assemble_level_bias(std::vector<Merge> const& level) {
        executor_.for_each(count(level), [&](std::int64_t i) {
            Merge const& m = level[i];
            biases_[m.slot] = assemble(biases_[m.inboard], biases_[m.outboard], joints_[m.joint], offsets_[m.joint]);
        });
    }
    void disassemble_level(std::vector<Merge> const& level) {
        executor_.for_each(count(level), [&](std::int64_t i) {
            Merge const& m = level[i];
            forces_[m.joint] = disassemble(joints_[m.joint], offsets_[m.joint], forces_[m.first], forces_[m.next]);
        });
    }
    template <class Action>
    void for_roots(Action const& action) {
        executor_.for_each(count(schedule_.roots), [&](std::int64_t i) { action(schedule_.roots[i]); });
        for (Root const& root : schedule_.top_roots) action(root);
    }

    /// Where base and tip hold a chain more than once nothing but rounding is left of a pivot: it is made to fail. What was there before:
    /// the chain as it floats.
    void refuse_redundant(Root const& root) {
        double constexpr lost = 0x1p-33;  // fewer than six digits would be left
        auto const check = [&](Symmetric<double, K>& factor, Symmetric<double, K> const& floating, int restricted) {
            for (int i = 0; i < restricted; ++i)
                if (1 / factor(i, i) < lost * floating(i, i)) factor(i, i) = std::numeric_limits<double>::quiet_NaN();
        };
        check(joints_[root.next].factor, matrices_[root.slot].z22, restricted(root.next));
        check(joints_[root.first].factor, matrices_[root.slot].z11, restricted(root.first));
    }

    /// One collective: the units of chains that several ranks share, to all ranks.
    template <class Segment>
    void gather_shared(std::vector<Segment>& segments) {
        auto const start = now();
        std::vector<Segment> own;
        std::vector<std::int64_t> bytes(static_cast<std::size_t>(communicator_.size()), 0);
        for (SharedUnit const& unit : schedule_.shared) {
            bytes[unit.owner] += sizeof(Segment);
            if (unit.source >= 0) own.push_back(segments[unit.source]);
        }
        std::vector<Segment> all(schedule_.shared.size());
        communicator_.all_gather(std::as_bytes(std::span(own)), std::as_writable_bytes(std::span(all)), bytes);
        for (std::size_t i = 0; i < all.size(); ++i) segments[schedule_.shared[i].slot] = all[i];
        report_.exchange_seconds += now() - start;
    }

    /// Roots see every pivot's failure: a NaN or infinity travels up, a negative pivot is looked for.
    void check_definite() const {
        for (std::int64_t k = 0; k < static_cast<std::int64_t>(joints_.size()); ++k) {
            if (k == schedule_.halo || k == schedule_.none) continue;
            for (int i = 0; i < restricted(k); ++i)
                if (double const p = joints_[k].factor(i, i); !(p > 0) || !std::isfinite(p)) fail(k);
        }
    }
    [[noreturn]] void fail(std::int64_t joint) const {
        std::int64_t chain, body;
        if (joint < schedule_.bodies) {
            std::int64_t const global = group_.partition.first_of_rank[communicator_.rank()] + joint;
            chain = group_.partition.chain_of(global);
            body = global - group_.partition.first_of_chain[chain];
        } else if (joint < schedule_.first_top_joint()) {
            chain = schedule_.tip_chain[joint - schedule_.first_tip()];
            body = group_.partition.trees[chain].bodies;
        } else {
            chain = schedule_.top_chain_of_joint[joint - schedule_.first_top_joint()];
            body = schedule_.top_body_of_joint[joint - schedule_.first_top_joint()];
        }
        bool const tip = body == group_.partition.trees[chain].bodies;
        throw ComputationError(
            "the matrix of a joint is not positive definite (chain " + group_.name[chain] +
            (tip ? ", the tip's joint" : ", body " + std::to_string(body + 1)) +
            "): masses, inertias or positions there are extreme or not finite" +
            (group_.partition.jointed_tip[chain] ? ", or base and tip hold the chain more than once (stretched straight?)" : ""));
    }

    ChainGroup const& group_;
    Schedule const& schedule_;
    Executor const& executor_;
    Communicator const& communicator_;
    Leaf leaf_;
    std::vector<Matrices> matrices_;
    std::vector<Biases> biases_;
    std::vector<JointMatrix<double, K>> joints_;
    std::vector<Vector<double, K>> offsets_, forces_;
    SolverReport report_;
};

}  // namespace catena::dca
