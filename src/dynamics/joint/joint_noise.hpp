// Random loads of a thermostat in joint coordinates, in any Space.
#pragma once

#include "dynamics/joint/joint_loads.hpp"
#include "math/philox.hpp"

namespace catena {

/// Sets random loads of body k. The solver's response to them is normal, with the inverse of the
/// chain's mass matrix as covariance, including the parts of springs and dampers.
CATENA_HD void set_noise(JointLoads const& loads, std::int64_t k, std::uint64_t body,
                         std::uint64_t seed, std::uint64_t step) {
    Vec3 const turning = normal3(seed, step, body, NoiseStage::thermostat_angular);
    Sym3 const factor = dca::factorize(as_symmetric(loads.inertia.load(k)), 3);  // J = L S L^T.
    Vec3 scaled, moment;
    for (int i = 0; i < 3; ++i) scaled[i] = turning[i] / std::sqrt(factor(i, i));
    for (int i = 0; i < 3; ++i) {
        moment[i] = scaled[i];
        for (int j = 0; j < i; ++j) moment[i] = fused(factor(i, j), scaled[j], moment[i]);
    }
    loads.torque.store(k, moment);
    loads.force.store(
        k, std::sqrt(loads.mass.at(k, 0)) * normal3(seed, step, body, NoiseStage::thermostat));
    auto b = Vector<double, 6>::zero();
    if (loads.implicit.has(k)) {
        Vec3 const along = normal3(seed, step, body, NoiseStage::thermostat_joint);
        Mat3 motions;
        int const count = loads.moved.free_motions(k, motions);
        for (int i = 0; i < count; ++i)
            add_yielding(b, -(along[i] / std::sqrt(loads.implicit.inertia(loads.given, k, i))) *
                                motions.column(i));
    }
    store_first(loads.bias, k, loads.directions, b);
}

}  // namespace catena
