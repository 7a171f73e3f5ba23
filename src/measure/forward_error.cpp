// Estimates of the forward error by one more step of refinement.
#include "measure/forward_error.hpp"

#include <algorithm>

#include "scene/freedom.hpp"

namespace catena {
namespace {

// limit of automatic refinement steps
constexpr int most_steps = 4;

bool in_joint_coordinates(ChainSpec const& chain) { return chain.bodies.size() > 0; }

/// Refines by one step and returns the relative change.
double next_correction(ChainSystem& system) {
    system.refine();
    return system.correction();
}

}  // namespace

ForwardError forward_error(ChainSystem& system, std::function<void()> const& look) {
    look();
    if (system.joint().empty() ||
        system.scene().bodies() > most_estimated * system.communicator().size())
        return {};
    ForwardError found{next_correction(system)};
    if (system.scene().solver.handles != Handles::articulated ||
        system.scene().bodies() > most_estimated)
        return found;
    while (found.steps < most_steps && *found.estimate > refined_beyond) {
        look();  // called with the solution of the step before
        ++found.steps;
        double const before = *found.estimate;
        found.estimate = next_correction(system);
        if (!(*found.estimate < before / 2)) break;
    }
    return found;
}

std::optional<double> forward_error_at_start(Scene const& scene, Communicator const& communicator) {
    bool const any = std::any_of(scene.chains.begin(), scene.chains.end(), in_joint_coordinates);
    if (!any || !uses_joint_coordinates(scene.dynamics.integrator) ||
        scene.bodies() > most_estimated_of_run * communicator.size())
        return std::nullopt;
    Scene start = scene;
    start.forces.openmm.reset();
    start.dynamics.fixman = false;
    start.solver.backend = Backend::segments;
    ChainSystem system(start, Axes::joint, communicator);
    system.close_tips();
    system.evaluate();
    for (int i = 0; i < start.solver.refine; ++i) system.refine();
    return next_correction(system);
}

bool takes_articulated_handles(Scene const& scene) {
    return std::all_of(scene.chains.begin(), scene.chains.end(), [](ChainSpec const& chain) {
        return !in_joint_coordinates(chain) || scene::takes_articulated_handles(chain);
    });
}

std::string remedy_of_forward_error(Scene const& scene, bool is_refined, RefineHint const& words) {
    std::string remedy = is_refined ? words.refine : "";
    if (scene.solver.handles == Handles::articulated || !takes_articulated_handles(scene))
        return remedy;
    return remedy + (remedy.empty() ? "" : " or ") + words.handles;
}

}  // namespace catena
