// Layers of forces on one GPU (systems/force_layers.hpp): a Context of some of the particles beside
// the Context of all of them. Positions are copied from the arrays of all particles to those of the
// layer, and forces are added the other way. All addresses are in GPU memory.
#pragma once

#include <cstdint>

#include "math/host_device.hpp"
#include "neighbours/shared_particles.hpp"

namespace catena {

/// Loop body that copies the position of a layer's particle i, counted by its place. Layers have
/// pair forces only, which do not use rounding corrections: these are not copied.
template <class Number>
struct LayerPositions {
    /// Place of each of the layer's particles among all particles.
    std::int32_t const* from = nullptr;
    /// Records of x, y, z (nm) and charge (e), one per place: of all particles, of the layer.
    Number const* all = nullptr;
    Number* position = nullptr;
    /// Positions when OpenMM built the layer's neighbour list, in the layout of `position`; null:
    /// no check. `far` is set to 1 if a particle has moved farther than `farthest_squared` allows
    /// (nm^2).
    Number const* listed = nullptr;
    float farthest_squared = 0;
    std::int64_t* far = nullptr;

    CATENA_HD void operator()(std::int64_t i) const {
        std::int64_t const here = 4 * i, there = 4 * static_cast<std::int64_t>(from[i]);
        float away = 0;
        for (int c = 0; c < 3; ++c) {
            Number const x = all[there + c];
            position[here + c] = x;
            float const moved = listed ? static_cast<float>(x - listed[here + c]) : 0.0f;
            away += moved * moved;
        }
        if (listed && !(away < farthest_squared)) *far = 1;
    }
};

/// Loop body that adds component i / count of the force on the layer's particle i % count to the
/// force on the same bead among all particles. The sums are of integers, so that their order does
/// not matter.
struct LayerForces {
    /// Forces on all particles; `place` is LayerPositions::from.
    ForcesOnBeads all;
    /// Forces of the layer, in the layout of DeviceParticles::force.
    std::int64_t const* force = nullptr;
    std::int64_t places = 0;
    /// Number of the layer's particles.
    std::int64_t count = 0;

    CATENA_HD void operator()(std::int64_t i) const {
        std::int64_t const k = i % count, c = i / count;
        std::int64_t& sum = all.force[all.place[k] + c * all.places];
        sum = sum_of_forces(sum, force[k + c * places]);
    }
};

}  // namespace catena
