// Marks for code that host and device share.
#pragma once

#include <atomic>
#include <cstdint>

#if defined(__CUDACC__)
#define CATENA_HD __host__ __device__ inline
#define CATENA_HD_IN_PLACE \
    __host__ __device__    \
        __forceinline__  // never called: arrays that it is given may stay in registers
#define CATENA_HD_APART \
    __host__ __device__ \
        __noinline__ inline  // seldom called: it is to cost its callers no registers
#define CATENA_EITHER_SIDE \
    _Pragma("nv_exec_check_disable")  // before a template that calls what its arguments have on one
                                      // side alone
#define CATENA_LAMBDA \
    __device__  // of what a Space runs: [=] CATENA_LAMBDA (std::int64_t k) { ... }
#define CATENA_UNROLL _Pragma("unroll")
#define CATENA_NO_UNROLL _Pragma("unroll 1")
#else
#define CATENA_HD inline
#define CATENA_HD_IN_PLACE inline
#define CATENA_HD_APART [[gnu::noinline]] inline
#define CATENA_EITHER_SIDE
#define CATENA_LAMBDA
#define CATENA_UNROLL _Pragma("GCC unroll 8")
#define CATENA_NO_UNROLL
#endif

namespace catena {

/// a b + c in one rounding where the instruction set has it, in two where it has not: written out,
/// never left to the compiler, so that one source gives the same bits wherever it is inlined.
CATENA_HD double fused(double a, double b, double c) {
#if defined(__FMA__) || defined(__CUDA_ARCH__) || defined(__ARM_FEATURE_FMA)
    return __builtin_fma(a, b, c);
#else
    return a * b + c;
#endif
}
CATENA_HD float fused(float a, float b, float c) {
#if defined(__FMA__) || defined(__CUDA_ARCH__) || defined(__ARM_FEATURE_FMA)
    return __builtin_fmaf(a, b, c);
#else
    return a * b + c;
#endif
}
/// Extended precision and instrumented scalars.
template <class Real>
CATENA_HD Real fused(Real a, Real b, Real c) {
    return a * b + c;
}

/// c - a b in one rounding where `fused` is.
template <class Real>
CATENA_HD Real less_product(Real a, Real b, Real c) {
    return fused(-a, b, c);
}

/// place = min(place, value), for any number of threads at once.
CATENA_HD void lower_to(unsigned long long* place, unsigned long long value) {
#if defined(__CUDA_ARCH__)
    atomicMin(place, value);
#else
    std::atomic_ref<unsigned long long> found(*place);
    unsigned long long before = found.load(std::memory_order_relaxed);
    while (value < before &&
           !found.compare_exchange_weak(before, value, std::memory_order_relaxed)) {
    }
#endif
}

/// The order of bodies in a GPU's arrays: in tiles of `lanes` runs of `steps` bodies, the runs'
/// first bodies next to each other, then their second ones, ..., so that threads that walk along a
/// run each touch whole cache lines together. Of each such row of bodies the first numbers come
/// together, then the second ones, ...: from one number of a body to the next it is `lanes`,
/// whatever the array.
namespace gpu_order {
inline constexpr std::int32_t lanes = 32, steps = 16, tile = lanes * steps;
inline constexpr int bits_of_tile = 9;
static_assert(1 << bits_of_tile == tile);
/// Numbers from one row to the next.
CATENA_HD constexpr std::int64_t pitch(int columns) { return std::int64_t{lanes} * columns; }
/// a b + c. In one instruction on a GPU: nvcc forgets that the factors are short.
CATENA_HD std::int64_t wide_product(std::int32_t a, std::int32_t b, std::int64_t c) {
#if defined(__CUDA_ARCH__)
    std::int64_t sum;
    asm("mad.wide.s32 %0, %1, %2, %3;" : "=l"(sum) : "r"(a), "r"(b), "l"(c));
    return sum;
#else
    return std::int64_t{a} * b + c;
#endif
}
/// Where body k's first number stands in columns of that pitch. What fits is computed in 32 bits.
CATENA_HD std::int64_t first_number(std::int64_t k, std::int64_t pitch) {
    auto const in_tile = static_cast<std::int32_t>(k & (tile - 1)),
               row = static_cast<std::int32_t>(k >> bits_of_tile) * steps + in_tile % steps;
    return wide_product(row, static_cast<std::int32_t>(pitch), in_tile / steps);
}
/// Body i, row by row.
CATENA_HD constexpr std::int64_t body(std::int64_t i) {
    auto const in_tile = static_cast<std::int32_t>(i & (tile - 1));
    return i + ((in_tile % lanes) * steps + in_tile / lanes - in_tile);
}
/// Of whole tiles that hold `bodies`.
CATENA_HD constexpr std::int64_t padded(std::int64_t bodies) {
    return (bodies + tile - 1) / tile * tile;
}
}  // namespace gpu_order

/// Where body k's first number stands in arrays of the processor that runs this, and how far it is
/// to its next one. On the host one body follows the other, and `pitch` is from one number of a
/// body to the next; on a GPU from one row of bodies to the next.
CATENA_HD std::int64_t place_of(std::int64_t k, [[maybe_unused]] std::int64_t pitch) {
#if defined(__CUDA_ARCH__)
    return gpu_order::first_number(k, pitch);
#else
    return k;
#endif
}
CATENA_HD std::int64_t to_next_number([[maybe_unused]] std::int64_t pitch) {
#if defined(__CUDA_ARCH__)
    return gpu_order::lanes;
#else
    return pitch;
#endif
}
/// What is there; the `last` one to take it lets it leave a GPU's caches first.
template <bool last, class Real>
CATENA_HD Real taken_number(Real const* place) {
#if defined(__CUDA_ARCH__)
    if constexpr (last) return __ldcs(place);
#endif
    return *place;
}
/// Leaves there what is not asked for soon: it may leave a GPU's caches first.
template <class Real>
CATENA_HD void leave_number(Real* place, Real const& value) {
#if defined(__CUDA_ARCH__)
    __stcs(place, value);
#else
    *place = value;
#endif
}

}  // namespace catena
