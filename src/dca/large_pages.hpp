// Memory of long arrays, in large pages where the system has them: a loop goes along dozens of arrays at once, more than a processor
// keeps addresses of small pages for.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace catena {

/// Throws std::bad_alloc.
void* allocate_large(std::size_t bytes);
void free_large(void* place);

template <class T>
struct LargePages {
    using value_type = T;
    static constexpr std::size_t from_bytes = std::size_t{4} << 20;

    LargePages() = default;
    template <class Other>
    LargePages(LargePages<Other> const&) noexcept {}
    T* allocate(std::size_t count) {
        if (count * sizeof(T) < from_bytes) return std::allocator<T>().allocate(count);
        return static_cast<T*>(allocate_large(count * sizeof(T)));
    }
    void deallocate(T* place, std::size_t count) {
        if (count * sizeof(T) < from_bytes) return std::allocator<T>().deallocate(place, count);
        free_large(place);
    }
    template <class Other>
    bool operator==(LargePages<Other> const&) const noexcept {
        return true;
    }
};

template <class T>
using LongArray = std::vector<T, LargePages<T>>;

}  // namespace catena
