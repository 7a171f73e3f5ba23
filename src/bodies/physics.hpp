// Checks of the physical properties of rigid bodies: inertia, rotations and directions. Each check
// states the origin of its tolerance.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "math/linear.hpp"
#include "math/rotation.hpp"
#include "scene/node.hpp"

namespace catena::scene {

/// Description of an invalid value, with a remedy.
struct Fault {
    /// Statement of the fault, and advice.
    std::string what, remedy;
};

/// Reads an inertia about the centre of mass: 3x3, or the three numbers of a diagonal. Throws
/// InputError unless it is symmetric, positive definite and its principal moments satisfy the
/// triangle inequality. Each condition holds within c eps of the largest entry. c = 64 covers the
/// loss of a few products and sums of rounded numbers; eps = 2^-52. A thin rod or a point mass is
/// refused, because a leaf needs an invertible inertia.
Sym3 inertia(Node const&);
/// Checks a matrix in the same way and symmetrises it into `inertia`; returns the fault, if any.
std::optional<Fault> make_inertia(Mat3 const& given, Sym3& inertia);

/// Principal moments in ascending order (cyclic Jacobi).
std::array<double, 3> principal_moments(Sym3 const&);

/// Reads a rotation matrix: right-handed, and orthonormal within 1e-6 (numbers printed with seven
/// digits). The result is orthonormal to rounding.
Mat3 rotation(Node const&);
/// Checks and orthonormalises a matrix in place; returns the fault, if any.
std::optional<Fault> make_rotation(Mat3&);

/// Reads a unit quaternion w x y z with a norm within 1e-6 of 1. The result is normalised to
/// rounding.
std::array<double, 4> unit_quaternion(Node const&);
/// Checks and normalises a quaternion in place; returns the fault, if any.
std::optional<Fault> make_unit(std::array<double, 4>& quaternion);

/// Reads a vector of any length but 0 and returns the unit vector along it.
Vec3 direction(Node const&);
/// Normalises a vector in place; returns the fault if it is zero.
std::optional<Fault> make_direction(Vec3&);

/// Returns a fault if the unit axes of a universal joint are parallel within the precision of seven
/// printed digits.
std::optional<Fault> check_two_axes(Vec3 const& first, Vec3 const& second);
/// Returns a fault if a unit axis of translation is not perpendicular to the unit normal of its
/// plane within the precision of seven printed digits. Otherwise makes it so to rounding.
std::optional<Fault> check_plane(Vec3& along, Vec3 const& normal);

}  // namespace catena::scene
