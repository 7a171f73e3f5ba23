// Stubs for builds without AVX2 and AVX-512: empty tables of loops.
#include "dynamics/joint/joint_lanes.hpp"

namespace catena {

KinematicLoops avx2_kinematic_loops(bool) { return {}; }
KinematicLoops avx512_kinematic_loops(bool) { return {}; }
StepLoops avx2_step_loops(bool) { return {}; }
StepLoops avx512_step_loops(bool) { return {}; }

}  // namespace catena
