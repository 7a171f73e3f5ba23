#pragma once

#include <cstring>
#include <vector>

namespace catena::test {

/// Unlike ==, tells the signs of zeros apart. T has no padding.
template <class T>
bool same_bits(std::vector<T> const& a, std::vector<T> const& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

}  // namespace catena::test
