// One quantity of D components for every body a rank holds, component after component (a structure
// of arrays), with one halo body on either side. All addressing is here, in DirectionsView and in
// RecordsView: a GPU's arrays have an order of their own (gpu_order), so that host code must not
// reach through a view of a device, nor the other way round.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include "math/large_pages.hpp"
#include "math/linear.hpp"

namespace catena {

/// Free view: body k in [-1, size] (the ends are the halo).
template <class Real, int D>
struct FieldView {
    Real* origin = nullptr;  // component 0 of body 0
    std::int64_t pitch = 0;  // as place_of() has it
    std::int64_t size = 0;

    CATENA_HD Real& at(std::int64_t k, int component) const {
        return origin[component * to_next_number(pitch) + place_of(k, pitch)];
    }
    CATENA_HD Vector<std::remove_const_t<Real>, D> load(std::int64_t k) const {
        return taken<false>(k);
    }
    /// Where nobody will want it soon: it may leave a GPU's caches first.
    CATENA_HD Vector<std::remove_const_t<Real>, D> load_last(std::int64_t k) const {
        return taken<true>(k);
    }
    template <class Value>
    CATENA_HD void store(std::int64_t k, Vector<Value, D> const& v) const {
        Real* const first = origin + place_of(k, pitch);
        CATENA_UNROLL
        for (int i = 0; i < D; ++i) first[i * to_next_number(pitch)] = v[i];
    }
    /// `count` of the components, as a field of their own.
    template <int count>
    CATENA_HD FieldView<Real, count> components(int first) const {
        return {origin + first * to_next_number(pitch), pitch, size};
    }
    CATENA_HD operator FieldView<Real const, D>() const { return {origin, pitch, size}; }

  private:
    template <bool last>
    CATENA_HD Vector<std::remove_const_t<Real>, D> taken(std::int64_t k) const {
        Vector<std::remove_const_t<Real>, D> v;
        Real* const first = origin + place_of(k, pitch);
        CATENA_UNROLL
        for (int i = 0; i < D; ++i) v[i] = taken_number<last>(first + i * to_next_number(pitch));
        return v;
    }
};

/// Owner of a field on the host. Zero-initialised.
template <class Real, int D>
class BasicField {
  public:
    BasicField() = default;
    explicit BasicField(std::int64_t size) : pitch_(padded(size)), size_(size), data_(static_cast<std::size_t>(D * pitch_)) {}

    std::int64_t size() const { return size_; }
    /// All its memory, however it is laid out.
    std::span<Real> storage() { return data_; }
    /// Without origin where there is nothing.
    FieldView<Real, D> view() { return data_.empty() ? FieldView<Real, D>{} : FieldView<Real, D>{data_.data() + halo, pitch_, size_}; }
    FieldView<Real const, D> view() const {
        return data_.empty() ? FieldView<Real const, D>{} : FieldView<Real const, D>{data_.data() + halo, pitch_, size_};
    }
    Vector<Real, D> operator[](std::int64_t k) const { return view().load(k); }
    /// Whether all bodies have the same numbers, to the bit; the halo may have others.
    bool alike() const {
        for (int i = 0; i < D; ++i) {
            Real const* const first = size_ > 0 ? &view().at(0, i) : nullptr;
            for (std::int64_t k = 1; k < size_; ++k)
                if (std::memcmp(first, first + k, sizeof(Real)) != 0) return false;
        }
        return true;
    }
    void set(std::int64_t k, Vector<Real, D> const& v) { view().store(k, v); }

  private:
    static constexpr std::int64_t halo = 8;
    /// An odd number of cache lines: components of one body at a power-of-two stride would fight for one cache set.
    static std::int64_t padded(std::int64_t size) {
        std::int64_t const lines = (size + 2 * halo + 7) / 8;
        return 8 * (lines | 1);
    }
    std::int64_t pitch_ = 0, size_ = 0;
    LongArray<Real> data_;
};

template <int D>
using Field = BasicField<double, D>;
template <int D>
using View = FieldView<double, D>;
template <int D>
using ConstView = FieldView<double const, D>;

}  // namespace catena
