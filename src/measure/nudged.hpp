// What roundings do to a chain: every number of it, and every equation that the local residual
// looks at, moved by a little.
#pragma once

#include "oracle/oracle.hpp"

namespace catena {

/// The chain with every number moved by up to `size` of itself (rotations by angles up to `size`).
/// What the accelerations change by, over `size`, is the problem's own growth of errors: no solver
/// can be asked for less than growth x eps.
ChainSpec perturbed(std::uint64_t seed, ChainSpec chain, double size);

struct Nudged {
    ChainSpec chain;
    oracle::Loads loads;
};
/// The chain's numbers move by up to `size` of themselves; of beads and of bodies on joints also
/// the balance of each by up to `size` of the forces and moments on it, and the closing of every
/// joint by up to `size` of what those add to the accelerations there. A solver whose local
/// residual is r has solved such a chain of size r exactly: r times the growth of its answers, per
/// `size`, is the error to expect.
Nudged nudged(std::uint64_t seed, ChainSpec const&, oracle::Loads const&,
              oracle::OracleResult<long double> const& exact, double size);

}  // namespace catena
