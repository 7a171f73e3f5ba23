#include "tests/support/level_solvers.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "error.hpp"
#include "integrate/joint_dynamics.hpp"

namespace catena::test {
namespace {

template <class View>
bool same_numbers(View const& a, View const& b, std::int64_t count, int width) {
    if (!a.origin) return true;
    for (int i = 0; i < width; ++i)
        if (std::memcmp(a.origin + i * a.pitch, b.origin + i * b.pitch, static_cast<std::size_t>(count) * sizeof(double)) != 0)
            return false;
    return true;
}

struct Results {
    explicit Results(ChainGroup const& group)
        : alpha(group.size),
          acceleration(group.size),
          joint_force(group.size + 1, group.directions),
          tip_force(group.size, group.directions) {}
    AccelerationsView as(AccelerationsView const& wanted) {
        AccelerationsView v;
        if (wanted.alpha.origin) v.alpha = alpha.view();
        if (wanted.acceleration.origin) v.acceleration = acceleration.view();
        if (wanted.joint_force) v.joint_force = joint_force.view();
        if (wanted.tip_force) v.tip_force = tip_force.view();
        return v;
    }
    Field<3> alpha, acceleration;
    DirectionsField joint_force, tip_force;
};

std::string words_of(std::function<void()> const& action) {
    try {
        action();
    } catch (ComputationError const& error) {
        return error.what();
    }
    return "";
}

class ComparedSolver final : public ChainSolver {
  public:
    ComparedSolver(ChainGroup const& group, Executor const& executor, Communicator const& communicator, dca::LevelPartMaker const& lower,
                   bool many)
        : group_(group), reference_(make_tree_solver(group, executor, communicator)) {
        int levels = 0;
        for (dca::ChainTree const& tree : group.partition.trees) levels = std::max(levels, tree.levels());
        for (int up = 0; up <= levels + 1; ++up)
            for (int down = 0; down <= levels + 1; ++down) {
                bool const chosen = up == down || up + down == levels || (up == 1 && down == 0) || (up == 0 && down == 1);
                if (!many && !chosen) continue;
                std::string const name = "levels " + std::to_string(up) + "," + std::to_string(down) + " of " + std::to_string(levels);
                cuts_.push_back({name, make_level_solver(group, communicator, {up, down}, lower, dca::host_levels(executor))});
            }
    }
    void assemble_matrices(ConfigurationView const& c) override {
        std::string const refused = words_of([&] { reference_->assemble_matrices(c); });
        for (auto const& [name, solver] : cuts_) EXPECT_EQ(words_of([&] { solver->assemble_matrices(c); }), refused) << name;
        if (!refused.empty()) throw ComputationError(refused);
    }
    void solve(LoadsView const& loads, AccelerationsView const& out) override {
        reference_->solve(loads, out);
        for (auto const& [name, solver] : cuts_) {
            Results own(group_);
            AccelerationsView const found = own.as(out);
            solver->solve(loads, found);
            SCOPED_TRACE(name);
            EXPECT_TRUE(same_numbers(out.alpha, found.alpha, group_.size, 3));
            EXPECT_TRUE(same_numbers(out.acceleration, found.acceleration, group_.size, 3));
            EXPECT_TRUE(same_numbers(out.joint_force, found.joint_force, group_.size + 1, group_.directions));
            for (std::int64_t k = 0; out.tip_force && k < group_.size; ++k) {  // of last bodies alone
                if (!group_.has_jointed_tip(k)) continue;
                for (int i = 0; i < group_.directions; ++i)
                    EXPECT_EQ(out.tip_force.origin[i * out.tip_force.pitch + k], found.tip_force.origin[i * found.tip_force.pitch + k]);
            }
        }
    }
    SolverReport report() const override { return reference_->report(); }

  private:
    ChainGroup const& group_;
    std::unique_ptr<ChainSolver> reference_;
    std::vector<std::pair<std::string, std::unique_ptr<ChainSolver>>> cuts_;
};

void evaluate(ChainGroup const& group, Scene const& scene, Executor const& executor, Communicator const& communicator,
              std::unique_ptr<ChainSolver> solver) {
    if (!group.beads && group.axes == Axes::joint && !group.linked) {
        auto const dynamics = make_joint_dynamics(group, scene, executor, communicator, std::move(solver));
        dynamics->update_configuration();
        dynamics->assemble_matrices();
        dynamics->solve();
        return;
    }
    auto const make = group.beads ? make_bead_dynamics : make_rigid_dynamics;
    auto const dynamics = make(group, scene, executor, communicator, std::move(solver));
    dynamics->update_configuration();
    dynamics->assemble_matrices();
    dynamics->set_simple_forces();
    dynamics->observe(0);  // without accelerations
    dynamics->evaluate();
}

}  // namespace

void expect_same_bits_at_every_cut(Scene const& scene, Axes axes, Handles handles, dca::LevelPartMaker const& lower,
                                   Communicator const& communicator, bool many) {
    auto const executor = serial_executor();
    for (auto const& group : make_groups(scene, axes, handles, true, communicator)) {
        auto solver = std::make_unique<ComparedSolver>(*group, *executor, communicator, lower, many);
        std::string const refused = words_of([&] { evaluate(*group, scene, *executor, communicator, std::move(solver)); });
        EXPECT_TRUE(refused.empty() || refused.find("not positive definite") != std::string::npos) << refused;
    }
}

}  // namespace catena::test
