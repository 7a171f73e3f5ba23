// Replacement of openmp_executor.cpp in builds without OpenMP.
#include "error.hpp"
#include "math/executor.hpp"

namespace catena {

bool openmp_is_built() { return false; }

std::unique_ptr<Executor> openmp_executor(int, SimdLevel) {
    throw built_without("OpenMP", "solver.backend: openmp",
                        "build with OpenMP or use the backend segments");
}

}  // namespace catena
