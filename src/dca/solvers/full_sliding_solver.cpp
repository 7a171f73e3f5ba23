// Handles of all six directions, with joints that translate.
#include "dca/solvers/joint_solver_of.hpp"

namespace catena::dca {

CATENA_JOINT_SOLVER(6, true)

}  // namespace catena::dca
