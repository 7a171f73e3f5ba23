// Steps of bodies in joint coordinates, compiled for AVX-512.
#include "dca/simd/avx512.hpp"

#include "dynamics/joint/simd/step_loops.hpp"

namespace catena {

StepLoops avx512_step_loops(bool positions) { return step_loops<dca::avx512::Real>(positions); }

}  // namespace catena
