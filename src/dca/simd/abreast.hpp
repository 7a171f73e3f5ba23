// As many bodies as a vector has lanes, one after the other, as a place (dca/places.hpp): their numbers stand next to each other.
#pragma once

#include "dca/places.hpp"

namespace catena::dca {

template <class Real_>
struct Abreast {
    using Real = Real_;
    std::int64_t first = 0;
    friend Abreast operator+(Abreast a, int by) { return {a.first + by}; }
    friend Abreast operator-(Abreast a, int by) { return {a.first - by}; }
};

template <class T, int D, class Real>
Real read(FieldView<T, D> const& view, Abreast<Real> const& bodies, int component) {
    return Real::load_anywhere(view.origin + component * view.pitch + bodies.first);
}
template <class T, int D, class Real>
Vector<Real, D> read(FieldView<T, D> const& view, Abreast<Real> const& bodies) {
    Vector<Real, D> v;
    CATENA_UNROLL
    for (int i = 0; i < D; ++i) v[i] = read(view, bodies, i);
    return v;
}
template <int D, class Real>
void write(View<D> const& view, Abreast<Real> const& bodies, Vector<Real, D> const& value) {
    CATENA_UNROLL
    for (int i = 0; i < D; ++i) value[i].store_anywhere(view.origin + i * view.pitch + bodies.first);
}
template <int K, class Real>
void write_directions(DirectionsView const& view, Abreast<Real> const& bodies, Vector<Real, K> const& value) {
    write(View<K>{view.origin, view.pitch, 0}, bodies, value);
}
/// Every body's record of N numbers, `index` of it.
template <int N, class Real>
Vector<Real, N> pick(double const* records, std::int32_t const* index, Abreast<Real> const& bodies, Vector<Real, N> v) {
    std::int64_t at[Real::lanes];
    for (int j = 0; j < Real::lanes; ++j) at[j] = std::int64_t{N} * index[bodies.first + j];
    for (int i = 0; i < N; ++i) v[i] = Real::pick(records + i, at);
    return v;
}

}  // namespace catena::dca
