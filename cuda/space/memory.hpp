// How much memory a GPU must have for a group of chains. Known without a GPU: the objects that
// would be there are made of memory that is only counted.
#pragma once

#include <cstdint>
#include <string>

#include "chain/chain_group.hpp"
#include "error.hpp"

namespace catena::cuda {

struct DeviceMemory {
    std::int64_t bytes = 0;      // for as long as the group is there
    std::int64_t transient = 0;  // at most, while a field comes or goes
    int allocations = 0;
    std::int64_t sum() const { return bytes + transient; }
    DeviceMemory& operator+=(DeviceMemory const& other);
};

/// Of this rank, with cuda or cuda-levels. Collective.
DeviceMemory memory_needed(ChainGroup const&, Scene const&, Backend, Communicator const&);

/// Whether a GPU keeps one tile for all bodies of a field that never changes: they are alike, and
/// more than fit one.
template <int D>
bool one_tile_serves(Field<D> const& field) {
    return field.size() > gpu_order::tile && field.alike();
}

/// The GPU cannot hold the scene. Where nobody asked for it, the next choice may.
class TooLittleMemory : public InputError {
  public:
    TooLittleMemory(std::string const& what, std::string const& where, std::string const& remedy)
        : InputError(what, where, remedy), reason_(what) {}
    std::string const& reason() const { return reason_; }

  private:
    std::string reason_;
};

/// Empty where it is enough, else "2.5 GiB of GPU memory are needed and 1.0 GiB are free".
std::string too_little_memory(std::int64_t needed, std::int64_t free);

}  // namespace catena::cuda
