// Small systems with awkward numbers, for tests of what is written.
#pragma once

#include <cmath>
#include <limits>

#include "io/output.hpp"

namespace catena::test {

/// Five beads in one chain and three bodies in another, both held by their tips.
inline Topology sample_topology() {
    Topology topology;
    topology.title = "sample";
    topology.chains = {{"beads", 0, 5, true, false}, {"bodies", 5, 3, false, false}};
    topology.residue = {"MET", "ASP", "VAL", "PHE", "MET", "BDY", "BDY", "BDY"};
    topology.mass = {131.2, 115.09, 99.13, 147.18, 131.2, 1, 2, 3};
    topology.bodies = {5, 6, 7};
    topology.tips = {0, 1};
    topology.box = Vec3{{10, 11, 12}};
    return topology;
}

/// Every number another one, of magnitudes from denormal to large.
inline Frame sample_frame(std::int64_t step, Topology const& topology) {
    Frame frame;
    frame.step = step;
    frame.time = 0.1 * static_cast<double>(step);
    double seed = 1 + static_cast<double>(step);
    auto const next = [&] { return seed = std::fmod(seed * 1.7320508075688772 + 0.1, 97.0) - 40; };
    for (std::size_t k = 0; k < topology.mass.size(); ++k) {
        frame.positions.push_back({{next(), next(), next()}});
        frame.velocities.push_back({{next() * 1e-300, -0.0, next() * 1e300}});
        frame.joint_forces.push_back({{next(), next(), next(), next(), next(), next()}});
    }
    for (std::size_t k = 0; k < topology.tips.size(); ++k)
        frame.tip_forces.push_back({{next(), next(), next(), next(), next(), next()}});
    frame.velocities[0][1] = std::numeric_limits<double>::denorm_min();
    for (std::size_t k = 0; k < topology.bodies.size(); ++k)
        frame.orientations.push_back({next(), next(), next(), next()});
    return frame;
}

}  // namespace catena::test
