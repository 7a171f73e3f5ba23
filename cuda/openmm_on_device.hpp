// What the module that knows OpenMM's CUDA platform gives to the library. The module is a shared library of its own, loaded where there is
// a driver: libOpenMMCUDA.so, which it needs, asks for one.
#pragma once

#include <cstdint>
#include <vector>

namespace OpenMM {
class Context;
}

namespace catena::cuda {

/// Addresses on the GPU (force/device_beads.hpp says what is there). They last as long as the Context.
struct OpenMmArrays {
    void *position = nullptr, *correction = nullptr;
    bool double_precision = false;
    void const* force = nullptr;
    std::int64_t places = 0;
    void* stream = nullptr;  // that OpenMM computes on
};

class OpenMmOnDevice {
  public:
    virtual ~OpenMmOnDevice() = default;
    /// OpenMM's CUcontext becomes the thread's, or false; the destructor gives the thread back the one it had.
    virtual bool make_current() noexcept = 0;
    virtual OpenMmArrays arrays() = 0;
    /// Lets OpenMM bring particles that are near each other together: the particle that stands at each place from now on. `positions`:
    /// x, y, z of each particle.
    virtual std::vector<int> const& order(std::vector<double> const& positions) = 0;
    /// Forces at the positions of its arrays. Returns once its neighbour list stands, maybe before the forces do.
    virtual void compute() = 0;
};

inline constexpr char const* module_file = "libcatena_openmm_cuda.so";
inline constexpr char const* module_entry = "catena_openmm_on_device";
using ModuleEntry = OpenMmOnDevice* (*)(OpenMM::Context&);  // the caller owns what it returns

}  // namespace catena::cuda
