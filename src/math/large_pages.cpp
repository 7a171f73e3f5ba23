// Allocation of zeroed memory in 2 MiB pages (Linux), with staggered start addresses.
#include "math/large_pages.hpp"

#include <cstdlib>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>

#include <atomic>
#include <cstdint>
#endif

namespace catena {

#if defined(__linux__)
namespace {

/// Size of a large page, bytes.
constexpr std::size_t page = std::size_t{2} << 20;

/// Offset of the next array from its first page, bytes. Equal offsets would map one body's numbers
/// in dozens of arrays to one cache set. Offsets are multiples of an odd number of cache lines;
/// after 64 arrays they repeat.
std::size_t next_shift() {
    constexpr std::size_t step = 13 * 64, steps = 64;
    static std::atomic<std::size_t> arrays = 0;
    return step * (arrays.fetch_add(1, std::memory_order_relaxed) % steps);
}

/// Returns `bytes`, rounded up to whole large pages.
std::size_t whole_pages(std::size_t bytes) { return (bytes + page - 1) / page * page; }

}  // namespace

void* allocate_zeros(std::size_t bytes) {
    std::size_t const shift = next_shift(), length = whole_pages(shift + bytes);
    void* const found =
        ::mmap(nullptr, length + page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (found == MAP_FAILED) throw std::bad_alloc();
    std::size_t const before = whole_pages(reinterpret_cast<std::uintptr_t>(found)) -
                               reinterpret_cast<std::uintptr_t>(found);
    std::byte* const begin = static_cast<std::byte*>(found) + before;
    if (before > 0) ::munmap(found, before);
    ::munmap(begin + length, page - before);
    // If the kernel refuses the advice, pages stay small.
    static_cast<void>(::madvise(begin, length, MADV_HUGEPAGE));
    return begin + shift;
}

void free_zeros(void* place, std::size_t bytes) {
    std::size_t const shift = reinterpret_cast<std::uintptr_t>(place) % page;
    ::munmap(static_cast<std::byte*>(place) - shift, whole_pages(shift + bytes));
}
#else
void* allocate_zeros(std::size_t bytes) {
    void* const place = std::calloc(bytes, 1);
    if (!place) throw std::bad_alloc();
    return place;
}

void free_zeros(void* place, std::size_t /*bytes*/) { std::free(place); }
#endif

}  // namespace catena
