// The driver, for any Space: which segment meets which, and when ranks speak. All mathematics is in segment.hpp and leaf.hpp.
#pragma once

#include <chrono>
#include <vector>

#include "dca/host_space.hpp"
#include "dca/tree_sweeps.hpp"

namespace catena::dca {

/// Views that it is given are of its space.
template <class Leaf, class Space>
class TreeSolver final : public ChainSolver {
    static constexpr int K = Leaf::K;
    using Sweeps = TreeSweeps<Leaf>;
    using Matrices = typename Sweeps::Matrices;
    using Biases = typename Sweeps::Biases;
    template <class T>
    using Array = typename Space::template Array<T>;

  public:
    TreeSolver(ChainGroup const& group, Space const& space, Communicator const& communicator)
        : group_(group),
          schedule_(group.schedule),
          space_(space),
          communicator_(communicator),
          model_(group),
          runs_(schedule_.runs),
          levels_(schedule_.levels),
          top_levels_(schedule_.top_levels),
          roots_(schedule_.roots),
          top_roots_(schedule_.top_roots),
          top_copies_(schedule_.top_copies),
          matrices_(static_cast<std::size_t>(schedule_.slots)),
          biases_(matrices_.size()),
          joints_(static_cast<std::size_t>(schedule_.joints)),
          offsets_(joints_.size()),
          forces_(joints_.size()),
          sweeps_{Leaf(model_.view()), model_.restricted(), matrices_.data(), biases_.data(),
                  joints_.data(),      offsets_.data(),     forces_.data()} {}

    void assemble_matrices(ConfigurationView const& configuration) override {
        auto const start = now();
        sweeps_.leaf.set(configuration);
        auto const merge = [sweeps = sweeps_] CATENA_LAMBDA(Merge const& m) { sweeps.assemble_matrices(m); };
        auto const close = [sweeps = sweeps_] CATENA_LAMBDA(Root const& root) { sweeps.close_matrices(root); };
        space_.over(runs_, [sweeps = sweeps_] CATENA_LAMBDA(Run const& run) { sweeps.assemble_matrices(run); });
        space_.climb(levels_, merge);
        if (!schedule_.shared.empty()) gather_shared(matrices_);
        space_.climb(top_levels_, merge);
        space_.over(roots_, close);
        space_.over(top_roots_, close);
        ++report_.matrix_sweeps;
        // Roots see every pivot's failure: a NaN or infinity travels up, a negative pivot is looked for.
        std::int64_t const joints = schedule_.joints;
        std::int64_t const bad =
            space_.first(joints, [sweeps = sweeps_, halo = schedule_.halo, none = schedule_.none] CATENA_LAMBDA(std::int64_t k) -> bool {
                return k != halo && k != none && !sweeps.definite(k);
            });
        report_.matrix_seconds += now() - start;
        if (bad < joints) refuse_indefinite(group_, communicator_.rank(), bad);
    }

    void solve(LoadsView const& loads, AccelerationsView const& out) override {
        auto const start = now();
        auto const up = [sweeps = sweeps_, loads] CATENA_LAMBDA(Merge const& m) { sweeps.assemble_biases(loads, m); };
        auto const close = [sweeps = sweeps_] CATENA_LAMBDA(Root const& root) { sweeps.close_biases(root); };
        auto const down = [sweeps = sweeps_] CATENA_LAMBDA(Merge const& m) { sweeps.disassemble_forces(m); };
        space_.over(runs_, [sweeps = sweeps_, loads] CATENA_LAMBDA(Run const& run) { sweeps.assemble_biases(loads, run); });
        space_.climb(levels_, up);
        if (!schedule_.shared.empty()) gather_shared(biases_);
        space_.climb(top_levels_, up);
        space_.over(roots_, close);
        space_.over(top_roots_, close);
        space_.descend(top_levels_, down);
        space_.over(top_copies_, [forces = forces_.data()] CATENA_LAMBDA(TopCopy const& copy) { forces[copy.to] = forces[copy.from]; });
        space_.descend(levels_, down);
        space_.over(runs_, [sweeps = sweeps_, loads, out] CATENA_LAMBDA(Run const& run) { sweeps.disassemble_forces(loads, out, run); });
        if (out.joint_force)  // of the joint after this rank's last body
            space_.for_each(1, [sweeps = sweeps_, out, from = schedule_.halo, to = schedule_.bodies] CATENA_LAMBDA(std::int64_t) {
                out.joint_force.template store<K>(to, sweeps.forces[from]);
            });
        space_.wait();
        ++report_.bias_sweeps;
        report_.bias_seconds += now() - start;
    }

    SolverReport report() const override {
        SolverReport r = report_;
        add_tree(group_, communicator_, r);
        r.threads = space_.threads();
        r.memory_bytes = Sweeps::bytes(schedule_);
        return r;
    }

  private:
    static double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

    /// One collective: the units of chains that several ranks share, to all ranks.
    template <class Segment>
    void gather_shared(Array<Segment>& segments) {
        auto const start = now();
        std::vector<Segment> own;
        std::vector<std::int64_t> bytes(static_cast<std::size_t>(communicator_.size()), 0);
        for (SharedUnit const& unit : schedule_.shared) {
            bytes[unit.owner] += sizeof(Segment);
            if (unit.source >= 0) own.push_back(space_.get(segments.data() + unit.source));
        }
        std::vector<Segment> all(schedule_.shared.size());
        communicator_.all_gather(std::as_bytes(std::span(own)), std::as_writable_bytes(std::span(all)), bytes);
        for (std::size_t i = 0; i < all.size(); ++i) space_.put(segments.data() + schedule_.shared[i].slot, all[i]);
        report_.exchange_seconds += now() - start;
    }

    ChainGroup const& group_;
    Schedule const& schedule_;
    Space space_;
    Communicator const& communicator_;
    typename Space::Model model_;
    typename Space::template List<Run> runs_;
    typename Space::template Levels<Merge> levels_, top_levels_;
    typename Space::template List<Root> roots_, top_roots_;
    typename Space::template List<TopCopy> top_copies_;
    Array<Matrices> matrices_;
    Array<Biases> biases_;
    Array<JointMatrix<double, K>> joints_;
    Array<Vector<double, K>> offsets_, forces_;
    Sweeps sweeps_;
    SolverReport report_;
};

}  // namespace catena::dca
