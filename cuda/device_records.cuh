// Records on a GPU.
#pragma once

#include <vector>

#include "cuda/owners.hpp"
#include "dca/records.hpp"

namespace catena::cuda {

/// Zero at first.
template <class T, dca::Order order>
class DeviceRecords {
  public:
    explicit DeviceRecords(std::int64_t count)
        : pitch_(order == dca::Order::by_body ? gpu_order::padded(count) : (count + 31) / 32 * 32),
          numbers_(static_cast<std::size_t>(pitch_ * dca::RecordsView<T, order>::numbers)) {}
    dca::RecordsView<T, order> view() { return {numbers_.data(), pitch_}; }

  private:
    std::int64_t pitch_;
    Buffer<double> numbers_;
};

}  // namespace catena::cuda
