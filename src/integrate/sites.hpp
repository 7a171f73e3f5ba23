// What a trajectory shows of a scene: one site a bead, a bead that a body carries, or the centre of mass of a body that carries none.
#pragma once

#include <cstdint>
#include <vector>

#include "integrate/chain_system.hpp"
#include "io/output.hpp"

namespace catena {

class Sites {
  public:
    Sites() = default;  // none: where no files are written
    explicit Sites(Scene const&);

    Topology const& topology() const { return topology_; }
    /// What these bodies show of themselves, without step and time.
    Frame part(ChainSystem::Bodies const&, bool velocities) const;

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
