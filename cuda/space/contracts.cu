// Asserts that the Space of a GPU has what its concept requires.
#include "cuda/space/device_space.cuh"
#include "dca/contracts.hpp"

namespace catena::cuda {

static_assert(dca::SolverSpace<DeviceSpace>);

}  // namespace catena::cuda
