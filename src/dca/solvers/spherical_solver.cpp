// Planar, spherical and universal joints: handles of two, three and four directions.
#include "dca/solvers/joint_solver_of.hpp"

namespace catena::dca {

CATENA_JOINT_SOLVER(2, false)
CATENA_JOINT_SOLVER(3, false)
CATENA_JOINT_SOLVER(4, false)

}  // namespace catena::dca
