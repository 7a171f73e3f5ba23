// What a trajectory shows of a scene: one site a bead, a bead that a body carries, or the centre of mass of a body that carries none.
#pragma once

#include <cstdint>
#include <vector>

#include "integrate/chain_system.hpp"
#include "io/output.hpp"

namespace catena {

class Sites {
  public:
    explicit Sites(Scene const&);

    Topology const& topology() const { return topology_; }
    std::vector<Vec3> positions(ChainSystem::Snapshot const&) const;
    std::vector<Vec3> velocities(ChainSystem::Snapshot const&) const;
    /// Of topology().bodies.
    std::vector<Quat> orientations(ChainSystem::Snapshot const&) const;
    /// From those of the scene's bodies; zero on the beads of a body but its first.
    std::vector<Vector<double, 6>> joint_forces(std::vector<Vector<double, 6>> const& of_bodies) const;

  private:
    struct Site {
        std::size_t body;  // of the scene
        Vec3 place;        // from its centre of mass, B
        bool is_first;     // of its body
    };
    void add(ChainSpec const&, std::size_t first_body);

    Topology topology_;
    std::vector<Site> sites_;
    std::vector<std::size_t> turning_;  // the scene's bodies that are no point beads
};

}  // namespace catena
