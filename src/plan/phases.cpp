// Implements the timing of the phases of an evaluation.
#include "plan/phases.hpp"

#include <algorithm>
#include <limits>

#include "measure/timing.hpp"

namespace catena::plan {
namespace {

/// Times one evaluation phase by phase, waiting for the end of each, and then one evaluation as a
/// whole.
PhaseSeconds time_once(ChainSystem& system) {
    PhaseSeconds spent{};
    double last = seconds_now();
    auto const to = [&](Phase phase) {
        system.wait();
        double const moment = seconds_now();
        spent[phase] += moment - last;
        last = moment;
    };
    for (AbsoluteDynamics* group : system.absolute()) {
        group->update_configuration();
        group->set_simple_forces();
    }
    for (JointDynamics* group : system.joint()) group->update_configuration();
    to(kinematics);
    for (AbsoluteDynamics* group : system.absolute()) group->assemble_matrices();
    for (JointDynamics* group : system.joint()) group->assemble_matrices();
    to(matrix_sweep);
    for (AbsoluteDynamics* group : system.absolute()) group->evaluate();
    for (JointDynamics* group : system.joint()) group->solve();
    to(bias_sweep);
    for (JointDynamics* group : system.joint()) group->set_rates();
    to(kinematics);
    system.evaluate(false);
    to(evaluation);
    return spent;
}

}  // namespace

std::string Arrangement::name() const {
    std::string const text = name_of(backend);
    return threads == 1 && backend != Backend::openmp
               ? text
               : text + ", " + std::to_string(threads) + (threads == 1 ? " thread" : " threads");
}

Scene arranged(Scene scene, Arrangement const& arrangement) {
    scene.solver.backend = arrangement.backend;
    scene.solver.threads = arrangement.threads;
    return scene;
}

PhaseSeconds measure_phases(ChainSystem& system, Effort const& effort) {
    Communicator const& communicator = system.communicator();
    // The first evaluation projects velocities in absolute coordinates once.
    system.evaluate();
    PhaseSeconds least;
    least.fill(std::numeric_limits<double>::infinity());
    std::vector<double> evaluations;
    double const start = seconds_now();
    for (int i = 0; i < effort.most; ++i) {
        bool const enough = i >= effort.least && seconds_now() - start > effort.seconds;
        if (communicator.max(enough ? 1 : 0) > 0) break;
        communicator.barrier();
        PhaseSeconds const once = time_once(system);
        for (std::size_t p = 0; p < phases; ++p)
            least[p] = std::min(least[p], communicator.max(once[p]));
        evaluations.push_back(communicator.max(once[evaluation]));
    }
    least[typical_evaluation] = spread_of(evaluations).median;
    return least;
}

}  // namespace catena::plan
