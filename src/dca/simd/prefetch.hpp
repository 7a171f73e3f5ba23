// Prefetch of data that a sweep will need: it streams through more arrays than the hardware
// prefetcher follows. It is used only for data that do not stay in the caches (prefetches());
// otherwise it costs a tenth of the time.
//
// Functions that only prefetch are force-inlined: GCC considers them free of effects and may drop
// calls of them.
#pragma once

#include <cstdint>

namespace catena::dca {

inline constexpr int numbers_of_line = 8;  // Doubles per cache line.

/// Returns the address of number `ahead` of an array, which may lie outside it. A template, as
/// everything that the sources of the instruction sets share (runs.hpp).
template <class Real>
[[gnu::always_inline]] inline void const* place_ahead(double const* array, std::int64_t ahead) {
    auto const offset = static_cast<std::uintptr_t>(ahead) * sizeof(double);
    return __builtin_bit_cast(void const*, reinterpret_cast<std::uintptr_t>(array) + offset);
}

/// Prefetches the cache line of number `ahead` for reading.
template <class Real>
[[gnu::always_inline]] inline void prefetch(double const* array, std::int64_t ahead) {
    __builtin_prefetch(place_ahead<Real>(array, ahead), 0, 3);
}
/// Prefetches the cache line of number `ahead` for writing.
template <class Real>
[[gnu::always_inline]] inline void prefetch_to_write(double const* array, std::int64_t ahead) {
    __builtin_prefetch(place_ahead<Real>(array, ahead), 1, 2);
}
/// Prefetches `count` consecutive numbers, which need not begin at a cache line, for reading.
template <class Real>
[[gnu::always_inline]] inline void prefetch(double const* array, std::int64_t ahead,
                                            std::int64_t count) {
    for (std::int64_t n = 0; n < count; n += numbers_of_line) prefetch<Real>(array, ahead + n);
    prefetch<Real>(array, ahead + count - 1);
}
/// Prefetches `count` consecutive numbers for writing.
template <class Real>
[[gnu::always_inline]] inline void prefetch_to_write(double const* array, std::int64_t ahead,
                                                     std::int64_t count) {
    for (std::int64_t n = 0; n < count; n += numbers_of_line)
        prefetch_to_write<Real>(array, ahead + n);
    prefetch_to_write<Real>(array, ahead + count - 1);
}

}  // namespace catena::dca
