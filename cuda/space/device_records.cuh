// Arrays of records (segments, joints, forces) in a GPU's memory.
#pragma once

#include <vector>

#include "cuda/device/owners.hpp"
#include "math/records.hpp"

namespace catena::cuda {

/// Array of `count` records, initially zero; `order` is their layout (math/records.hpp).
template <class T, dca::Order order>
class DeviceRecords {
  public:
    explicit DeviceRecords(std::int64_t count)
        : numbers_(static_cast<std::size_t>(dca::padded_on_gpu(order, count) *
                                            dca::RecordsView<T, order>::numbers)) {}
    dca::RecordsView<T, order> view() { return {numbers_.data()}; }

  private:
    Buffer<double> numbers_;
};

}  // namespace catena::cuda
