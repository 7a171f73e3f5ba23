// Message about a failure within a time step, with its possible causes in order of likelihood.
#pragma once

#include <cstdint>
#include <string>

#include "scene/scene.hpp"

namespace catena {

/// Returns "at step 12: WHAT". `has_started`: true if the state at the run's start was sound. A
/// pivot failure after that is most likely due to the step. The text then names the step's length,
/// the stiffest joint spring and a smaller step before masses and positions.
std::string failure_in_step(std::int64_t step, std::string const& what, Scene const& scene,
                            bool has_started);

}  // namespace catena
