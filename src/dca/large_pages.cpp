#include "dca/large_pages.hpp"

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace catena {
namespace {

constexpr std::size_t page = std::size_t{2} << 20;

/// Where an array begins in its first page. If all began alike, the same body's numbers in dozens of them would fight for one set of a
/// cache. Steps of an odd number of cache lines, through the sets of a small cache and back.
std::size_t next_shift() {
    constexpr std::size_t step = 13 * 64, steps = 64;
    static std::atomic<std::size_t> arrays = 0;
    return step * (arrays.fetch_add(1, std::memory_order_relaxed) % steps);
}

}  // namespace

void* allocate_large(std::size_t bytes) {
    std::size_t const shift = next_shift();
    void* place = nullptr;
    if (::posix_memalign(&place, page, bytes + shift) != 0) throw std::bad_alloc();
#if defined(__linux__)
    static_cast<void>(::madvise(place, bytes + shift, MADV_HUGEPAGE));  // where that is refused, pages are small
#endif
    return static_cast<std::byte*>(place) + shift;
}

void free_large(void* place) {
    auto const shift = reinterpret_cast<std::uintptr_t>(place) % page;
    std::free(static_cast<std::byte*>(place) - shift);
}

}  // namespace catena
