// Records of doubles (segments, eliminated joints, directions), one for each of many places, and how they lie in memory: one record
// after the other on the host, a number of all records after the other on a GPU.
#pragma once

#include "dca/linear.hpp"

namespace catena::dca {

enum class Order { by_body, plain };  // by_body: as fields (place_of)

/// Of memory of the processor that runs this.
template <class T, Order order>
struct RecordsView {
    static constexpr int numbers = static_cast<int>(sizeof(T) / sizeof(double));
    using Numbers = Vector<double, numbers>;
    double* origin = nullptr;
    std::int64_t pitch = 0;  // from one number to the next, where they are apart

    CATENA_HD double& number(std::int64_t i, int n) const {
#if defined(__CUDA_ARCH__)
        return origin[(order == Order::by_body ? place_of(i) : i) + n * pitch];
#else
        return origin[i * numbers + n];
#endif
    }
    CATENA_HD T load(std::int64_t i) const {
#if defined(__CUDA_ARCH__)
        double const* const first = origin + (order == Order::by_body ? place_of(i) : i);
        Numbers values;
        CATENA_UNROLL
        for (int n = 0; n < numbers; ++n) values[n] = first[n * pitch];
        return __builtin_bit_cast(T, values);
#else
        return reinterpret_cast<T const*>(origin)[i];
#endif
    }
    CATENA_HD void store(std::int64_t i, T const& record) const {
#if defined(__CUDA_ARCH__)
        double* const first = origin + (order == Order::by_body ? place_of(i) : i);
        auto const values = __builtin_bit_cast(Numbers, record);
        CATENA_UNROLL
        for (int n = 0; n < numbers; ++n) first[n * pitch] = values[n];
#else
        reinterpret_cast<T*>(origin)[i] = record;
#endif
    }
};

}  // namespace catena::dca
