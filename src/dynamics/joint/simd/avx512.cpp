// Loops of bodies in joint coordinates, compiled for AVX-512.
#include "dca/simd/avx512.hpp"

#include "dynamics/joint/simd/loops.hpp"

namespace catena {

JointLoops avx512_joint_loops(bool positions) { return joint_loops<dca::avx512::Real>(positions); }

}  // namespace catena
