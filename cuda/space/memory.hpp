// GPU memory that a group of chains needs. The estimate works without a GPU: the objects of a run
// are constructed with a Space that only counts memory.
#pragma once

#include <cstdint>
#include <string>

#include "chain/chain_group.hpp"
#include "error.hpp"

namespace catena::cuda {

/// Amounts of GPU memory, bytes.
struct DeviceMemory {
    std::int64_t bytes = 0;  // permanent: as long as the group exists
    /// Largest temporary memory, bytes, while a field is copied to or from the GPU.
    std::int64_t transient = 0;
    int allocations = 0;
    std::int64_t sum() const { return bytes + transient; }
    DeviceMemory& operator+=(DeviceMemory const& other);
};

/// Returns the memory that this rank's part of the group needs with backend cuda or cuda-levels.
/// Collective.
DeviceMemory memory_needed(ChainGroup const&, Scene const&, Backend, Communicator const&);

/// True if a GPU keeps a single tile for all bodies of a constant field. That is so if the bodies
/// are alike and more numerous than one tile holds.
template <int D>
bool one_tile_serves(Field<D> const& field) {
    return field.size() > gpu_order::tile && field.alike();
}

/// Error: the GPU's memory cannot hold the scene. If the user did not request the GPU, the next
/// backend is tried.
class TooLittleMemory : public InputError {
  public:
    TooLittleMemory(std::string const& what, std::string const& where, std::string const& remedy)
        : InputError(what, where, remedy), reason_(what) {}
    std::string const& reason() const { return reason_; }

  private:
    std::string reason_;
};

/// Returns an empty string if `needed` bytes are free, else "2.5 GiB of GPU memory are needed and
/// 1.0 GiB are free".
std::string too_little_memory(std::int64_t needed, std::int64_t free);

}  // namespace catena::cuda
