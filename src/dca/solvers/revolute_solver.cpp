// Revolute joints: handles of five directions.
#include "dca/solvers/joint_solver_of.hpp"

namespace catena::dca {

CATENA_JOINT_SOLVER(5, false)

}  // namespace catena::dca
