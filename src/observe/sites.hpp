// What a trajectory shows of a scene: one site a bead, a bead that a body carries, or the centre of
// mass of a body that carries none.
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
    /// Of these bodies alone, in scene order; without the topology's lists.
    Sites(Scene const&, std::vector<SceneWindows::Run> const& own);

    Topology const& topology() const { return topology_; }
    /// What these bodies show of themselves, without step and time.
    Frame part(ChainSystem::Bodies const&, bool velocities, Executor const&) const;

  private:
    struct Site {
        std::size_t body, site;  // of the scene, of the trajectory
        Vec3 place;              // from its centre of mass, B
        bool is_first;           // of its body
    };
    struct Turning {
        std::size_t body, number;  // of the scene, among those that turn
    };
    Sites(Scene const&, std::vector<SceneWindows::Run> const& runs, bool with_topology);
    void add(ChainSpec const&, bool with_topology);
    void add_state(ChainSystem::Bodies const&, std::size_t k, Frame&) const;
    bool shows_next();

    Topology topology_;
    std::vector<Site> sites_;
    std::vector<Turning> turning_;  // bodies that are no point beads
    std::vector<SceneWindows::Run> runs_;
    std::size_t run_ = 0, next_body_ = 0, next_site_ = 0,
                next_turning_ = 0;  // while they are counted
};

}  // namespace catena
