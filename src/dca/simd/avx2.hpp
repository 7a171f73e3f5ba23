// Vector of four doubles for AVX2.
#pragma once

#include <immintrin.h>

#include <cstdint>

namespace catena::dca::avx2 {

/// Four doubles with lane-wise arithmetic. load() and store() need 32-byte alignment,
/// load_anywhere() and store_anywhere() none.
class Real {
  public:
    static constexpr int lanes = 4;
    // Default construction leaves the lanes uninitialized; construction from `x` sets all lanes to
    // x.
    Real() = default;
    Real(double x) : v_(_mm256_set1_pd(x)) {}
    static Real load(double const* place) { return Real(_mm256_load_pd(place)); }
    static Real load_anywhere(double const* place) { return Real(_mm256_loadu_pd(place)); }
    void store(double* place) const { _mm256_store_pd(place, v_); }
    void store_anywhere(double* place) const { _mm256_storeu_pd(place, v_); }
    /// Returns a mask whose bit j is set if lane j is not a positive finite number.
    unsigned not_positive() const {
        __m256d const zero = _mm256_setzero_pd();
        __m256d const good = _mm256_and_pd(_mm256_cmp_pd(v_, zero, _CMP_GT_OQ),
                                           _mm256_cmp_pd(v_ - v_, zero, _CMP_EQ_OQ));
        return 0xfU & ~static_cast<unsigned>(_mm256_movemask_pd(good));
    }

    friend Real operator+(Real a, Real b) { return Real(a.v_ + b.v_); }
    friend Real operator-(Real a, Real b) { return Real(a.v_ - b.v_); }
    friend Real operator*(Real a, Real b) { return Real(a.v_ * b.v_); }
    friend Real operator/(Real a, Real b) { return Real(a.v_ / b.v_); }
    friend Real operator-(Real a) { return Real(-a.v_); }
    friend Real fused(Real a, Real b, Real c) { return Real(_mm256_fmadd_pd(a.v_, b.v_, c.v_)); }
    friend Real less_product(Real a, Real b, Real c) {
        return Real(_mm256_fnmadd_pd(a.v_, b.v_, c.v_));
    }
    friend Real sqrt(Real a) { return Real(_mm256_sqrt_pd(a.v_)); }
    friend Real floor(Real a) { return Real(_mm256_floor_pd(a.v_)); }
    /// Rounds towards zero.
    friend Real truncated(Real a) {
        return Real(_mm256_round_pd(a.v_, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC));
    }
    /// Returns a < b ? yes : no in every lane.
    friend Real where_less(Real a, Real b, Real yes, Real no) {
        return Real(_mm256_blendv_pd(no.v_, yes.v_, _mm256_cmp_pd(a.v_, b.v_, _CMP_LT_OQ)));
    }
    /// Returns `yes` in the lanes whose bits in `which` are set, and `no` in the others.
    static Real choose(unsigned which, Real yes, Real no) {
        __m256i const bits = _mm256_set_epi64x(8, 4, 2, 1);
        __m256i const chosen = _mm256_cmpeq_epi64(
            _mm256_and_si256(_mm256_set1_epi64x(static_cast<long long>(which)), bits), bits);
        return Real(_mm256_blendv_pd(no.v_, yes.v_, _mm256_castsi256_pd(chosen)));
    }
    /// True if the absolute value of any lane exceeds `bound`.
    friend bool any_above(Real a, double bound) {
        __m256d const size = _mm256_andnot_pd(_mm256_set1_pd(-0.0), a.v_);
        return _mm256_movemask_pd(_mm256_cmp_pd(size, _mm256_set1_pd(bound), _CMP_GT_OQ)) != 0;
    }

    /// Returns origin[at[j]] in lane j.
    static Real pick(double const* origin, std::int64_t const* at) {
        return Real(_mm256_set_pd(origin[at[3]], origin[at[2]], origin[at[1]], origin[at[0]]));
    }
    /// Reads numbers 0 to 3 from origin + at[j] for every lane j and transposes them: vector i, at
    /// `to` + i lanes, gets number i of every lane.
    static void read_four(double const* origin, std::int64_t const* at, double* to) {
        __m256d rows[lanes];
        for (int j = 0; j < lanes; ++j) rows[j] = _mm256_loadu_pd(origin + at[j]);
        transpose(rows);
        for (int i = 0; i < lanes; ++i) _mm256_store_pd(to + i * lanes, rows[i]);
    }
    /// Writes four vectors; the inverse of read_four().
    static void write_four(double const* from, double* origin, std::int64_t const* at) {
        __m256d rows[lanes];
        for (int i = 0; i < lanes; ++i) rows[i] = _mm256_load_pd(from + i * lanes);
        transpose(rows);
        for (int j = 0; j < lanes; ++j) _mm256_storeu_pd(origin + at[j], rows[j]);
    }

  private:
    explicit Real(__m256d v) : v_(v) {}
    // Transposes a 4 x 4 matrix in place.
    static void transpose(__m256d (&m)[lanes]) {
        __m256d const a = _mm256_unpacklo_pd(m[0], m[1]), b = _mm256_unpackhi_pd(m[0], m[1]);
        __m256d const c = _mm256_unpacklo_pd(m[2], m[3]), d = _mm256_unpackhi_pd(m[2], m[3]);
        m[0] = _mm256_permute2f128_pd(a, c, 0x20);
        m[1] = _mm256_permute2f128_pd(b, d, 0x20);
        m[2] = _mm256_permute2f128_pd(a, c, 0x31);
        m[3] = _mm256_permute2f128_pd(b, d, 0x31);
    }
    __m256d v_;
};

}  // namespace catena::dca::avx2
