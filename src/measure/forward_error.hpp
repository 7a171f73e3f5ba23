// How far accelerations may be off, which a small residual does not say: where light bodies hang
// between heavy ones, solutions of nearly the same equations differ. Estimated by what one more
// step of refinement changes.
#pragma once

#include <functional>
#include <optional>

#include "integrate/chain_system.hpp"

namespace catena {

/// Of the largest acceleration. Beyond `largest_forward_error` an answer is not valid; beyond
/// `refined_beyond` articulated handles, which promise more, are refined on their own.
inline constexpr double largest_forward_error = 1e-6, refined_beyond = 1e-10;
/// Bodies a rank up to which the error is estimated: of a solution, and of a run's start. Only
/// scenes of no more bodies in all are refined unasked: whether they are must not depend on the
/// number of ranks, as the bits do not.
inline constexpr std::int64_t most_estimated = 2000000, most_estimated_of_run = 100000;

struct ForwardError {
    std::optional<double> estimate;  // none: of beads and linked bodies, which are not refined, and
                                     // of very many bodies
    int steps = 0;                   // of refinement beyond those that the scene asks for
    bool is_small() const { return !estimate || *estimate <= largest_forward_error; }
};
/// Of what the system was evaluated and refined to last, at which `look` is called. Articulated
/// handles are refined further while that helps, and `look` is called again. Afterwards the system
/// holds one step more. Collective.
ForwardError forward_error(ChainSystem&, std::function<void()> const& look);

/// Of the accelerations in joint coordinates where a run of the scene starts, OpenMM's forces left
/// out; none as above. Collective.
std::optional<double> forward_error_at_start(Scene const&, Communicator const&);

/// Whether articulated handles hold all chains that are refined at all.
bool takes_articulated_handles(Scene const&);

/// What to write against a large error where `refine` steps were taken already; empty where nothing
/// helps.
struct RefineHint {
    char const *refine, *handles;
};
std::string remedy_of_forward_error(Scene const&, bool is_refined, RefineHint const&);

}  // namespace catena
