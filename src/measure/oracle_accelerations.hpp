// What the oracles say of a scene, laid out as a Solution, so that both can be compared number by
// number.
#pragma once

#include "measure/solution.hpp"
#include "oracle/oracle.hpp"

namespace catena {

/// What acts on chain `chain` of the scene. `bead_force`: OpenMM's, of all beads; empty: none.
oracle::Loads oracle_loads(Scene const&, std::size_t chain, std::vector<Vec3> const& bead_force);

/// Joint accelerations of one chain.
template <class Scalar>
std::vector<double> joint_accelerations(ChainSpec const&, oracle::OracleResult<Scalar> const&);

/// Joint accelerations of all chains by articulated bodies, in the layout of
/// Solution::acceleration.
template <class Scalar>
std::vector<double> oracle_accelerations(Scene const&, std::vector<Vec3> const& bead_force);

#define CATENA_ORACLE(Scalar)                                                      \
    extern template std::vector<double> joint_accelerations<Scalar>(               \
        ChainSpec const&, oracle::OracleResult<Scalar> const&);                    \
    extern template std::vector<double> oracle_accelerations<Scalar>(Scene const&, \
                                                                     std::vector<Vec3> const&);
CATENA_ORACLE(double)
CATENA_ORACLE(long double)
CATENA_ORACLE(oracle::Quad)
#undef CATENA_ORACLE

}  // namespace catena
