// Kinematics of bodies in joint coordinates, compiled for AVX2.
#include "dca/simd/avx2.hpp"

#include "dynamics/joint/simd/kinematic_loops.hpp"

namespace catena {

KinematicLoops avx2_kinematic_loops(bool positions) {
    return kinematic_loops<dca::avx2::Real>(positions);
}

}  // namespace catena
