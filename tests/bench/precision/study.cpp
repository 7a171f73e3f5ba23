#include "tests/bench/precision/study.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "chain/chain_group.hpp"
#include "dynamics/joint/joint_dynamics.hpp"
#include "error.hpp"
#include "measure/solver_errors.hpp"
#include "mpi/communicator.hpp"

namespace catena::precision {
namespace {

/// Of the processor: what else runs on the machine then counts for its caches alone.
double seconds_of(std::function<void()> const& action, int times) {
    std::clock_t const start = std::clock();
    for (int i = 0; i < times; ++i) action();
    return static_cast<double>(std::clock() - start) /
           (CLOCKS_PER_SEC * static_cast<double>(times));
}

}  // namespace

Problem::Problem(Scene scene, int nudges)
    : scene_(std::move(scene)),
      communicator_(serial_communicator()),
      executor_(serial_executor()),
      groups_(make_groups(scene_, Axes::joint, Handles::projected, false, *communicator_)),
      group_(groups_.front().get()),
      joint_(groups_.size() == 1 ? joint_of(*group_) : std::nullopt),
      layout_(layout_of(scene_)) {
    if (joint_) exact_ = exact_solution(scene_, layout_, largest_quad, nudges);
}

double Problem::residual_bound() const {
    return 32 * static_cast<double>(group_->partition.trees.front().depth()) * 0x1p-53;
}

/// `accelerations`: of beads, else second derivatives of coordinates.
double Problem::error_of(std::vector<Vec3> const& accelerations, Vec3 const& base) const {
    Solution found = layout_;
    ChainSpec const& chain = scene_.chains.front();
    for (std::size_t k = 0; k < chain.size(); ++k) {
        int const count = accelerations_of(chain, k);
        for (int i = 0; i < std::min(3, count); ++i)
            found.acceleration.push_back(accelerations[k][i]);
        if (count == 6)
            found.acceleration.insert(found.acceleration.end(), base.data, base.data + 3);
    }
    return largest_difference(scene_, found, exact_.acceleration);
}

Errors Problem::errors(ChainInArrays& chain) const {
    auto owned = std::make_unique<StudiedSolver>(
        make_tree_solver(*group_, *executor_, *communicator_), chain);
    StudiedSolver& solver = *owned;
    Errors e;
    try {
        if (group_->beads) return errors_of_beads(solver, std::move(owned));
        auto const dynamics =
            make_joint_dynamics(*group_, scene_, *executor_, *communicator_, std::move(owned));
        solver.begin();
        dynamics->update_configuration();
        dynamics->assemble_matrices();
        for (int steps = 0; steps <= most_steps; ++steps) {
            solver.refine(steps);
            dynamics->solve();
            dynamics->set_rates();
            JointRates const rates = dynamics->rates();
            std::vector<Vec3> qdd;
            for (std::int64_t k = 0; k < group_->size; ++k) qdd.push_back(rates.qdd[k]);
            e.error[static_cast<std::size_t>(steps)] = error_of(qdd, rates.base_acceleration[0]);
            e.residual[static_cast<std::size_t>(steps)] = dynamics->residual(*executor_);
        }
    } catch (ComputationError const&) {
        e.definite = false;
    }
    return e;
}

/// Velocities are made to fit the links by the library's own solver.
Errors Problem::errors_of_beads(StudiedSolver& solver, std::unique_ptr<ChainSolver> owned) const {
    auto const dynamics =
        make_bead_dynamics(*group_, scene_, *executor_, *communicator_, std::move(owned));
    dynamics->update_configuration();
    dynamics->assemble_matrices();
    dynamics->set_simple_forces();
    dynamics->observe(0);
    solver.begin();
    dynamics->assemble_matrices();
    Errors e;
    for (int steps = 0; steps <= most_steps; ++steps) {
        solver.refine(steps);
        dynamics->evaluate();
        e.error[static_cast<std::size_t>(steps)] =
            error_of(dynamics->results().acceleration, Vec3::zero());
        e.residual[static_cast<std::size_t>(steps)] = dynamics->residual();
    }
    return e;
}

std::function<void()> Problem::library_evaluation(SimdLevel level) const {
    std::shared_ptr<Executor> const executor = serial_executor(level);
    auto solver = make_tree_solver(*group_, *executor, *communicator_);
    if (group_->beads) {
        std::shared_ptr<AbsoluteDynamics> const dynamics =
            make_bead_dynamics(*group_, scene_, *executor, *communicator_, std::move(solver));
        dynamics->update_configuration();
        dynamics->assemble_matrices();
        dynamics->set_simple_forces();
        dynamics->observe(0);
        return [executor, dynamics] { dynamics->evaluate_at_once(); };
    }
    std::shared_ptr<JointDynamics> const dynamics =
        make_joint_dynamics(*group_, scene_, *executor, *communicator_, std::move(solver));
    dynamics->update_configuration();
    return [executor, dynamics] { dynamics->solve_once(); };
}

AllTimes times_of(ChainInArrays const& in_double, ChainInArrays const& in_single,
                  std::function<void()> library, int repeat) {
    constexpr double shortest_sample = 2e-3;
    struct Measured {
        std::function<void()> action;
        double* to;
        int times = 1;
        std::vector<double> samples = {};
    };
    AllTimes all_times;
    std::vector<Measured> all;
    for (auto const& [chain, times] :
         {std::pair{&in_double, &all_times.in_double}, {&in_single, &all_times.in_single}}) {
        all.push_back({[c = chain] { c->assemble(); }, &times->matrix});
        all.push_back({[c = chain] { c->solve(); }, &times->bias});
        all.push_back({[c = chain] { c->find_defect(); }, &times->defect});
        for (int steps = 0; steps <= most_steps; ++steps)
            all.push_back({[c = chain, steps] { c->evaluate(steps); },
                           &times->evaluation[static_cast<std::size_t>(steps)]});
    }
    all.push_back({std::move(library), &all_times.library});
    for (Measured& m : all)
        while (m.times * seconds_of(m.action, m.times) < shortest_sample) m.times *= 2;
    for (std::size_t i = 0, of_precision = all.size() / 2; i < of_precision; ++i)
        all[i].times = all[of_precision + i].times =
            std::max(all[i].times, all[of_precision + i].times);
    for (int round = 0; round < repeat; ++round)
        for (Measured& m : all) {
            m.action();  // in the caches is then what it left there itself, not what the one before
                         // did
            m.samples.push_back(seconds_of(m.action, m.times));
        }
    for (Measured& m : all) *m.to = spread_of(m.samples).median;
    return all_times;
}

std::optional<int> steps_needed(Errors const& in_double, Errors const& in_single) {
    if (!in_double.definite || !in_single.definite) return std::nullopt;
    double const enough = 2 * std::max(in_double.error[0], 0x1p-53);
    for (int steps = 0; steps <= most_steps; ++steps)
        if (in_single.error[static_cast<std::size_t>(steps)] <= enough) return steps;
    return std::nullopt;
}

std::string outcome(Errors const& in_double, Errors const& in_single) {
    if (!in_double.definite) return "indefinite in double too";
    if (!in_single.definite) return "indefinite";
    if (auto const steps = steps_needed(in_double, in_single))
        return std::to_string(*steps) + (*steps == 1 ? " step" : " steps");
    double const first = in_single.error.front(), last = in_single.error.back();
    if (!std::isfinite(first) || !std::isfinite(last)) return "not finite";
    return last < first ? "not within 3" : "diverges";
}

}  // namespace catena::precision
