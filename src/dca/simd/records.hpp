// Records (math/records.hpp) of as many places as a vector has lanes, a number of all of them in
// each vector.
#pragma once

#include "dca/simd/prefetch.hpp"
#include "math/records.hpp"

namespace catena::dca {

/// Of a record's numbers: unrolled as a whole, so that they need not lie in memory before.
#define CATENA_UNROLL_RECORD _Pragma("GCC unroll 128")

/// Vectors one after the other.
template <class Real, class Record>
void store_vectors(double* to, Record const& record) {
    auto const* const values = reinterpret_cast<Real const*>(&record);
    CATENA_UNROLL_RECORD
    for (int n = 0; n < static_cast<int>(sizeof(Record) / sizeof(Real)); ++n)
        values[n].store(to + n * Real::lanes);
}
template <class Real, class Record>
void load_vectors(double const* from, Record& record) {
    auto* const values = reinterpret_cast<Real*>(&record);
    CATENA_UNROLL_RECORD
    for (int n = 0; n < static_cast<int>(sizeof(Record) / sizeof(Real)); ++n)
        values[n] = Real::load(from + n * Real::lanes);
}

/// In the lanes whose bits are set `yes`, of all vectors.
template <class Real, class Record>
void choose(unsigned lanes, Record const& yes, Record& all) {
    auto const* const from = reinterpret_cast<Real const*>(&yes);
    auto* const to = reinterpret_cast<Real*>(&all);
    CATENA_UNROLL_RECORD
    for (int n = 0; n < static_cast<int>(sizeof(Record) / sizeof(Real)); ++n)
        to[n] = Real::choose(lanes, from[n], to[n]);
}

/// action(n) for numbers n to n + 3, which together are all of `count`; some twice where they are
/// not a multiple of four.
template <int count, class Action>
void by_four(Action const& action) {
    static_assert(count >= 4);
    for (int n = 0; n + 4 <= count; n += 4) action(n);
    if constexpr (count % 4 != 0) action(count - 4);
}
template <class Real, class Record, class OfOne, Order order>
void scatter(Record const& record, RecordsView<OfOne, order> to, std::int64_t const* index) {
    constexpr int count = RecordsView<OfOne, order>::numbers, lanes = Real::lanes;
    static_assert(sizeof(Record) == count * sizeof(Real));
    alignas(64) double values[count * lanes];
    store_vectors<Real>(values, record);
    std::int64_t at[lanes];
    for (int j = 0; j < lanes; ++j) at[j] = index[j] * count;
    if constexpr (count >= 4)
        by_four<count>([&](int n) { Real::write_four(values + n * lanes, to.origin + n, at); });
    else
        for (int j = 0; j < lanes; ++j)
            for (int n = 0; n < count; ++n) to.origin[at[j] + n] = values[n * lanes + j];
}
template <class Real, class Record, class OfOne, Order order>
void gather(RecordsView<OfOne, order> from, std::int64_t const* index, Record& record) {
    constexpr int count = RecordsView<OfOne, order>::numbers, lanes = Real::lanes;
    static_assert(sizeof(Record) == count * sizeof(Real));
    std::int64_t at[lanes];
    for (int j = 0; j < lanes; ++j) at[j] = index[j] * count;
    alignas(64) double values[count * lanes];
    if constexpr (count >= 4)
        by_four<count>([&](int n) { Real::read_four(from.origin + n, at, values + n * lanes); });
    else
        for (int n = 0; n < count; ++n) Real::pick(from.origin + n, at).store(values + n * lanes);
    load_vectors<Real>(values, record);
}

/// Of as many places as a vector has lanes.
template <class Real, class OfOne, Order order>
[[gnu::always_inline]] inline void prefetch_records(RecordsView<OfOne, order> from,
                                                    std::int64_t const* index) {
    constexpr int count = RecordsView<OfOne, order>::numbers;
    for (int j = 0; j < Real::lanes; ++j) prefetch<Real>(from.origin, index[j] * count, count);
}

}  // namespace catena::dca
