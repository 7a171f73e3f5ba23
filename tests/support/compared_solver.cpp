#include "tests/support/compared_solver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>

#include "dynamics/joint/joint_dynamics.hpp"
#include "error.hpp"
#include "integrate/constrained_integrator.hpp"

namespace catena::test {
namespace {

template <class View>
bool same_numbers(View const& a, View const& b, std::int64_t count, int width) {
    if (!a.origin) return true;
    for (int i = 0; i < width; ++i)
        if (std::memcmp(a.origin + i * a.pitch, b.origin + i * b.pitch,
                        static_cast<std::size_t>(count) * sizeof(double)) != 0)
            return false;
    return true;
}

struct Results {
    explicit Results(ChainGroup const& group)
        : alpha(group.size),
          acceleration(group.size),
          joint_force(group.size + 1, group.directions),
          tip_force(group.size, group.directions),
          revolute_acceleration(group.size + 1) {}
    AccelerationsView as(AccelerationsView const& wanted) {
        AccelerationsView v;
        if (wanted.alpha.origin) v.alpha = alpha.view();
        if (wanted.acceleration.origin) v.acceleration = acceleration.view();
        if (wanted.joint_force) v.joint_force = joint_force.view();
        if (wanted.tip_force) v.tip_force = tip_force.view();
        if (wanted.revolute_acceleration.origin)
            v.revolute_acceleration = revolute_acceleration.view();
        return v;
    }
    Field<3> alpha, acceleration;
    DirectionsField joint_force, tip_force;
    Field<2> revolute_acceleration;
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
    ComparedSolver(ChainGroup const& group, std::unique_ptr<ChainSolver> reference,
                   std::vector<NamedSolver> others)
        : group_(group), reference_(std::move(reference)), others_(std::move(others)) {}
    void assemble_matrices(ConfigurationView const& c) override {
        each_as_reference([&](ChainSolver& solver) { solver.assemble_matrices(c); });
    }
    void solve(LoadsView const& loads, AccelerationsView const& out) override {
        each_as_reference(out, [&](ChainSolver& solver, AccelerationsView const& own) {
            solver.solve(loads, own);
        });
    }
    void assemble_and_solve(ConfigurationView const& c, LoadsView const& loads,
                            AccelerationsView const& out) override {
        each_as_reference(out, [&](ChainSolver& solver, AccelerationsView const& own) {
            solver.assemble_and_solve(c, loads, own);
        });
    }
    bool at_once() const override { return reference_->at_once(); }
    bool eliminates_revolute_joints() const override {
        return reference_->eliminates_revolute_joints() &&
               std::all_of(others_.begin(), others_.end(), [](NamedSolver const& other) {
                   return other.solver->eliminates_revolute_joints();
               });
    }
    SolverReport report() const override { return reference_->report(); }

  private:
    template <class Action>
    void each_as_reference(Action const& action) const {
        std::string const refused = words_of([&] { action(*reference_); });
        for (NamedSolver const& other : others_)
            EXPECT_EQ(words_of([&] { action(*other.solver); }), refused) << other.name;
        if (!refused.empty()) throw ComputationError(refused);
    }
    template <class Action>
    void each_as_reference(AccelerationsView const& out, Action const& action) const {
        std::string const refused = words_of([&] { action(*reference_, out); });
        for (NamedSolver const& other : others_) {
            Results own(group_);
            AccelerationsView const found = own.as(out);
            SCOPED_TRACE(other.name);
            EXPECT_EQ(words_of([&] { action(*other.solver, found); }), refused);
            if (refused.empty()) expect_same(out, found);
        }
        if (!refused.empty()) throw ComputationError(refused);
    }
    void expect_same(AccelerationsView const& out, AccelerationsView const& found) const {
        if (out.revolute_acceleration.origin) {  // and of some bodies others are left as they were
            EXPECT_TRUE(same_numbers(out.revolute_acceleration, found.revolute_acceleration,
                                     group_.size + 1, 2));
            return expect_same_ends(out, found);
        }
        EXPECT_TRUE(same_numbers(out.alpha, found.alpha, group_.size, 3));
        EXPECT_TRUE(same_numbers(out.acceleration, found.acceleration, group_.size, 3));
        EXPECT_TRUE(
            same_numbers(out.joint_force, found.joint_force, group_.size + 1, group_.directions));
        for (std::int64_t k = 0; out.tip_force && k < group_.size; ++k) {  // of last bodies alone
            if (!group_.ends.has_jointed_tip(k)) continue;
            for (int i = 0; i < group_.directions; ++i)
                EXPECT_EQ(out.tip_force.origin[i * out.tip_force.pitch + k],
                          found.tip_force.origin[i * found.tip_force.pitch + k]);
        }
    }

    /// Accelerations of the bodies that AccelerationsView says.
    void expect_same_ends(AccelerationsView const& out, AccelerationsView const& found) const {
        auto const expect_same_body = [&](std::int64_t k) {
            for (int i = 0; i < 3; ++i) {
                EXPECT_EQ(out.alpha.at(k, i), found.alpha.at(k, i)) << "body " << k;
                EXPECT_EQ(out.acceleration.at(k, i), found.acceleration.at(k, i)) << "body " << k;
            }
        };
        std::vector<dca::Run> const& runs = group_.schedule.runs;
        for (std::size_t r = 0; r < runs.size(); ++r) {
            dca::Run const& run = runs[r];
            if (run.count == 1 || group_.ends.is_first[static_cast<std::size_t>(run.body)] != 0)
                expect_same_body(run.body);
            if (r + 1 == runs.size() || runs[r + 1].count == 1)
                expect_same_body(run.body + run.count - 1);
        }
    }

    ChainGroup const& group_;
    std::unique_ptr<ChainSolver> reference_;
    std::vector<NamedSolver> others_;
};

void evaluate(ChainGroup const& group, Scene const& scene, Executor const& executor,
              Communicator const& communicator, std::unique_ptr<ChainSolver> solver, bool at_once) {
    if (!group.beads && group.axes == Axes::joint && !group.linked) {
        auto const dynamics =
            make_joint_dynamics(group, scene, executor, communicator, std::move(solver));
        dynamics->update_configuration();
        dynamics->assemble_matrices();
        dynamics->solve();
        dynamics->residual(executor);  // which asks for the joints' forces
        dynamics->solve_once();
        dynamics->residual(executor);
        dynamics->update_to_solve_once();
        dynamics->solve_once();
        dynamics->residual(executor);
        return;
    }
    auto const dynamics =
        group.beads ? make_bead_dynamics(group, scene, executor, communicator, std::move(solver))
                    : make_rigid_dynamics(group, scene, executor, communicator, std::move(solver));
    dynamics->update_configuration();
    std::string refused = words_of([&] { dynamics->assemble_matrices(); });
    if (refused.empty())
        refused = closing_drifts_of(*dynamics).trouble();  // kept until somebody looks
    dynamics->set_simple_forces();
    if (refused.empty()) {
        dynamics->observe(0);  // without accelerations
        dynamics->evaluate();
    }
    if (at_once) dynamics->evaluate_at_once();
    if (!refused.empty()) throw ComputationError(refused);
}

}  // namespace

std::unique_ptr<ChainSolver> compared_solver(ChainGroup const& group,
                                             std::unique_ptr<ChainSolver> reference,
                                             std::vector<NamedSolver> others) {
    return std::make_unique<ComparedSolver>(group, std::move(reference), std::move(others));
}

void evaluate_compared(ChainGroup const& group, Scene const& scene, Executor const& executor,
                       Communicator const& communicator, std::unique_ptr<ChainSolver> compared,
                       bool at_once) {
    std::string const refused = words_of(
        [&] { evaluate(group, scene, executor, communicator, std::move(compared), at_once); });
    EXPECT_TRUE(refused.empty() || refused.find("not positive definite") != std::string::npos)
        << refused;
}

}  // namespace catena::test
