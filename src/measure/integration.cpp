// Integration of a scene without output files.
#include "measure/integration.hpp"

#include <nlohmann/json.hpp>

#include "observe/observables.hpp"

namespace catena {
namespace {

constexpr double constraint_tolerance = 1e-13;

/// Returns the scene with the study's integrator and step.
Scene with(Scene scene, Stepping const& stepping) {
    DynamicsSpec& d = scene.dynamics;
    d.given = true;
    d.integrator = stepping.integrator;
    d.step = stepping.step;
    d.tolerance = stepping.tolerance;
    d.friction = 0;
    d.constraint_tolerance = constraint_tolerance;
    if (!is_refined(d.integrator)) scene.solver.refine = 0;
    // Absolute coordinates and implicit joints do not support articulated handles.
    if (!uses_joint_coordinates(d.integrator) || is_implicit(d.integrator))
        if (scene.solver.handles == Handles::articulated) scene.solver.handles = Handles::projected;
    return scene;
}

}  // namespace

Trajectory::Trajectory(Scene scene, Communicator const& communicator, Stepping const& stepping)
    : scene_(with(std::move(scene), stepping)),
      system_(scene_, uses_joint_coordinates(stepping.integrator) ? Axes::joint : Axes::world,
              communicator, is_implicit(stepping.integrator) ? stepping.step : 0.0),
      stepper_(make_stepper(system_, scene_.dynamics)) {
    stepper_->prepare(nullptr);
}

void Trajectory::run(std::int64_t steps) {
    for (std::int64_t i = 0; i < steps; ++i) {
        stepper_->step(done_++, nullptr);
        stepper_->prepare(nullptr);
    }
    system_.wait();
}

SceneMotion Trajectory::snapshot() {
    stepper_->observe({});
    return system_.snapshot();
}

Trajectory::Energy Trajectory::energy() {
    stepper_->observe({.energies = true});
    Energy e;
    e.total = e.kinetic = kinetic_energy(scene_, system_.snapshot());
    for (EnergyTerm const& term : system_.potential_energy()) e.total += term.value;
    return e;
}

Trajectory::InnerSteps Trajectory::inner_steps() const {
    nlohmann::json const counts = stepper_->inner_steps();
    if (counts.is_null()) return {};
    return {counts.at("taken").get<std::int64_t>(), counts.at("rejected").get<std::int64_t>()};
}

}  // namespace catena
