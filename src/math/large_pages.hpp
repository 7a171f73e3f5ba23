// Memory of long arrays, in large pages if the system has them. A loop accesses dozens of arrays at
// once, more than the address translation buffer of a processor holds small pages for.
#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <type_traits>
#include <vector>

namespace catena {

/// Allocates memory fresh from the system, which supplies zeroed pages at the first access. Throws
/// std::bad_alloc.
void* allocate_zeros(std::size_t bytes);
/// Frees memory of allocate_zeros(). `bytes` is the size passed to it.
void free_zeros(void* place, std::size_t bytes);

/// Allocator for arrays of constant size. Elements without an initial value are zero, but the
/// allocator does not write that zero. The threads that first write an array therefore share the
/// page faults and get the pages in their own memory (first touch).
template <class T>
struct LargePages {
    using value_type = T;
    static_assert(std::is_trivially_copyable_v<T>);
    /// Size of the smallest array in large pages, bytes.
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
    /// Leaves the element unwritten: the memory is already zero.
    void construct(T*) noexcept {}
    template <class Other>
    bool operator==(LargePages<Other> const&) const noexcept {
        return true;
    }

  private:
    static bool is_large(std::size_t count) { return count * sizeof(T) >= from_bytes; }
};

/// Vector of constant size whose memory lies in large pages if it is long.
template <class T>
using LongArray = std::vector<T, LargePages<T>>;

}  // namespace catena
