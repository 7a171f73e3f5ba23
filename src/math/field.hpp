// One quantity of D components for every body that a rank owns, stored component by component (a
// structure of arrays). One halo body lies on either side. All addressing is done here, in
// DirectionsView and in RecordsView. Arrays on a GPU have their own order (gpu_order), so host code
// must not dereference a view of a device, nor device code a view of the host.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include "math/large_pages.hpp"
#include "math/linear.hpp"

namespace catena {

/// Non-owning view of a field. Bodies k are in [-1, size]; the two ends are the halo.
template <class Real, int D>
struct FieldView {
    Real* origin = nullptr;  // component 0 of body 0
    std::int64_t pitch = 0;  // see place_of()
    std::int64_t size = 0;

    /// Component of body k, by reference.
    CATENA_HD Real& at(std::int64_t k, int component) const {
        return origin[component * to_next_number(pitch) + place_of(k, pitch)];
    }
    /// Returns all components of body k.
    CATENA_HD Vector<std::remove_const_t<Real>, D> load(std::int64_t k) const {
        return taken<false>(k);
    }
    /// Returns all components of body k, and lets a GPU evict them from its caches first. Use this
    /// if the values are not read again soon.
    CATENA_HD Vector<std::remove_const_t<Real>, D> load_last(std::int64_t k) const {
        return taken<true>(k);
    }
    /// Sets all components of body k.
    template <class Value>
    CATENA_HD void store(std::int64_t k, Vector<Value, D> const& v) const {
        Real* const first = origin + place_of(k, pitch);
        CATENA_UNROLL
        for (int i = 0; i < D; ++i) first[i * to_next_number(pitch)] = v[i];
    }
    /// View of `count` consecutive components, starting with component `first`.
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

/// Owner of a field on the host, zero-initialised.
template <class Real, int D>
class BasicField {
  public:
    BasicField() = default;
    explicit BasicField(std::int64_t size)
        : pitch_(padded(size)), size_(size), data_(static_cast<std::size_t>(D * pitch_)) {}

    std::int64_t size() const { return size_; }
    /// The allocated memory, halo and padding included.
    std::span<Real> storage() { return data_; }
    /// Returns a view of the field; its origin is null if the field is empty.
    FieldView<Real, D> view() {
        return data_.empty() ? FieldView<Real, D>{}
                             : FieldView<Real, D>{data_.data() + halo, pitch_, size_};
    }
    FieldView<Real const, D> view() const {
        return data_.empty() ? FieldView<Real const, D>{}
                             : FieldView<Real const, D>{data_.data() + halo, pitch_, size_};
    }
    Vector<Real, D> operator[](std::int64_t k) const { return view().load(k); }
    /// True if all bodies have bitwise equal components. The halo is not compared.
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
    /// Number of entries before body 0 and after the last body: one cache line of doubles.
    static constexpr std::int64_t halo = 8;
    /// Pads the pitch to an odd number of cache lines. A power-of-two stride would map all
    /// components of a body to one cache set.
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
