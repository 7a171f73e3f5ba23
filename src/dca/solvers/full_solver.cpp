// Handles of all six directions.
#include "dca/solvers/joint_solver_of.hpp"

namespace catena::dca {

CATENA_JOINT_SOLVER(6, false)

}  // namespace catena::dca
