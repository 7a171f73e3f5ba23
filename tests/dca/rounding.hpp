// What roundings do to a chain: every number of it, and every equation that the local residual looks at, moved by `size`.
#pragma once

#include "dca/oracle/oracle.hpp"

namespace catena::test {

struct Nudged {
    ChainSpec chain;
    oracle::Loads loads;
};
/// The chain's numbers move by up to `size` of themselves; of rigid bodies also the balance of every body by up to `size` of the forces
/// and moments on it, and the closing of every joint by up to `size` of what those add to the accelerations there. A solver whose local
/// residual is r has solved such a chain of size r exactly: r times the growth of its answers, per `size`, is the error to expect.
Nudged nudged(std::uint64_t seed, ChainSpec const&, oracle::Loads const&, oracle::OracleResult<long double> const& exact, double size);

}  // namespace catena::test
