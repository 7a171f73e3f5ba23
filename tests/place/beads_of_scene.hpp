// Beads of a scene, by plain loops over all pairs.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "place/chain_motion.hpp"
#include "scene/scene.hpp"

namespace catena::test {

/// Positions of the beads of a chain, those that bodies carry included.
inline std::vector<Vec3> beads_of(ChainSpec const& chain) {
    if (chain.is_beads()) return chain.beads.position;
    LinkedArrays const& l = chain.linked;
    std::vector<Vec3> beads;
    for (std::size_t k = 0; k < l.size(); ++k) {
        auto const& q = l.orientation[k];
        Mat3 const r = to_matrix(Quat{q[0], q[1], q[2], q[3]});
        for (auto b = static_cast<std::size_t>(l.carried.offset[k]);
             b < static_cast<std::size_t>(l.carried.offset[k + 1]); ++b)
            beads.push_back(l.position[k] + r * l.carried.position[b]);
    }
    return beads;
}

/// Smallest distance between beads of different chains, nearest images included.
inline double nearest_chains(Scene const& scene) {
    Vec3 const& box = *scene.box;
    std::vector<std::vector<Vec3>> chains;
    for (ChainSpec const& chain : scene.chains) chains.push_back(beads_of(chain));
    double nearest = 1e300;
    for (std::size_t a = 0; a < chains.size(); ++a)
        for (std::size_t b = a + 1; b < chains.size(); ++b)
            for (Vec3 const& x : chains[a])
                for (Vec3 const& y : chains[b]) {
                    Vec3 apart = x - y;
                    for (int i = 0; i < 3; ++i) apart[i] -= box[i] * std::round(apart[i] / box[i]);
                    nearest = std::min(nearest, dot(apart, apart));
                }
    return std::sqrt(nearest);
}

/// Expects all beads of chains [first, end) between two coordinates of an axis.
inline void expect_between(Scene const& scene, std::size_t first, std::size_t end, int axis,
                           double low, double high) {
    for (std::size_t c = first; c < end; ++c)
        for (Vec3 const& at : beads_of(scene.chains[c])) {
            ASSERT_GE(at[axis], low) << scene.chains[c].name;
            ASSERT_LE(at[axis], high) << scene.chains[c].name;
        }
}

inline void expect_links(Scene const& scene) {
    for (ChainSpec const& chain : scene.chains)
        for (std::size_t k = 1; k < chain.beads.size(); ++k)
            ASSERT_NEAR(norm(chain.beads.position[k] - chain.beads.position[k - 1]),
                        chain.beads.length[k], 1e-12)
                << chain.name;
}

}  // namespace catena::test
