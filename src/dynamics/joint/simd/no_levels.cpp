#include "dynamics/joint/joint_lanes.hpp"

namespace catena {

JointLoops avx2_joint_loops(bool) { return {}; }
JointLoops avx512_joint_loops(bool) { return {}; }

}  // namespace catena
