// Implements the work of a step and its predicted time on many ranks.
#include "plan/step_work.hpp"

#include <cmath>
#include <stdexcept>

#include "dynamics/constrained_step.hpp"
#include "integrate/joint_integrators.hpp"

namespace catena::plan {
namespace {

/// Returns the arrangement with the number of threads that `solver.threads: 0` means.
Arrangement with_threads(Arrangement arrangement, Machine const& machine) {
    bool const alone =
        arrangement.backend == Backend::serial || arrangement.backend == Backend::segments;
    if (alone || arrangement.threads == 0) arrangement.threads = alone ? 1 : machine.threads;
    return arrangement;
}

/// Returns the seconds of the work with the chosen arrangement; throws if it cannot be used.
double seconds_on(Planner& planner, std::vector<Share> const& shares, StepWork const& work,
                  Choice const& choice) {
    Machine const& machine = planner.machine();
    if (choice.arrangement.backend == Backend::cuda_levels) {
        if (!machine.no_gpu.empty()) throw std::runtime_error(machine.no_gpu);
        return work.absolute()
                   ? std::nan("")
                   : work.seconds(
                         planner.predict(shares, planner.plan_levels(shares), choice.levels)
                             .seconds);
    }
    if (work.absolute()) return work.seconds(planner.predict_drifts(shares, choice.arrangement));
    Prediction const found = planner.predict(shares, choice.arrangement);
    if (!found.unusable.empty()) throw std::runtime_error(found.unusable);
    return work.seconds(found.seconds);
}

}  // namespace

double StepWork::seconds(PhaseSeconds const& of) const {
    double sum = 0;
    auto const add = [&](int times, Phase phase) {
        // Parts that the step does not contain may have unknown times.
        if (times > 0) sum += times * of[phase];
    };
    add(evaluations, evaluation);
    add(kinematics, Phase::kinematics);
    add(matrix_sweeps, matrix_sweep);
    add(bias_sweeps, bias_sweep);
    return sum;
}

double StepWork::seconds(DriftSeconds const& of) const {
    return drifts * of[drift] + closings * of[closing] + noises * of[noise];
}

StepWork work_of_step(Scene const& scene, int sweeps) {
    DynamicsSpec const& d = scene.dynamics;
    if (!uses_joint_coordinates(d.integrator)) {
        ConstrainedStep step;
        step.langevin = is_langevin(d.integrator);
        step.sweeps = sweeps;
        return {.drifts = step.drifts(),
                .closings = step.drifts() * sweeps,
                .noises = step.langevin ? 1 : 0};
    }
    bool const tips = has_closures(scene);
    auto const [matrices, biases, closings] = sweeps_a_step(d, tips);
    int const corrections = tips ? closings * (sweeps + 1) : 0,
              refinements = matrices * scene.solver.refine;
    int const evaluations = keeps_matrices(scene) ? 0 : matrices;
    return {evaluations, biases - evaluations + corrections, matrices - evaluations + corrections,
            biases - evaluations + corrections + refinements};
}

StepPrediction predict_step(Planner& planner, Scene const& scene, Axes axes, StepWork const& work,
                            int ranks) {
    std::vector<Share> const shares = shares_of(scene, axes, ranks);
    Choice choice = choose(scene, axes, planner, ranks);
    choice.arrangement = with_threads(choice.arrangement, planner.machine());
    StepPrediction step{ranks, 0, choice.arrangement, std::nan(""), {}};
    for (Share const& share : shares) step.bodies += share.bodies;
    try {
        step.seconds = seconds_on(planner, shares, work, choice);
    } catch (std::exception const& error) {
        if (!uses_gpu(choice.arrangement.backend)) throw;
        // Planner::predict() accepts the same failures.
        step.unusable = error.what();
    }
    return step;
}

}  // namespace catena::plan
