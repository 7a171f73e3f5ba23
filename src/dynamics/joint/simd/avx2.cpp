// Loops of bodies in joint coordinates, compiled for AVX2.
#include "dca/simd/avx2.hpp"

#include "dynamics/joint/simd/loops.hpp"

namespace catena {

JointLoops avx2_joint_loops(bool positions) { return joint_loops<dca::avx2::Real>(positions); }

}  // namespace catena
