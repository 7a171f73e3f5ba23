// Interface between the library and the module that knows OpenMM's CUDA platform. The module is a
// shared library of its own and is loaded only if there is a driver. It links libOpenMMCUDA.so,
// which cannot be loaded without a driver.
#pragma once

#include <cstdint>
#include <vector>

namespace OpenMM {
class Context;
}

namespace catena::cuda {

/// Addresses of OpenMM's arrays on the GPU, valid as long as the Context. Their layout is described
/// in neighbours/device_beads.hpp.
struct OpenMmArrays {
    /// Positions, and the rounding error of each position in mixed precision (otherwise null).
    void *position = nullptr, *correction = nullptr;
    bool double_precision = false;
    /// Forces, fixed point with 2^-32 kJ/mol/nm: x of every place, then y, then z.
    void* force = nullptr;
    /// Number of places, padded to whole blocks.
    std::int64_t places = 0;
    void* stream = nullptr;  // stream on which OpenMM computes
};

/// OpenMM's CUDA platform for one Context.
class OpenMmOnDevice {
  public:
    virtual ~OpenMmOnDevice() = default;
    /// Makes OpenMM's CUcontext current in this thread; returns false if that fails. The destructor
    /// restores the context that was current before.
    virtual bool make_current() noexcept = 0;
    /// Lets arrays() and compute() use a stream of this Context's own, if this OpenMM has such
    /// streams. OpenMM's other functions continue to use the default stream: callers must put both
    /// in order. OpenMM's CUcontext must be current.
    virtual void take_own_stream() = 0;
    /// Returns the current addresses.
    virtual OpenMmArrays arrays() = 0;
    /// Lets OpenMM reorder its particles so that neighbours in space are neighbours in its arrays.
    /// `positions`: x, y, z of each particle, nm. Returns the particle at each place.
    virtual std::vector<int> const& order(std::vector<double> const& positions) = 0;
    /// Computes forces at the positions in OpenMM's arrays. The call returns when the neighbour
    /// list is complete, possibly before the forces are.
    virtual void compute() = 0;

    /// Restricts compute() to the forces of `groups` (a bit mask), and among pairs to part `part`
    /// of `parts`. Values -1, 0 and 1 mean everything. The call must precede the first compute();
    /// keep_list() requires it. Precondition: the module supports it (ModuleSharesPairs).
    virtual void share(int groups, int part, int parts) = 0;
    /// Makes the next compute() rebuild its neighbour list. The list holds pairs whose first block
    /// of 32 places lies from `begin` to `end` > `begin`, as fractions of all blocks. Ranks that
    /// compute the other pairs need the same order and must rebuild at the same evaluation.
    virtual void make_list(double begin, double end) = 0;
    /// Keeps the present list until make_list(): compute() and other computations of the Context
    /// use it. OpenMM then does not check how far particles have moved.
    virtual void keep_list() = 0;
    /// Returns the distance, nm, that particles may move before their list must be rebuilt.
    virtual double list_lasts() = 0;
    /// Returns the number of tiles of 32 by 32 pairs in the list; single pairs count as fractions
    /// of a tile. The result is 0 if OpenMM keeps no list, because particles are few; keep_list()
    /// must not be called then. The call waits for the list.
    virtual double tiles() = 0;
};

inline constexpr char const* module_file = "libcatena_openmm_cuda.so";
inline constexpr char const* module_entry = "catena_openmm_on_device";
inline constexpr char const* module_shares_pairs = "catena_openmm_shares_pairs";
using ModuleEntry = OpenMmOnDevice* (*)(OpenMM::Context&);  // the caller owns the result
using ModuleSharesPairs = bool (*)();                       // true if share() is available

}  // namespace catena::cuda
