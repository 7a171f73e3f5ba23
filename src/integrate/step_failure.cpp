// Message about a failure within a time step.
#include "integrate/step_failure.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "dca/pivot_failure.hpp"

namespace catena {
namespace {

/// Returns " (the stiffest spring, 2000, is that of chain `c`, body 5)"; empty if no joint has a
/// spring.
std::string stiffest_spring(Scene const& scene) {
    double most = 0;
    std::string place;
    for (ChainSpec const& chain : scene.chains) {
        std::vector<Vec3> const& stiffness = chain.bodies.stiffness;
        for (std::size_t k = 0; k < stiffness.size(); ++k) {
            double const own = std::max({stiffness[k][0], stiffness[k][1], stiffness[k][2]});
            if (own <= most) continue;
            most = own;
            place = fmt::format(" (the stiffest spring, {:.6g}, is that of chain `{}`, body {})",
                                own, chain.name, k + 1);
        }
    }
    return place;
}

}  // namespace

std::string failure_in_step(std::int64_t step, std::string const& what, Scene const& scene,
                            bool has_started) {
    std::string text = "at step " + std::to_string(step) + ": " + what;
    std::string const cause = dca::cause_of_lost_matrix;
    auto const at = text.find(cause);
    if (!has_started || at == std::string::npos) return text;
    return text.insert(at, fmt::format("dynamics.step = {:.6g} is too long for the forces and "
                                       "speeds there{}: choose a smaller one; otherwise ",
                                       scene.dynamics.step, stiffest_spring(scene)));
}

}  // namespace catena
