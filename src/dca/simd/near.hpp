// Memory asked for before its turn comes: a sweep goes along more arrays than a processor foresees by itself. Not into the nearest cache,
// which the work of the moment fills.
#pragma once

#include <cstdint>

namespace catena::dca {

inline constexpr int numbers_of_line = 8;  // of a cache

/// A template, as all that the sources of the instruction sets share (runs.hpp).
template <class Real>
void ask_for(double const* place) {
    __builtin_prefetch(place, 0, 2);
}
template <class Real>
void ask_to_write(double* place) {
    __builtin_prefetch(place, 1, 2);
}
/// `count` numbers one after the other.
template <class Real>
void ask_for(double const* first, std::int64_t count) {
    for (std::int64_t n = 0; n < count; n += numbers_of_line) ask_for<Real>(first + n);
}
template <class Real>
void ask_to_write(double* first, std::int64_t count) {
    for (std::int64_t n = 0; n < count; n += numbers_of_line) ask_to_write<Real>(first + n);
}

}  // namespace catena::dca
