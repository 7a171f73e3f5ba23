// Access to the records (math/records.hpp) of as many places as a vector has lanes. Each vector
// holds one number of all these places.
#pragma once

#include "dca/simd/prefetch.hpp"
#include "math/records.hpp"

namespace catena::dca {

/// Unrolls a loop over the numbers of a record completely, so that they need not be stored in
/// memory first.
#define CATENA_UNROLL_RECORD _Pragma("GCC unroll 128")

/// Writes the vectors of a record one after the other. `to` must be aligned for vectors.
template <class Real, class Record>
void store_vectors(double* to, Record const& record) {
    auto const* const values = reinterpret_cast<Real const*>(&record);
    CATENA_UNROLL_RECORD
    for (int n = 0; n < static_cast<int>(sizeof(Record) / sizeof(Real)); ++n)
        values[n].store(to + n * Real::lanes);
}
/// Reads the vectors of a record that store_vectors() wrote.
template <class Real, class Record>
void load_vectors(double const* from, Record& record) {
    auto* const values = reinterpret_cast<Real*>(&record);
    CATENA_UNROLL_RECORD
    for (int n = 0; n < static_cast<int>(sizeof(Record) / sizeof(Real)); ++n)
        values[n] = Real::load(from + n * Real::lanes);
}

/// Replaces all vectors of `all` by those of `yes` in the lanes whose bits are set.
template <class Real, class Record>
void choose(unsigned lanes, Record const& yes, Record& all) {
    auto const* const from = reinterpret_cast<Real const*>(&yes);
    auto* const to = reinterpret_cast<Real*>(&all);
    CATENA_UNROLL_RECORD
    for (int n = 0; n < static_cast<int>(sizeof(Record) / sizeof(Real)); ++n)
        to[n] = Real::choose(lanes, from[n], to[n]);
}

/// Calls action(n) for the numbers n to n + 3, until all `count` numbers are covered. Some are
/// covered twice if `count` is not a multiple of four.
template <int count, class Action>
void by_four(Action const& action) {
    static_assert(count >= 4);
    for (int n = 0; n + 4 <= count; n += 4) action(n);
    if constexpr (count % 4 != 0) action(count - 4);
}
/// Writes the records of the lanes: that of lane j to record index[j].
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
/// Reads the records of the lanes: record index[j] into lane j.
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

/// Prefetches record index[j] of every lane j.
template <class Real, class OfOne, Order order>
[[gnu::always_inline]] inline void prefetch_records(RecordsView<OfOne, order> from,
                                                    std::int64_t const* index) {
    constexpr int count = RecordsView<OfOne, order>::numbers;
    for (int j = 0; j < Real::lanes; ++j) prefetch<Real>(from.origin, index[j] * count, count);
}

}  // namespace catena::dca
