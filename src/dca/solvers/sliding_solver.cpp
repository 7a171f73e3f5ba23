// Joints that translate: handles of five directions that mix force and torque.
#include "dca/solvers/joint_solver_of.hpp"

namespace catena::dca {

CATENA_JOINT_SOLVER(5, true)

}  // namespace catena::dca
