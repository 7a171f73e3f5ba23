// StepLimit: longest time step of an explicit integrator that the stiffest joint spring leaves
// stable.
#pragma once

#include <optional>
#include <string>

#include "scene/scene.hpp"

namespace catena {

/// Stability limit of a scene's time step.
struct StepLimit {
    /// Largest angular frequency at the start, of the chains with springs, 1/time.
    double frequency = 0;
    /// Longest stable step of the scene's integrator.
    double step = 0;
    /// False if only the first bodies of long chains were considered.
    bool whole = true;
};

/// Estimates the limit by power iteration on the accelerations that small displacements from the
/// start add, in joint coordinates. Returns nothing if no joint has a spring, or if the integrator
/// is implicit or adaptive.
/// Only a few chains and their first bodies are considered, so that the cost is small. Computed on
/// this rank alone, with the same result on all.
std::optional<StepLimit> estimate_step_limit(Scene const&);

/// Returns "0.435 ps, 2 / the largest frequency of the joints' springs".
std::string text_of(StepLimit const&, Scene const&);

/// Throws InputError for a step beyond the limit. Returns a note about a step near the limit, or
/// beyond the limit of a part of the scene; else an empty text.
std::string note_of_step(Scene const&, std::optional<StepLimit> const&);

}  // namespace catena
