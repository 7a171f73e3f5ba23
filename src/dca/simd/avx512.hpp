// Vector of eight doubles for AVX-512.
#pragma once

#include <immintrin.h>

#include <cstdint>

namespace catena::dca::avx512 {

/// Eight doubles with lane-wise arithmetic. load() and store() need 64-byte alignment,
/// load_anywhere() and store_anywhere() none.
class Real {
  public:
    static constexpr int lanes = 8;
    // Default construction leaves the lanes uninitialized; construction from `x` sets all lanes to
    // x.
    Real() = default;
    Real(double x) : v_(_mm512_set1_pd(x)) {}
    static Real load(double const* place) { return Real(_mm512_load_pd(place)); }
    static Real load_anywhere(double const* place) { return Real(_mm512_loadu_pd(place)); }
    void store(double* place) const { _mm512_store_pd(place, v_); }
    void store_anywhere(double* place) const { _mm512_storeu_pd(place, v_); }
    /// Returns a mask whose bit j is set if lane j is not a positive finite number.
    unsigned not_positive() const {
        __m512d const zero = _mm512_setzero_pd();
        return 0xffU & ~static_cast<unsigned>(_mm512_cmp_pd_mask(v_, zero, _CMP_GT_OQ) &
                                              _mm512_cmp_pd_mask(v_ - v_, zero, _CMP_EQ_OQ));
    }

    friend Real operator+(Real a, Real b) { return Real(a.v_ + b.v_); }
    friend Real operator-(Real a, Real b) { return Real(a.v_ - b.v_); }
    friend Real operator*(Real a, Real b) { return Real(a.v_ * b.v_); }
    friend Real operator/(Real a, Real b) { return Real(a.v_ / b.v_); }
    friend Real operator-(Real a) { return Real(-a.v_); }
    friend Real fused(Real a, Real b, Real c) { return Real(_mm512_fmadd_pd(a.v_, b.v_, c.v_)); }
    friend Real less_product(Real a, Real b, Real c) {
        return Real(_mm512_fnmadd_pd(a.v_, b.v_, c.v_));
    }
    friend Real sqrt(Real a) { return Real(_mm512_sqrt_pd(a.v_)); }
    friend Real floor(Real a) {
        return Real(_mm512_roundscale_pd(a.v_, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC));
    }
    /// Rounds towards zero.
    friend Real truncated(Real a) {
        return Real(_mm512_roundscale_pd(a.v_, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC));
    }
    /// Returns a < b ? yes : no in every lane.
    friend Real where_less(Real a, Real b, Real yes, Real no) {
        return Real(
            _mm512_mask_blend_pd(_mm512_cmp_pd_mask(a.v_, b.v_, _CMP_LT_OQ), no.v_, yes.v_));
    }
    /// Returns `yes` in the lanes whose bits in `which` are set, and `no` in the others.
    static Real choose(unsigned which, Real yes, Real no) {
        return Real(_mm512_mask_blend_pd(static_cast<__mmask8>(which), no.v_, yes.v_));
    }
    /// True if the absolute value of any lane exceeds `bound`.
    friend bool any_above(Real a, double bound) {
        return _mm512_cmp_pd_mask(_mm512_abs_pd(a.v_), _mm512_set1_pd(bound), _CMP_GT_OQ) != 0;
    }

    /// Returns origin[at[j]] in lane j.
    static Real pick(double const* origin, std::int64_t const* at) {
        return Real(_mm512_set_pd(origin[at[7]], origin[at[6]], origin[at[5]], origin[at[4]],
                                  origin[at[3]], origin[at[2]], origin[at[1]], origin[at[0]]));
    }
    /// Reads numbers 0 to 3 from origin + at[j] for every lane j and transposes them: vector i, at
    /// `to` + i lanes, gets number i of every lane.
    static void read_four(double const* origin, std::int64_t const* at, double* to) {
        __m512d const a = rows(origin + at[0], origin + at[2]),
                      b = rows(origin + at[1], origin + at[3]);
        __m512d const c = rows(origin + at[4], origin + at[6]),
                      d = rows(origin + at[5], origin + at[7]);
        __m512d const ab = _mm512_unpacklo_pd(a, b), cd = _mm512_unpacklo_pd(c, d);
        __m512d const ab_odd = _mm512_unpackhi_pd(a, b), cd_odd = _mm512_unpackhi_pd(c, d);
        _mm512_store_pd(to, _mm512_shuffle_f64x2(ab, cd, 0x88));
        _mm512_store_pd(to + lanes, _mm512_shuffle_f64x2(ab_odd, cd_odd, 0x88));
        _mm512_store_pd(to + 2 * lanes, _mm512_shuffle_f64x2(ab, cd, 0xdd));
        _mm512_store_pd(to + 3 * lanes, _mm512_shuffle_f64x2(ab_odd, cd_odd, 0xdd));
    }
    /// Writes four vectors; the inverse of read_four().
    static void write_four(double const* from, double* origin, std::int64_t const* at) {
        __m512d const a = _mm512_load_pd(from), b = _mm512_load_pd(from + lanes);
        __m512d const c = _mm512_load_pd(from + 2 * lanes), d = _mm512_load_pd(from + 3 * lanes);
        __m512d const ab = _mm512_unpacklo_pd(a, b), cd = _mm512_unpacklo_pd(c, d);
        __m512d const ab_odd = _mm512_unpackhi_pd(a, b), cd_odd = _mm512_unpackhi_pd(c, d);
        put_rows(_mm512_castpd512_pd256(ab), _mm512_castpd512_pd256(cd), origin + at[0],
                 origin + at[2]);
        put_rows(_mm512_castpd512_pd256(ab_odd), _mm512_castpd512_pd256(cd_odd), origin + at[1],
                 origin + at[3]);
        put_rows(_mm512_extractf64x4_pd(ab, 1), _mm512_extractf64x4_pd(cd, 1), origin + at[4],
                 origin + at[6]);
        put_rows(_mm512_extractf64x4_pd(ab_odd, 1), _mm512_extractf64x4_pd(cd_odd, 1),
                 origin + at[5], origin + at[7]);
    }

  private:
    explicit Real(__m512d v) : v_(v) {}
    // Two rows of four doubles as one vector.
    static __m512d rows(double const* low, double const* high) {
        return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_loadu_pd(low)),
                                  _mm256_loadu_pd(high), 1);
    }
    // Writes two rows of four doubles from the halves of two vectors.
    static void put_rows(__m256d first, __m256d second, double* low, double* high) {
        _mm256_storeu_pd(low, _mm256_permute2f128_pd(first, second, 0x20));
        _mm256_storeu_pd(high, _mm256_permute2f128_pd(first, second, 0x31));
    }
    __m512d v_;
};

}  // namespace catena::dca::avx512
