// NumPy arrays over memory of C++ objects, and copies of it.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "catena/types.hpp"

namespace catena::python {

namespace nb = nanobind;

/// Read-only array of NumPy.
template <class Number>
using View = nb::ndarray<nb::numpy, Number const, nb::device::cpu>;

/// Returns a read-only array over numbers that `owner` holds. The array keeps the owner alive, and
/// nothing is copied. `strides` counts elements; without any the rows follow each other.
template <class Number>
View<Number> view_of(Number const* first, std::vector<std::size_t> const& shape, nb::handle owner,
                     std::vector<std::int64_t> const& strides = {}) {
    return View<Number>(first, shape.size(), shape.data(), owner,
                        strides.empty() ? nullptr : strides.data());
}
/// Returns a read-only array [row][column] over a vector of rows that `owner` holds.
template <std::size_t n>
View<double> view_of(std::vector<std::array<double, n>> const& rows, nb::handle owner) {
    return view_of(rows.empty() ? nullptr : rows.front().data(), {rows.size(), n}, owner);
}
/// Returns a read-only array over a vector of numbers that `owner` holds.
template <class Number>
View<Number> view_of(std::vector<Number> const& numbers, nb::handle owner) {
    return view_of(numbers.data(), {numbers.size()}, owner);
}
/// Returns the torques of joints as a read-only array [body][component] that `owner` holds.
inline View<double> torques_of(std::vector<JointForce> const& forces, nb::handle owner) {
    return view_of(forces.empty() ? nullptr : forces.front().torque.data(), {forces.size(), 3},
                   owner, {6, 1});
}
/// Returns the forces of joints as a read-only array [body][component] that `owner` holds.
inline View<double> forces_of(std::vector<JointForce> const& forces, nb::handle owner) {
    return view_of(forces.empty() ? nullptr : forces.front().force.data(), {forces.size(), 3},
                   owner, {6, 1});
}
/// Returns a new array of rows, which Python owns.
template <std::size_t n>
nb::object copy_of(std::span<std::array<double, n> const> rows) {
    auto* const copy = new std::vector<std::array<double, n>>(rows.begin(), rows.end());
    nb::capsule const owner(
        copy, [](void* p) noexcept { delete static_cast<std::vector<std::array<double, n>>*>(p); });
    return nb::ndarray<nb::numpy, double, nb::ndim<2>>(copy->data(), {rows.size(), n}, owner)
        .cast();
}

/// Array of doubles that a function takes, converted from other types of numbers if needed.
template <int dimensions>
using Numbers = nb::ndarray<double const, nb::ndim<dimensions>, nb::c_contig, nb::device::cpu>;

}  // namespace catena::python
