// Marks for code that host and device share.
#pragma once

#include <atomic>
#include <cstdint>

#if defined(__CUDACC__)
#define CATENA_HD __host__ __device__ inline
#define CATENA_HD_IN_PLACE __host__ __device__ __forceinline__   // never called: arrays that it is given may stay in registers
#define CATENA_HD_APART __host__ __device__ __noinline__ inline  // seldom called: it is to cost its callers no registers
#define CATENA_EITHER_SIDE _Pragma("nv_exec_check_disable")      // before a template that calls what its arguments have on one side alone
#define CATENA_LAMBDA __device__                                 // of what a Space runs: [=] CATENA_LAMBDA (std::int64_t k) { ... }
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

/// a b + c in one rounding where the instruction set has it, in two where it has not: written out, never left to the
/// compiler, so that one source gives the same bits wherever it is inlined.
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
    while (value < before && !found.compare_exchange_weak(before, value, std::memory_order_relaxed)) {
    }
#endif
}

/// The order of bodies in a GPU's arrays: in tiles of `lanes` runs of `steps` bodies, the runs' first bodies next to each other, then
/// their second ones, ..., so that threads that walk along a run each touch whole cache lines together.
namespace gpu_order {
inline constexpr std::int32_t lanes = 32, steps = 16, tile = lanes * steps;
CATENA_HD constexpr std::int64_t place(std::int64_t k) {
    auto const in_tile = static_cast<std::int32_t>(k & (tile - 1));  // what fits is computed in 32 bits
    return k + ((in_tile % steps) * lanes + in_tile / steps - in_tile);
}
CATENA_HD constexpr std::int64_t body(std::int64_t place) {
    auto const in_tile = static_cast<std::int32_t>(place & (tile - 1));
    return place + ((in_tile % lanes) * steps + in_tile / lanes - in_tile);
}
/// Of whole tiles that hold `bodies`.
CATENA_HD constexpr std::int64_t padded(std::int64_t bodies) { return (bodies + tile - 1) / tile * tile; }
}  // namespace gpu_order

/// Where body k stands in arrays of the processor that runs this: on the host one body follows the other.
CATENA_HD std::int64_t place_of(std::int64_t k) {
#if defined(__CUDA_ARCH__)
    return gpu_order::place(k);
#else
    return k;
#endif
}

}  // namespace catena
