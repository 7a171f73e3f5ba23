// The driver: which segment meets which, and when ranks speak. All mathematics is in segment.hpp and leaf.hpp.
#pragma once

#include <chrono>
#include <cmath>
#include <vector>

#include "dca/tree_sweeps.hpp"
#include "error.hpp"

namespace catena::dca {

template <class Leaf>
class TreeSolver final : public ChainSolver {
    static constexpr int K = Leaf::K;
    using Sweeps = TreeSweeps<Leaf>;
    using Matrices = typename Sweeps::Matrices;
    using Biases = typename Sweeps::Biases;

  public:
    TreeSolver(ChainGroup const& group, Executor const& executor, Communicator const& communicator)
        : group_(group),
          schedule_(group.schedule),
          executor_(executor),
          communicator_(communicator),
          matrices_(static_cast<std::size_t>(schedule_.slots)),
          biases_(matrices_.size()),
          joints_(static_cast<std::size_t>(schedule_.joints)),
          offsets_(joints_.size()),
          forces_(joints_.size(), Vector<double, K>::zero()),
          sweeps_{Leaf(group.view()), group.restricted_of_joint.data(), matrices_.data(), biases_.data(), joints_.data(), offsets_.data(),
                  forces_.data()} {}

    void assemble_matrices(ConfigurationView const& configuration) override {
        auto const start = now();
        sweeps_.leaf.set(configuration);
        auto const each = [this](auto const& item) { sweeps_.assemble_matrices(item); };
        over(schedule_.runs, each);
        for (auto const& level : schedule_.levels) over(level, each);
        if (!schedule_.shared.empty()) gather_shared(matrices_);
        for (auto const& level : schedule_.top_levels) over(level, each);
        for_roots([this](Root const& root) { sweeps_.close_matrices(root); });
        ++report_.matrix_sweeps;
        report_.matrix_seconds += now() - start;
        check_definite();
    }

    void solve(LoadsView const& loads, AccelerationsView const& out) override {
        auto const start = now();
        auto const each = [&](auto const& item) { sweeps_.assemble_biases(loads, item); };
        over(schedule_.runs, each);
        for (auto const& level : schedule_.levels) over(level, each);
        if (!schedule_.shared.empty()) gather_shared(biases_);
        for (auto const& level : schedule_.top_levels) over(level, each);
        for_roots([this](Root const& root) { sweeps_.close_biases(root); });
        auto const down = [this](Merge const& merge) { sweeps_.disassemble_forces(merge); };
        for (std::size_t l = schedule_.top_levels.size(); l-- > 0;) over(schedule_.top_levels[l], down);
        for (TopCopy const& copy : schedule_.top_copies) forces_[copy.to] = forces_[copy.from];
        for (std::size_t l = schedule_.levels.size(); l-- > 0;) over(schedule_.levels[l], down);
        over(schedule_.runs, [&](Run const& run) { sweeps_.disassemble_forces(loads, out, run); });
        if (out.joint_force) out.joint_force.store(schedule_.bodies, forces_[schedule_.halo]);
        ++report_.bias_sweeps;
        report_.bias_seconds += now() - start;
    }

    SolverReport report() const override {
        SolverReport r = report_;
        add_tree(group_, communicator_, r);
        r.threads = executor_.threads();
        r.memory_bytes = Sweeps::bytes(schedule_);
        return r;
    }

  private:
    static double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }
    int restricted(std::int64_t joint) const { return group_.restricted_of_joint[joint]; }

    template <class Item, class Action>
    void over(std::vector<Item> const& items, Action const& action) {
        executor_.for_each(static_cast<std::int64_t>(items.size()), [&](std::int64_t i) { action(items[static_cast<std::size_t>(i)]); });
    }
    template <class Action>
    void for_roots(Action const& action) {
        over(schedule_.roots, action);
        for (Root const& root : schedule_.top_roots) action(root);
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
                if (double const p = joints_[k].factor(i, i); !(p > 0) || !std::isfinite(p))
                    refuse_indefinite(group_, communicator_.rank(), k);
        }
    }

    ChainGroup const& group_;
    Schedule const& schedule_;
    Executor const& executor_;
    Communicator const& communicator_;
    std::vector<Matrices> matrices_;
    std::vector<Biases> biases_;
    std::vector<JointMatrix<double, K>> joints_;
    std::vector<Vector<double, K>> offsets_, forces_;
    Sweeps sweeps_;
    SolverReport report_;
};

}  // namespace catena::dca
