// Words of the message that a joint's matrix is not positive definite.
#pragma once

namespace catena::dca {

/// Why, as far as the solver can know. Whoever takes steps puts what comes before it in front.
inline constexpr char const* cause_of_lost_matrix =
    "masses, inertias or positions there are extreme or not finite";

}  // namespace catena::dca
