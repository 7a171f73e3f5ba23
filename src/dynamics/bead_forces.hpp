// Forces on beads that stand in no array of the chains yet: whoever needs them first adds them up.
#pragma once

#include "neighbours/device_beads.hpp"

namespace catena {

struct BeadForces {
    Vec3 gravity = Vec3::zero();
    DeviceParticles particles;  // of OpenMM; without beads there are none

    CATENA_HD Vec3 on(std::int64_t k, double mass) const {
        Vec3 const f = mass * gravity;
        return particles.bead ? f + particles.force_on(k) : f;
    }
};

}  // namespace catena
