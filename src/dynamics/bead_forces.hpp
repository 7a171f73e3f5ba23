// Forces on beads that are not yet summed into the chains' force array; their first reader sums
// them.
#pragma once

#include "neighbours/device_beads.hpp"

namespace catena {

/// Gravity, constant forces and OpenMM's forces on beads.
struct BeadForces {
    Vec3 gravity = Vec3::zero();
    /// Constant force on each bead; without origin if no bead has one.
    ConstView<3> constant;
    /// OpenMM's arrays on the GPU; absent if it computes no forces there.
    DeviceParticles particles;

    /// Force on bead k, kJ/mol/nm.
    CATENA_HD Vec3 on(std::int64_t k, double mass) const {
        Vec3 f = mass * gravity;
        if (constant.origin) f = f + constant.load(k);
        return particles.bead ? f + particles.force_on(k) : f;
    }
};

}  // namespace catena
