// The steps at which a run checks its constraints, and the check of what integrators refine.
#pragma once

#include <bit>
#include <cstdint>

#include "error.hpp"
#include "integrate/joint_integrators.hpp"

namespace catena {

/// Interval of constraint checks. The constraint error is also checked with every output and
/// checkpoint and at the last step. Further checks follow after 1, 2, 4, ... steps, while bodies
/// that started at rest accelerate.
inline constexpr std::int64_t check_every = 100;

/// True if the constraint error is checked at step n, whatever else happens there.
inline bool is_checked(std::int64_t n) {
    return n % check_every == 0 ||
           (n < check_every && std::has_single_bit(static_cast<std::uint64_t>(n)));
}

/// Throws InputError if the scene asks for refinement that its integrator does not have.
inline void refuse_refinement(Scene const& scene) {
    Integrator const integrator = scene.dynamics.integrator;
    if (scene.solver.refine > 0 && !is_refined(integrator))
        throw InputError(
            "solutions with integrator " + std::string(name_of(integrator)) + " are not refined",
            "solver.refine",
            "leave it out, or use rk4, dormand-prince or velocity-verlet if the "
            "chains allow it");
}

}  // namespace catena
