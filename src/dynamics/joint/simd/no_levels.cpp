// Stubs for builds without AVX2 and AVX-512: empty tables of loops.
#include "dynamics/joint/joint_lanes.hpp"

namespace catena {

JointLoops avx2_joint_loops(bool) { return {}; }
JointLoops avx512_joint_loops(bool) { return {}; }

}  // namespace catena
