// Accelerations of a scene by the oracles, in the layout of a Solution, so that both can be
// compared number by number.
#pragma once

#include "measure/solution.hpp"
#include "oracle/oracle.hpp"

namespace catena {

/// Returns the loads on chain `chain` of the scene. `bead_force`: OpenMM's forces on all beads;
/// empty if there are none.
oracle::Loads oracle_loads(Scene const&, std::size_t chain, std::vector<Vec3> const& bead_force);

/// Returns the joint accelerations of one chain, in the layout of Solution::acceleration.
template <class Scalar>
std::vector<double> joint_accelerations(ChainSpec const&, oracle::OracleResult<Scalar> const&);

/// Returns the joint accelerations of all chains by the articulated-body algorithm, in the layout
/// of Solution::acceleration.
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
