// Marks for code that host and device share.
#pragma once

#if defined(__CUDACC__)
#define CATENA_HD __host__ __device__ inline
#define CATENA_LAMBDA __device__  // of what a Space runs: [=] CATENA_LAMBDA (std::int64_t k) { ... }
#define CATENA_UNROLL _Pragma("unroll")
#else
#define CATENA_HD inline
#define CATENA_LAMBDA
#define CATENA_UNROLL _Pragma("GCC unroll 8")
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

}  // namespace catena
