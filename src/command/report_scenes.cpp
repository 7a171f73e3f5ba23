// Implements the choice of scenes for `catena report`.
#include "command/report_scenes.hpp"

#include "bench/generated.hpp"
#include "force/openmm_force.hpp"
#include "measure/integrator_errors.hpp"

namespace catena::command {

ReportScenes generated_report(ReportRequest const& request) {
    ReportScenes scenes;
    auto const overrides = overrides_of(request);
    for (char const* const joint : {"link", "spherical", "revolute"})
        for (int const bodies : {16, 256, 4096})
            if (!request.quick || bodies < 4096)
                scenes.solver.push_back(random_scene(joint, bodies, overrides));
    scenes.solver.push_back(coil_scene(256, overrides));
    scenes.time = 0.5;
    for (char const* const joint : {"revolute", "spherical", "mixed", "link"})
        scenes.integrators.push_back(swinging_scene(joint, overrides));
    scenes.slow.push_back(elastic_scene(overrides));
    if (!request.quick)
        for (char const* const joint : {"spherical", "link"})
            scenes.drift.push_back(swinging_scene(joint, overrides));
    if (!openmm_platforms().empty())
        for (std::int64_t const beads : {140, 2800})
            if (!request.quick || beads == 140)
                scenes.forces.push_back(condensate_scene(beads, overrides));
    return scenes;
}

ReportScenes sorted_for_report(std::vector<Scene> all) {
    ReportScenes scenes;
    for (Scene& scene : all) {
        std::string const why = scene.dynamics.given ? why_integrators_cannot_be_compared(scene)
                                                     : "it has no `dynamics`";
        if (why.empty())
            scenes.integrators.push_back(scene);
        else
            scenes.left_out.push_back("integrators of " + scene.file + ": " + why);
        if (scene.forces.openmm) scenes.forces.push_back(scene);
        scenes.solver.push_back(std::move(scene));
    }
    return scenes;
}

}  // namespace catena::command
