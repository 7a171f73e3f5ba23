// What a rigid body can be: checks of inertia, rotations and directions, each with a tolerance that
// says where it comes from.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "math/linear.hpp"
#include "math/rotation.hpp"
#include "scene/node.hpp"

namespace catena::scene {

/// What is wrong with a value, and what to do.
struct Fault {
    std::string what, remedy;
};

/// Inertia about the centre of mass: 3x3, or the three numbers of a diagonal. Throws InputError
/// unless it is symmetric, positive definite and its principal moments satisfy the triangle
/// inequality, each within c eps of the largest entry, c = 64 (what a few products and sums of
/// rounded numbers lose; eps = 2^-52). A thin rod or a point mass is refused: a leaf needs an
/// invertible inertia.
Sym3 inertia(Node const&);
std::optional<Fault> make_inertia(Mat3 const& given, Sym3& inertia);

/// Principal moments in ascending order (cyclic Jacobi).
std::array<double, 3> principal_moments(Sym3 const&);

/// Rotation matrix: orthonormal within 1e-6 (numbers printed with seven digits) and right-handed;
/// returned orthonormal to rounding.
Mat3 rotation(Node const&);
std::optional<Fault> make_rotation(Mat3&);

/// Unit quaternion w x y z: norm within 1e-6 of 1; returned normalised to rounding.
std::array<double, 4> unit_quaternion(Node const&);
std::optional<Fault> make_unit(std::array<double, 4>& quaternion);

/// The direction of a vector of any length but 0.
Vec3 direction(Node const&);
std::optional<Fault> make_direction(Vec3&);

/// Axes of a universal joint, nearer to parallel than numbers printed with seven digits can tell
/// apart.
std::optional<Fault> check_two_axes(Vec3 const& first, Vec3 const& second);

}  // namespace catena::scene
