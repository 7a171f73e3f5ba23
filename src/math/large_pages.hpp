// Memory of long arrays, in large pages where the system has them: a loop goes along dozens of
// arrays at once, more than a processor keeps addresses of small pages for.
#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <type_traits>
#include <vector>

namespace catena {

/// Fresh from the system, which hands out zeros page by page as they are touched. Throws
/// std::bad_alloc.
void* allocate_zeros(std::size_t bytes);
void free_zeros(void* place, std::size_t bytes);

/// For arrays that keep the size they are made with: an element that is given no value is zero, and
/// nobody writes that zero. The threads that first write an array then share the work of getting
/// its pages, and have them near.
template <class T>
struct LargePages {
    using value_type = T;
    static_assert(std::is_trivially_copyable_v<T>);
    static constexpr std::size_t from_bytes = std::size_t{4} << 20;

    LargePages() = default;
    template <class Other>
    LargePages(LargePages<Other> const&) noexcept {}
    T* allocate(std::size_t count) {
        if (is_large(count)) return static_cast<T*>(allocate_zeros(count * sizeof(T)));
        T* const place = std::allocator<T>().allocate(count);
        std::memset(static_cast<void*>(place), 0, count * sizeof(T));
        return place;
    }
    void deallocate(T* place, std::size_t count) {
        if (is_large(count)) return free_zeros(place, count * sizeof(T));
        std::allocator<T>().deallocate(place, count);
    }
    void construct(T*) noexcept {}
    template <class Other>
    bool operator==(LargePages<Other> const&) const noexcept {
        return true;
    }

  private:
    static bool is_large(std::size_t count) { return count * sizeof(T) >= from_bytes; }
};

template <class T>
using LongArray = std::vector<T, LargePages<T>>;

}  // namespace catena
