// Lists and records on a GPU.
#pragma once

#include <vector>

#include "cuda/owners.hpp"
#include "dca/records.hpp"

namespace catena::cuda {

/// Lists of items level by level (HostSpace::Levels).
template <class T>
class DeviceLevels {
  public:
    explicit DeviceLevels(std::vector<std::vector<T>> const& levels) : offset_{0} {
        std::vector<T> all;
        for (std::vector<T> const& level : levels) {
            all.insert(all.end(), level.begin(), level.end());
            offset_.push_back(std::ssize(all));
        }
        items_ = Buffer<T>(all);
        device_offset_ = Buffer<std::int64_t>(offset_);
    }
    int count() const { return static_cast<int>(offset_.size()) - 1; }
    std::int64_t size(int level) const { return offset_[level + 1] - offset_[level]; }
    T const* begin(int level) const { return items_.data() + offset_[level]; }
    T const* items() const { return items_.data(); }
    std::int64_t const* offset() const { return device_offset_.data(); }

  private:
    std::vector<std::int64_t> offset_;
    Buffer<T> items_;
    Buffer<std::int64_t> device_offset_;
};
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
