// A force of your own, computed by a callback at every evaluation.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "catena/types.hpp"

namespace catena {

/// Configuration that a force sees. Entries are bodies and beads, in the order of the scene.
struct BodyPositions {
    /// Position of the centre of mass or bead, W; not wrapped into a periodic box.
    std::span<Triple const> position;
    /// Orientation of the body's axes; the identity for a bead.
    std::span<UnitQuaternion const> orientation;
};

/// Forces to be set, in the same order, all zero at the call.
struct BodyForces {
    /// Force at the centre of mass or on the bead, W.
    std::span<Triple> force;
    /// Torque on a rigid body, W; a bead takes none.
    std::span<Triple> torque;
};

/// Force that depends on positions and orientations. It adds forces and torques, and returns its
/// potential energy, or std::nullopt if it has none. It may be called several times in a step. It
/// must not depend on earlier calls, because steps may be repeated.
using OwnForce = std::function<std::optional<double>(BodyPositions const&, BodyForces const&)>;

}  // namespace catena
