// How long a step of an explicit integrator may be before the stiffest of the joints' springs makes
// it unstable.
#pragma once

#include <optional>
#include <string>

#include "scene/scene.hpp"

namespace catena {

struct StepLimit {
    double frequency = 0;  // largest angular frequency of the chains with springs at the start
    double step = 0;       // the longest stable step of the scene's integrator
    bool whole = true;     // false: of the first bodies of long chains alone
};

/// By power iteration on the accelerations that small displacements from the start add, in joint
/// coordinates. None where no joint has a spring and where the integrator takes springs implicitly
/// or chooses its own steps. Of a few chains and their first bodies, so that it costs little. On
/// this rank alone, the same on all.
std::optional<StepLimit> estimate_step_limit(Scene const&);

/// "0.435 ps, 2 / the largest frequency of the joints' springs".
std::string text_of(StepLimit const&, Scene const&);

/// Refuses a step beyond the limit by InputError. Returns a note of one that is near it, or beyond
/// the limit of a part of the scene; empty: there is nothing to say.
std::string note_of_step(Scene const&, std::optional<StepLimit> const&);

}  // namespace catena
