// Perturbation of a chain as by rounding: every number of it, and every equation that the local
// residual measures, is changed slightly.
#pragma once

#include "oracle/oracle.hpp"

namespace catena {

/// Returns the chain with every number changed by up to `size` of itself (rotations by angles up to
/// `size`). The resulting change of the accelerations, divided by `size`, is the problem's own
/// growth of errors. No solver can reach an error below growth x eps.
ChainSpec perturbed(std::uint64_t seed, ChainSpec chain, double size);

/// A perturbed chain with perturbed loads.
struct Nudged {
    ChainSpec chain;
    oracle::Loads loads;
};
/// Perturbs the chain's numbers by up to `size` of themselves.
/// For beads and bodies on joints, it also perturbs the balance of forces of each by up to `size`
/// of the forces and moments on it. The closing of every joint is perturbed by up to `size` of what
/// those add to the accelerations there.
/// A solver whose local residual is r has solved exactly such a chain of size r. The error to
/// expect is r times the change of the accelerations per `size`.
Nudged nudged(std::uint64_t seed, ChainSpec const&, oracle::Loads const&,
              oracle::OracleResult<long double> const& exact, double size);

}  // namespace catena
