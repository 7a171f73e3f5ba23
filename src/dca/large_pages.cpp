#include "dca/large_pages.hpp"

#include <cstdlib>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace catena {

void* allocate_large(std::size_t bytes) {
    constexpr std::size_t page = std::size_t{2} << 20;
    void* place = nullptr;
    if (::posix_memalign(&place, page, bytes) != 0) throw std::bad_alloc();
#if defined(__linux__)
    static_cast<void>(::madvise(place, bytes, MADV_HUGEPAGE));  // where that is refused, pages are small
#endif
    return place;
}

void free_large(void* place) { std::free(place); }

}  // namespace catena
