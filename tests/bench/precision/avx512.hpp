// Sixteen single-precision numbers side by side; the doubles are the library's.
#pragma once

#include "dca/simd/avx512.hpp"
#include "tests/bench/precision/numbers.hpp"

namespace catena::dca::avx512 {

class Single {
  public:
    using Number = float;
    static constexpr int lanes = 16;
    Single() = default;
    Single(float x) : v_(_mm512_set1_ps(x)) {}
    static Single load_anywhere(float const* place) { return Single(_mm512_loadu_ps(place)); }
    void store_anywhere(float* place) const { _mm512_storeu_ps(place, v_); }
    unsigned not_positive() const {
        __m512 const zero = _mm512_setzero_ps();
        return 0xffffU & ~static_cast<unsigned>(_mm512_cmp_ps_mask(v_, zero, _CMP_GT_OQ) &
                                                _mm512_cmp_ps_mask(v_ - v_, zero, _CMP_EQ_OQ));
    }
    friend Single operator+(Single a, Single b) { return Single(a.v_ + b.v_); }
    friend Single operator-(Single a, Single b) { return Single(a.v_ - b.v_); }
    friend Single operator*(Single a, Single b) { return Single(a.v_ * b.v_); }
    friend Single operator/(Single a, Single b) { return Single(a.v_ / b.v_); }
    friend Single operator-(Single a) { return Single(-a.v_); }
    friend Single fused(Single a, Single b, Single c) {
        return Single(_mm512_fmadd_ps(a.v_, b.v_, c.v_));
    }
    friend Single less_product(Single a, Single b, Single c) {
        return Single(_mm512_fnmadd_ps(a.v_, b.v_, c.v_));
    }
    friend precision::Twice<Real> convert(Single a, precision::Twice<Real> const*) {
        alignas(64) double numbers[lanes];
        _mm512_store_pd(numbers, _mm512_cvtps_pd(_mm512_castps512_ps256(a.v_)));
        _mm512_store_pd(numbers + 8, _mm512_cvtps_pd(_mm512_extractf32x8_ps(a.v_, 1)));
        return precision::Twice<Real>::load_anywhere(numbers);
    }
    friend Single convert(precision::Twice<Real> const& a, Single const*) {
        alignas(64) double numbers[lanes];
        a.store_anywhere(numbers);
        __m512 const low = _mm512_castps256_ps512(_mm512_cvtpd_ps(_mm512_load_pd(numbers)));
        return Single(_mm512_insertf32x8(low, _mm512_cvtpd_ps(_mm512_load_pd(numbers + 8)), 1));
    }

  private:
    explicit Single(__m512 v) : v_(v) {}
    __m512 v_;
};

}  // namespace catena::dca::avx512
