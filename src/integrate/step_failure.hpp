// What failed within a step, said with the causes in the order in which they come there.
#pragma once

#include <cstdint>
#include <string>

#include "scene/scene.hpp"

namespace catena {

/// "at step 12: WHAT". `has_started`: the state at the run's start was sound. A matrix that is lost
/// later is a matter of the step first: its length, the stiffest joint spring and a smaller step
/// are named before masses and positions.
std::string failure_in_step(std::int64_t step, std::string const& what, Scene const& scene,
                            bool has_started);

}  // namespace catena
