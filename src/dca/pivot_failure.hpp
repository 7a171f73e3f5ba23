// Text of the error message for a joint matrix that is not positive definite.
#pragma once

namespace catena::dca {

/// Cause of the failure as far as the solver can tell. Callers that integrate in time add theirs.
inline constexpr char const* cause_of_lost_matrix =
    "masses, inertias or positions there are extreme or not finite";

}  // namespace catena::dca
