// Plain types of the public headers. Frames: W ground axes, B body axes.
#pragma once

#include <array>

namespace catena {

/// Three components of a vector.
using Triple = std::array<double, 3>;
/// Unit quaternion w, x, y, z. It takes components in B to components in W.
using UnitQuaternion = std::array<double, 4>;

/// Constraint force of a joint or a link on its outboard body, W. The torque is about the joint.
struct JointForce {
    Triple torque{}, force{};
};

}  // namespace catena
