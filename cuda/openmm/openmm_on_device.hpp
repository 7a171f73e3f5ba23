// What the module that knows OpenMM's CUDA platform gives to the library. The module is a shared
// library of its own, loaded where there is a driver: libOpenMMCUDA.so, which it needs, asks for
// one.
#pragma once

#include <cstdint>
#include <vector>

namespace OpenMM {
class Context;
}

namespace catena::cuda {

/// Addresses on the GPU (neighbours/device_beads.hpp says what is there). They last as long as the
/// Context.
struct OpenMmArrays {
    void *position = nullptr, *correction = nullptr;
    bool double_precision = false;
    void* force = nullptr;
    std::int64_t places = 0;
    void* stream = nullptr;  // that OpenMM computes on
};

class OpenMmOnDevice {
  public:
    virtual ~OpenMmOnDevice() = default;
    /// OpenMM's CUcontext becomes the thread's, or false; the destructor gives the thread back the
    /// one it had.
    virtual bool make_current() noexcept = 0;
    virtual OpenMmArrays arrays() = 0;
    /// Lets OpenMM bring particles that are near each other together: the particle that stands at
    /// each place from now on. `positions`: x, y, z of each particle.
    virtual std::vector<int> const& order(std::vector<double> const& positions) = 0;
    /// Forces at the positions of its arrays. Returns once its neighbour list stands, maybe before
    /// the forces do.
    virtual void compute() = 0;

    /// From now on compute() finds the forces of these groups (bits) alone, and among pairs those
    /// of part `part` of `parts`; -1, 0 and 1: all. Before the first compute(), as keep_list()
    /// wants it. Precondition: the module says that it is to be had.
    virtual void share(int groups, int part, int parts) = 0;
    /// The next compute() makes its neighbour list anew: of pairs whose first block of 32 places is
    /// from `begin` to `end` > `begin` of the row of all, whose ends are 0 and 1. Whoever computes
    /// the others needs the same order and does so at the same evaluation.
    virtual void make_list(double begin, double end) = 0;
    /// From now on compute(), and whatever else OpenMM computes of its Context, takes the list that
    /// there is, and does not look for what has moved. Until make_list().
    virtual void keep_list() = 0;
    /// How far particles may move until their list is to be made anew, nm.
    virtual double list_lasts() = 0;
    /// How many tiles of 32 by 32 pairs the list has, pairs by themselves as their part of one; 0
    /// of all pairs: OpenMM keeps none of so few particles, and keep_list() must not be called.
    /// Waits for it.
    virtual double tiles() = 0;
};

inline constexpr char const* module_file = "libcatena_openmm_cuda.so";
inline constexpr char const* module_entry = "catena_openmm_on_device";
inline constexpr char const* module_shares_pairs = "catena_openmm_shares_pairs";
using ModuleEntry = OpenMmOnDevice* (*)(OpenMM::Context&);  // the caller owns what it returns
using ModuleSharesPairs = bool (*)();  // whether OpenMmOnDevice::share() is to be had

}  // namespace catena::cuda
