// Estimates the forward error of accelerations, which a small residual does not bound: for light
// bodies between heavy ones, solutions of nearly the same equations differ. The estimate is the
// change due to one more step of refinement.
#pragma once

#include <functional>
#include <optional>

#include "integrate/chain_system.hpp"

namespace catena {

/// Limits of the error relative to the largest acceleration. Beyond `largest_forward_error` a
/// result is not valid. Beyond `refined_beyond`, results of articulated handles, which promise
/// more, are refined automatically.
inline constexpr double largest_forward_error = 1e-6, refined_beyond = 1e-10;
/// Largest number of bodies per rank for which the error is estimated, for one solution and for a
/// run's start. Automatic refinement is limited to `most_estimated` bodies of the whole scene. It
/// must not depend on the number of ranks, because results are bitwise independent of it.
inline constexpr std::int64_t most_estimated = 2000000, most_estimated_of_run = 100000;

/// Result of forward_error().
struct ForwardError {
    /// Relative error. Absent for beads and linked bodies, which are not refined, and for very many
    /// bodies.
    std::optional<double> estimate;
    /// Number of refinement steps beyond those that the scene asks for.
    int steps = 0;
    bool is_small() const { return !estimate || *estimate <= largest_forward_error; }
};
/// Estimates the error of the system's last evaluation and refinement; `look` is called when the
/// system holds that solution. With articulated handles it refines further as long as that helps,
/// and calls `look` again for each new solution. Afterwards the system holds one refinement step
/// more. Collective.
ForwardError forward_error(ChainSystem&, std::function<void()> const& look);

/// Estimates the error of the accelerations in joint coordinates at the start of a run of the
/// scene, without OpenMM's forces. Absent in the cases given above, and if the integrator has
/// absolute coordinates. Collective.
std::optional<double> forward_error_at_start(Scene const&, Communicator const&);

/// True if articulated handles support all chains that are refined at all.
bool takes_articulated_handles(Scene const&);

/// Texts of the remedies: more refinement, and articulated handles.
struct RefineHint {
    char const *refine, *handles;
};
/// Returns the text of the remedy for a large error; empty if nothing helps. `is_refined`: true if
/// refinement is a remedy.
std::string remedy_of_forward_error(Scene const&, bool is_refined, RefineHint const&);

}  // namespace catena
