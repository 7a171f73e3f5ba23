// Superposition of a rigid shape on positions.
#pragma once

#include <span>

#include "math/linear.hpp"
#include "math/rotation.hpp"

namespace catena::scene {

/// Position and orientation of a rigid shape.
struct Superposition {
    Quat rotation = Quat::identity();
    Vec3 shift = Vec3::zero();
    /// Largest distance between a point of the superposed shape and its target.
    double largest = 0;
};

/// Returns the motion `shift + rotation * shape[k]` that comes nearest to `target[k]`, by the sum
/// of squared distances (Horn, J. Opt. Soc. Am. A 4, 629 (1987)). Precondition: equal numbers of
/// points, three or more that do not lie on a line.
Superposition superpose(std::span<Vec3 const> shape, std::span<Vec3 const> target);

}  // namespace catena::scene
