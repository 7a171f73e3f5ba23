// Kinematics of bodies in joint coordinates, compiled for AVX-512.
#include "dca/simd/avx512.hpp"

#include "dynamics/joint/simd/kinematic_loops.hpp"

namespace catena {

KinematicLoops avx512_kinematic_loops(bool positions) {
    return kinematic_loops<dca::avx512::Real>(positions);
}

}  // namespace catena
