// Steps of bodies in joint coordinates, compiled for AVX2.
#include "dca/simd/avx2.hpp"

#include "dynamics/joint/simd/step_loops.hpp"

namespace catena {

StepLoops avx2_step_loops(bool positions) { return step_loops<dca::avx2::Real>(positions); }

}  // namespace catena
