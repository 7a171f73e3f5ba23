// The types of joints. What a type means is said by its model alone (joint_models.hpp).
#pragma once

#include <cstdint>

namespace catena {

/// Kind of motion that a joint allows between its inboard and its outboard body.
enum class JointType : std::uint8_t {
    free,
    link,
    spherical,
    revolute,
    universal,
    weld,
    prismatic,
    helical,
    cylindrical,
    planar3
};

}  // namespace catena
