// Access to the records of shared units number by number, for exchange between ranks; host and
// device.
#pragma once

#include "math/records.hpp"
#include "tree/tree.hpp"

namespace catena::dca {

/// Numbers of records: number i is entry i % width of unit i / width. show() counts the units of
/// this rank, take() those of all ranks.
template <class T>
struct RecordNumbers {
    static constexpr int width = RecordsView<T, Order::plain>::numbers;
    RecordsView<T, Order::plain> records;
    FrontierUnit const *own, *all;
    CATENA_HD double show(std::int64_t i) const {
        return records.number(own[i / width].slot, static_cast<int>(i % width));
    }
    CATENA_HD void take(std::int64_t i, double value) const {
        records.number(all[i / width].slot, static_cast<int>(i % width)) = value;
    }
};

/// Numbers of two records per unit: those of `first`, then those of `second`. Otherwise as
/// RecordNumbers.
template <class A, class B>
struct NumbersOfBoth {
    static constexpr int of_first = RecordNumbers<A>::width,
                         width = of_first + RecordNumbers<B>::width;
    RecordsView<A, Order::plain> first;
    RecordsView<B, Order::plain> second;
    FrontierUnit const *own, *all;
    CATENA_HD double show(std::int64_t i) const {
        return number(own[i / width].slot, static_cast<int>(i % width));
    }
    CATENA_HD void take(std::int64_t i, double value) const {
        number(all[i / width].slot, static_cast<int>(i % width)) = value;
    }

  private:
    CATENA_HD double& number(std::int64_t slot, int n) const {
        return n < of_first ? first.number(slot, n) : second.number(slot, n - of_first);
    }
};

}  // namespace catena::dca
