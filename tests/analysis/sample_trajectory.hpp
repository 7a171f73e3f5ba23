// Chains that are drawn at random and written as a run writes them.
#pragma once

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "io/output.hpp"

namespace catena::test {

/// Draws the conformations of chains.
class RandomChains {
  public:
    explicit RandomChains(std::uint64_t seed) : draw_(seed) {}

    double normal() { return normal_(draw_); }
    double uniform() { return uniform_(draw_); }
    Vec3 gaussian() { return {{normal(), normal(), normal()}}; }
    Vec3 direction() {
        Vec3 const v = gaussian();
        return (1 / norm(v)) * v;
    }
    /// Chain of `count` sites with bonds of length `bond`, each at an angle of the given cosine to
    /// the one before, freely rotating. A cosine of 0 is replaced by free joints.
    std::vector<Vec3> chain(std::size_t count, double bond, double cosine) {
        std::vector<Vec3> x{Vec3::zero()};
        Vec3 along = direction();
        while (x.size() < count) {
            x.push_back(plus_scaled(x.back(), bond, along));
            Vec3 const other = direction();
            if (cosine == 0) {
                along = other;
                continue;
            }
            Vec3 const across = cross(along, other);
            along = cosine * along + (std::sqrt(1 - cosine * cosine) / norm(across)) * across;
        }
        return x;
    }

  private:
    std::mt19937_64 draw_;
    std::normal_distribution<double> normal_;
    std::uniform_real_distribution<double> uniform_;
};

/// Chains of equal sites, one after the other.
inline Topology topology_of(std::vector<std::int64_t> const& counts, bool ring = false) {
    Topology topology;
    topology.title = "drawn at random";
    for (std::int64_t const count : counts) {
        topology.chains.push_back({"chain-" + std::to_string(topology.chains.size() + 1),
                                   std::ssize(topology.mass), count, true, ring});
        topology.mass.resize(topology.mass.size() + static_cast<std::size_t>(count), 1.0);
    }
    topology.residue.assign(topology.mass.size(), "GLY");
    return topology;
}

}  // namespace catena::test
