// Memory asked for before its turn comes: a sweep goes along more arrays than a processor foresees
// by itself. Only where caches lack it (asks_ahead()): else asking takes a tenth of the time.
// Functions that do nothing else are inlined by force: GCC thinks them without effect and may leave
// out calls of them.
#pragma once

#include <cstdint>

namespace catena::dca {

inline constexpr int numbers_of_line = 8;  // of a cache

/// Where number `ahead` of an array would be: no array need reach so far. A template, as all that
/// the sources of the instruction sets share (runs.hpp).
template <class Real>
[[gnu::always_inline]] inline void const* place_ahead(double const* array, std::int64_t ahead) {
    auto const offset = static_cast<std::uintptr_t>(ahead) * sizeof(double);
    return __builtin_bit_cast(void const*, reinterpret_cast<std::uintptr_t>(array) + offset);
}

template <class Real>
[[gnu::always_inline]] inline void prefetch(double const* array, std::int64_t ahead) {
    __builtin_prefetch(place_ahead<Real>(array, ahead), 0, 3);
}
template <class Real>
[[gnu::always_inline]] inline void prefetch_to_write(double const* array, std::int64_t ahead) {
    __builtin_prefetch(place_ahead<Real>(array, ahead), 1, 2);
}
/// `count` numbers one after the other, which may begin within a line.
template <class Real>
[[gnu::always_inline]] inline void prefetch(double const* array, std::int64_t ahead,
                                            std::int64_t count) {
    for (std::int64_t n = 0; n < count; n += numbers_of_line) prefetch<Real>(array, ahead + n);
    prefetch<Real>(array, ahead + count - 1);
}
template <class Real>
[[gnu::always_inline]] inline void prefetch_to_write(double const* array, std::int64_t ahead,
                                                     std::int64_t count) {
    for (std::int64_t n = 0; n < count; n += numbers_of_line)
        prefetch_to_write<Real>(array, ahead + n);
    prefetch_to_write<Real>(array, ahead + count - 1);
}

}  // namespace catena::dca
