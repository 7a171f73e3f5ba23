// Macros and primitives for code that host and device share.
#pragma once

#include <atomic>
#include <cstdint>

// CATENA_HD marks functions for host and device.
#if defined(__CUDACC__)
#define CATENA_HD __host__ __device__ inline
#define CATENA_HD_IN_PLACE \
    __host__ __device__    \
        __forceinline__  // forces inlining: arrays passed to the function may stay in registers
#define CATENA_HD_APART \
    __host__ __device__ \
        __noinline__ inline  // forbids inlining: a rare call must not cost its callers registers
#define CATENA_EITHER_SIDE \
    _Pragma("nv_exec_check_disable")  // precedes templates that call functions of their arguments
                                      // which exist on one side (host or device) alone
#define CATENA_LAMBDA \
    __device__  // marks lambdas that a Space runs: [=] CATENA_LAMBDA (std::int64_t k) { ... }
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

/// Returns a b + c with one rounding if the instruction set has a fused operation, else with two.
/// Contraction is written out and never left to the compiler, so that one source gives the same
/// bits wherever it is inlined.
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
/// Overload for extended precision and instrumented scalars.
template <class Real>
CATENA_HD Real fused(Real a, Real b, Real c) {
    return a * b + c;
}

/// Returns c - a b, rounded as fused() is.
template <class Real>
CATENA_HD Real less_product(Real a, Real b, Real c) {
    return fused(-a, b, c);
}

/// Atomically sets *place to the smaller of *place and `value`.
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

/// Order of bodies in a GPU's arrays. Bodies form tiles of `lanes` runs of `steps` bodies. A row of
/// a tile holds the first bodies of its runs, the next row the second bodies, and so on. Threads
/// that each walk along one run therefore access whole cache lines together. A row stores the first
/// number of all its bodies, then the second number, and so on. Consecutive numbers of a body are
/// thus `lanes` apart in every array.
namespace gpu_order {
inline constexpr std::int32_t lanes = 32, steps = 16, tile = lanes * steps;
inline constexpr int bits_of_tile = 9;
static_assert(1 << bits_of_tile == tile);
/// Distance between rows, in numbers, of an array with `columns` numbers per body.
CATENA_HD constexpr std::int64_t pitch(int columns) { return std::int64_t{lanes} * columns; }
/// Returns a b + c. On a GPU this is one instruction; nvcc does not exploit that the factors are 32
/// bits wide.
CATENA_HD std::int64_t wide_product(std::int32_t a, std::int32_t b, std::int64_t c) {
#if defined(__CUDA_ARCH__)
    std::int64_t sum;
    asm("mad.wide.s32 %0, %1, %2, %3;" : "=l"(sum) : "r"(a), "r"(b), "l"(c));
    return sum;
#else
    return std::int64_t{a} * b + c;
#endif
}
/// Index of body k's first number in an array of that pitch. Intermediate values that fit are
/// computed in 32 bits.
CATENA_HD std::int64_t first_number(std::int64_t k, std::int64_t pitch) {
    auto const in_tile = static_cast<std::int32_t>(k & (tile - 1)),
               row = static_cast<std::int32_t>(k >> bits_of_tile) * steps + in_tile % steps;
    return wide_product(row, static_cast<std::int32_t>(pitch), in_tile / steps);
}
/// Returns the body at position i of the storage order, counted row by row.
CATENA_HD constexpr std::int64_t body(std::int64_t i) {
    auto const in_tile = static_cast<std::int32_t>(i & (tile - 1));
    return i + ((in_tile % lanes) * steps + in_tile / lanes - in_tile);
}
/// Number of bodies in the whole tiles that hold `bodies`.
CATENA_HD constexpr std::int64_t padded(std::int64_t bodies) {
    return (bodies + tile - 1) / tile * tile;
}
}  // namespace gpu_order

/// Index of body k's first number in arrays of the processor that runs this code. On the host,
/// bodies are consecutive and `pitch` is the distance between consecutive numbers of a body. On a
/// GPU, `pitch` is the distance between rows of bodies.
CATENA_HD std::int64_t place_of(std::int64_t k, [[maybe_unused]] std::int64_t pitch) {
#if defined(__CUDA_ARCH__)
    return gpu_order::first_number(k, pitch);
#else
    return k;
#endif
}
/// Distance between consecutive numbers of a body in arrays of the processor that runs this code.
CATENA_HD std::int64_t to_next_number([[maybe_unused]] std::int64_t pitch) {
#if defined(__CUDA_ARCH__)
    return gpu_order::lanes;
#else
    return pitch;
#endif
}
/// Returns *place. With `last`, a GPU may evict the value from its caches first.
template <bool last, class Real>
CATENA_HD Real taken_number(Real const* place) {
#if defined(__CUDA_ARCH__)
    if constexpr (last) return __ldcs(place);
#endif
    return *place;
}
/// Sets *place to a value that is not read soon: a GPU may evict it from its caches first.
template <class Real>
CATENA_HD void leave_number(Real* place, Real const& value) {
#if defined(__CUDA_ARCH__)
    __stcs(place, value);
#else
    *place = value;
#endif
}

}  // namespace catena
