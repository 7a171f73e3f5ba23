// A place (dca/lane_access.hpp) that stands for consecutive bodies, as many as a vector has lanes.
// Their numbers are next to each other in the arrays.
#pragma once

#include "dca/lane_access.hpp"
#include "dca/simd/prefetch.hpp"

namespace catena::dca {

/// The bodies [first, first + lanes). `prefetches`: reads and writes also prefetch.
template <class Real_>
struct Abreast {
    using Real = Real_;
    std::int64_t first = 0;
    bool prefetches = false;
    friend Abreast operator+(Abreast a, int by) { return {a.first + by, a.prefetches}; }
    friend Abreast operator-(Abreast a, int by) { return {a.first - by, a.prefetches}; }
};

/// Prefetch distance of loops over the bodies, in bodies.
inline constexpr int ahead_of_bodies = 64;

/// Reads one number of the bodies.
template <class T, int D, class Real>
Real read(FieldView<T, D> const& view, Abreast<Real> const& bodies, int component) {
    auto const* const place = view.origin + component * view.pitch + bodies.first;
    if (bodies.prefetches) prefetch<Real>(place, ahead_of_bodies);
    return Real::load_anywhere(place);
}
/// Reads D numbers of the bodies.
template <class T, int D, class Real>
Vector<Real, D> read(FieldView<T, D> const& view, Abreast<Real> const& bodies) {
    Vector<Real, D> v;
    CATENA_UNROLL
    for (int i = 0; i < D; ++i) v[i] = read(view, bodies, i);
    return v;
}
/// Writes D numbers of the bodies.
template <int D, class Real>
void write(View<D> const& view, Abreast<Real> const& bodies, Vector<Real, D> const& value) {
    CATENA_UNROLL
    for (int i = 0; i < D; ++i) {
        double* const place = view.origin + i * view.pitch + bodies.first;
        if (bodies.prefetches) prefetch_to_write<Real>(place, ahead_of_bodies);
        value[i].store_anywhere(place);
    }
}
template <int K, class Real>
void write_directions(DirectionsView const& view, Abreast<Real> const& bodies,
                      Vector<Real, K> const& value) {
    write(View<K>{view.origin, view.pitch, 0}, bodies, value);
}
/// Returns the first N numbers of every body's record; body k has record index[k], and records are
/// `apart` numbers apart. Bodies with the same record are contiguous.
template <int apart, int N, class Real>
Vector<Real, N> pick(double const* records, std::int32_t const* index, Abreast<Real> const& bodies,
                     Vector<Real, N> v) {
    if (index[bodies.first] == index[bodies.first + Real::lanes - 1]) {
        for (int i = 0; i < N; ++i)
            v[i] = Real(records[std::int64_t{apart} * index[bodies.first] + i]);
        return v;
    }
    std::int64_t at[Real::lanes];
    for (int j = 0; j < Real::lanes; ++j) at[j] = std::int64_t{apart} * index[bodies.first + j];
    for (int i = 0; i < N; ++i) v[i] = Real::pick(records + i, at);
    return v;
}

}  // namespace catena::dca
