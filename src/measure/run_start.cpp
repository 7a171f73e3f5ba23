// Implements what a run looks at before its first step.
#include "measure/run_start.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>

#include "error.hpp"
#include "integrate/chain_system.hpp"
#include "integrate/checked_steps.hpp"
#include "integrate/joint_integrators.hpp"
#include "integrate/step_limit.hpp"
#include "measure/forward_error.hpp"
#include "scene/branch_limits.hpp"

namespace catena {
namespace {

/// Estimates the error of the first accelerations. Refines articulated handles if they need it. For
/// other handles, and if refinement is impossible, a note states the possible error. Collective.
void look_at_forward_error(Scene& scene, Communicator const& communicator) {
    if (!scene.dynamics.given) return;
    std::optional<double> const error = forward_error_at_start(scene, communicator);
    bool const refinable = is_refined(scene.dynamics.integrator);
    bool const few = scene.bodies() <= most_estimated_of_run;
    bool const unasked = refinable && few && scene.solver.handles == Handles::articulated &&
                         scene.solver.refine == 0;
    if (!error || *error <= (unasked ? refined_beyond : largest_forward_error)) return;
    std::string const found = fmt::format(
        "the first accelerations may have errors of {:.1e}, relative to the largest", *error);
    if (unasked) {
        scene.solver.refine = 2;
        return scene.note(found + ": every solution is refined by two steps (solver.refine)");
    }
    std::string const remedy = remedy_of_forward_error(
        scene, refinable,
        {scene.solver.refine < 2 ? "solver.refine: 2" : "a larger solver.refine",
         "solver.handles: articulated"});
    scene.note(found + (remedy.empty() ? "" : ": use " + remedy));
}

}  // namespace

void refuse_before_run(Scene const& scene, Communicator const& communicator) {
    choose_backend(scene, communicator);
    choose_threads(scene, communicator);
    choose_simd_level(scene, communicator);
    scene::refuse_unsupported_branches(scene);
    if (!scene.dynamics.given) return;
    refuse_refinement(scene);
    Integrator const integrator = scene.dynamics.integrator;
    if (scene.solver.handles == Handles::articulated &&
        (!uses_joint_coordinates(integrator) || is_implicit(integrator)))
        throw InputError(
            fmt::format("articulated handles with integrator {}", name_of(integrator)),
            scene.file + ": solver.handles",
            "use integrator rk4, dormand-prince or velocity-verlet, or handles projected or full");
}

void look_before_run(Scene& scene, Communicator const& communicator) {
    refuse_before_run(scene, communicator);
    look_at_forward_error(scene, communicator);
    if (std::string const note = note_of_step(scene, estimate_step_limit(scene)); !note.empty())
        scene.note(note);
}

}  // namespace catena
