// Eight single-precision numbers side by side; the doubles are the library's.
#pragma once

#include "dca/simd/avx2.hpp"
#include "tests/bench/precision/numbers.hpp"

namespace catena::dca::avx2 {

class Single {
  public:
    using Number = float;
    static constexpr int lanes = 8;
    Single() = default;
    Single(float x) : v_(_mm256_set1_ps(x)) {}
    static Single load_anywhere(float const* place) { return Single(_mm256_loadu_ps(place)); }
    void store_anywhere(float* place) const { _mm256_storeu_ps(place, v_); }
    unsigned not_positive() const {
        __m256 const zero = _mm256_setzero_ps();
        __m256 const good = _mm256_and_ps(_mm256_cmp_ps(v_, zero, _CMP_GT_OQ),
                                          _mm256_cmp_ps(v_ - v_, zero, _CMP_EQ_OQ));
        return 0xffU & ~static_cast<unsigned>(_mm256_movemask_ps(good));
    }
    friend Single operator+(Single a, Single b) { return Single(a.v_ + b.v_); }
    friend Single operator-(Single a, Single b) { return Single(a.v_ - b.v_); }
    friend Single operator*(Single a, Single b) { return Single(a.v_ * b.v_); }
    friend Single operator/(Single a, Single b) { return Single(a.v_ / b.v_); }
    friend Single operator-(Single a) { return Single(-a.v_); }
    friend Single fused(Single a, Single b, Single c) {
        return Single(_mm256_fmadd_ps(a.v_, b.v_, c.v_));
    }
    friend Single less_product(Single a, Single b, Single c) {
        return Single(_mm256_fnmadd_ps(a.v_, b.v_, c.v_));
    }
    friend precision::Twice<Real> convert(Single a, precision::Twice<Real> const*) {
        alignas(32) double numbers[lanes];
        _mm256_store_pd(numbers, _mm256_cvtps_pd(_mm256_castps256_ps128(a.v_)));
        _mm256_store_pd(numbers + 4, _mm256_cvtps_pd(_mm256_extractf128_ps(a.v_, 1)));
        return precision::Twice<Real>::load_anywhere(numbers);
    }
    friend Single convert(precision::Twice<Real> const& a, Single const*) {
        alignas(32) double numbers[lanes];
        a.store_anywhere(numbers);
        __m256 const low = _mm256_castps128_ps256(_mm256_cvtpd_ps(_mm256_load_pd(numbers)));
        return Single(_mm256_insertf128_ps(low, _mm256_cvtpd_ps(_mm256_load_pd(numbers + 4)), 1));
    }

  private:
    explicit Single(__m256 v) : v_(v) {}
    __m256 v_;
};

}  // namespace catena::dca::avx2
