// Implements the measurement of single levels of the pairwise tree.
#include "plan/level_costs.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "dynamics/absolute_dynamics.hpp"
#include "dynamics/joint/joint_dynamics.hpp"
#include "integrate/timeline.hpp"

namespace catena::plan {
namespace {

using dca::LevelPart;
using Items = LevelPart::Items;

/// Replaces a solver: it times each part of the work that the dynamics asks for and solves nothing.
class Probe final : public ChainSolver {
  public:
    Probe(ChainGroup const& group, dca::LevelPartMaker const& maker, Effort const& effort)
        : effort_(effort),
          bodies_(maker(group, {true, true, 0, 0, 0, 0, false})),
          level_(maker(group, {false, false, 0, 1, 0, 1, false})) {
        std::vector<std::int64_t> places(static_cast<std::size_t>(group.size));
        std::iota(places.begin(), places.end(), 0);
        segments_of_bodies_ = bodies_->choose(places);
        joints_of_bodies_ = bodies_->choose(places);
        segments_of_level_ = level_->choose(places);
    }

    void assemble_matrices(ConfigurationView const& configuration) override {
        configuration_ = configuration;
    }
    /// Measures all parts and keeps the least times; leaves `out` without a solution.
    void solve(LoadsView const& loads, AccelerationsView const& out) override {
        time_once(loads, out);
        least_.fill(std::numeric_limits<double>::infinity());
        double const start = seconds_now();
        for (int i = 0;
             i < effort_.most && (i < effort_.least || seconds_now() - start < effort_.seconds);
             ++i) {
            LevelSeconds const once = time_once(loads, out);
            for (std::size_t c = 0; c < level_costs; ++c) least_[c] = std::min(least_[c], once[c]);
        }
    }
    SolverReport report() const override { return {}; }
    LevelSeconds const& least() const { return least_; }

  private:
    /// Runs every part once and returns the seconds of each.
    LevelSeconds time_once(LoadsView const& loads, AccelerationsView const& out) {
        LevelSeconds spent{};
        double last = seconds_now();
        auto const to = [&](LevelCost cost) {
            double const moment = seconds_now();
            spent[cost] += moment - last;
            last = moment;
        };
        bodies_->set(configuration_);
        bodies_->set(loads, out);
        to(views);
        bodies_->assemble_matrices();
        bodies_->assemble_biases();
        to(bodies_up);
        bodies_->get(Items::matrices, segments_of_bodies_, matrices_);
        bodies_->get(Items::biases, segments_of_bodies_, biases_);
        to(segments_up);
        bodies_->get(Items::joints, joints_of_bodies_, joints_);
        bodies_->get(Items::offsets, joints_of_bodies_, offsets_);
        to(joints_across);
        level_->put(Items::matrices, segments_of_level_, matrices_);
        level_->put(Items::biases, segments_of_level_, biases_);
        last = seconds_now();
        level_->assemble_matrices();
        level_->assemble_biases();
        to(merges_up);
        level_->disassemble();
        to(merges_down);
        // The values of the forces do not matter here.
        bodies_->put(Items::forces, joints_of_bodies_, offsets_);
        to(forces_down);
        bodies_->disassemble();
        to(bodies_down);
        bodies_->fetch();
        to(views);
        return spent;
    }

    Effort effort_;
    std::unique_ptr<LevelPart> bodies_, level_;
    int segments_of_bodies_ = 0, joints_of_bodies_ = 0, segments_of_level_ = 0;
    ConfigurationView configuration_;
    std::vector<double> matrices_, biases_, joints_, offsets_;
    LevelSeconds least_{};
};

}  // namespace

LevelSeconds measure_level_costs(Family const& family, std::int64_t bodies,
                                 dca::LevelPartMaker const& maker, Effort const& effort) {
    Scene const scene = sample(family, bodies);
    auto const communicator = serial_communicator();
    auto const executor = serial_executor();
    auto const groups = make_groups(scene, family.axes, family.handles, true, *communicator);
    ChainGroup const& group = *groups.front();
    auto owned = std::make_unique<Probe>(group, maker, effort);
    Probe const& probe = *owned;
    if (family.axes == Axes::joint) {
        auto const dynamics =
            make_joint_dynamics(group, scene, *executor, *communicator, std::move(owned));
        dynamics->update_configuration();
        dynamics->assemble_matrices();
        dynamics->solve();
        return probe.least();
    }
    auto const dynamics =
        group.beads ? make_bead_dynamics(group, scene, *executor, *communicator, std::move(owned))
                    : make_rigid_dynamics(group, scene, *executor, *communicator, std::move(owned));
    dynamics->update_configuration();
    dynamics->set_simple_forces();
    dynamics->assemble_matrices();
    dynamics->evaluate();
    return probe.least();
}

}  // namespace catena::plan
