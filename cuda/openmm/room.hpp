// Memory of the GPU or pinned memory that grows.
#pragma once

#include <cstddef>
#include <memory>

namespace catena::cuda {

/// Memory that is reallocated with 1/8 more than requested if a request exceeds it.
template <class Owner>
class Room {
  public:
    Owner& of(std::size_t count) {
        if (!owner_ || capacity_ < count) {
            owner_.reset();
            capacity_ = count + count / 8;
            owner_ = std::make_unique<Owner>(capacity_);
        }
        return *owner_;
    }
    Owner& operator*() const { return *owner_; }

  private:
    std::unique_ptr<Owner> owner_;
    std::size_t capacity_ = 0;
};

}  // namespace catena::cuda
