// Records of doubles (segments, eliminated joints, directions), one per slot, and their memory
// layout. Records are consecutive on the host; a GPU stores them like fields.
#pragma once

#include "math/linear.hpp"

namespace catena::dca {

/// Returns one of two records, selected number by number without a branch.
template <class T>
CATENA_HD T either(bool first, T const& a, T const& b) {
    constexpr int numbers = static_cast<int>(sizeof(T) / sizeof(double));
    auto chosen = __builtin_bit_cast(Vector<double, numbers>, a);
    auto const other = __builtin_bit_cast(Vector<double, numbers>, b);
    CATENA_UNROLL
    for (int n = 0; n < numbers; ++n) chosen[n] = first ? chosen[n] : other[n];
    return __builtin_bit_cast(T, chosen);
}

/// Order of records in a GPU's memory. by_body: in the tiles of fields (gpu_order). plain:
/// consecutive records in rows of gpu_order::lanes.
enum class Order { by_body, plain };

/// Number of records for which a GPU allocates memory to hold `count`: whole rows or tiles.
inline std::int64_t padded_on_gpu(Order order, std::int64_t count) {
    return order == Order::by_body
               ? gpu_order::padded(count)
               : (count + gpu_order::lanes - 1) / gpu_order::lanes * gpu_order::lanes;
}

/// Non-owning view of records in the memory of the processor that runs this code.
template <class T, Order order>
struct RecordsView {
    static constexpr int numbers = static_cast<int>(sizeof(T) / sizeof(double));
    using Numbers = Vector<double, numbers>;
    double* origin = nullptr;

    /// Number n of record i, by reference.
    CATENA_HD double& number(std::int64_t i, int n) const {
#if defined(__CUDA_ARCH__)
        return on_gpu(i)[n * gpu_order::lanes];
#else
        return origin[i * numbers + n];
#endif
    }
    /// Returns record i.
    CATENA_HD T load(std::int64_t i) const { return taken<false>(i); }
    /// Returns record i and lets a GPU evict it from its caches first (see FieldView::load_last()).
    CATENA_HD T load_last(std::int64_t i) const { return taken<true>(i); }
    CATENA_HD void store(std::int64_t i, T const& record) const {
#if defined(__CUDA_ARCH__)
        double* const first = on_gpu(i);
        auto const values = __builtin_bit_cast(Numbers, record);
        CATENA_UNROLL
        for (int n = 0; n < numbers; ++n) first[n * gpu_order::lanes] = values[n];
#else
        reinterpret_cast<T*>(origin)[i] = record;
#endif
    }

  private:
    template <bool last>
    CATENA_HD T taken(std::int64_t i) const {
#if defined(__CUDA_ARCH__)
        double const* const first = on_gpu(i);
        Numbers values;
        CATENA_UNROLL
        for (int n = 0; n < numbers; ++n)
            values[n] = taken_number<last>(first + n * gpu_order::lanes);
        return __builtin_bit_cast(T, values);
#else
        return reinterpret_cast<T const*>(origin)[i];
#endif
    }
    /// Address of number 0 of record i in a GPU's memory.
    CATENA_HD double* on_gpu(std::int64_t i) const {
        constexpr std::int64_t pitch = gpu_order::pitch(numbers);
        if constexpr (order == Order::by_body) return origin + gpu_order::first_number(i, pitch);
        return origin + (i / gpu_order::lanes * pitch + i % gpu_order::lanes);
    }
};

}  // namespace catena::dca
