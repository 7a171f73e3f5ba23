// Sites of a trajectory: beads, beads that bodies carry, and the centres of mass of bodies without
// beads.
#pragma once

#include <cstdint>
#include <vector>

#include "integrate/chain_system.hpp"
#include "io/output.hpp"

namespace catena {

/// Map from the bodies of a scene to the sites of its trajectory.
class Sites {
  public:
    Sites() = default;  // no sites, for ranks that write no files
    explicit Sites(Scene const&);
    /// Sites of these bodies only, in scene order. The topology's lists stay empty.
    Sites(Scene const&, std::vector<SceneWindows::Run> const& own);

    Topology const& topology() const { return topology_; }
    /// Returns the sites of the given bodies as part of a frame, without step and time.
    Frame part(SceneBodies const&, bool velocities, Executor const&) const;

  private:
    /// Site of a trajectory.
    struct Site {
        std::size_t body, site;  // indices in the scene and in the trajectory
        Vec3 place;              // position from the body's centre of mass, body axes
        bool is_first;           // first site of its body
    };
    /// Rigid body, which has an orientation in frames.
    struct Turning {
        std::size_t body, number;  // indices in the scene and among the rigid bodies
    };
    Sites(Scene const&, std::vector<SceneWindows::Run> const& runs, bool with_topology);
    /// Adds the sites of a chain's bodies.
    void add(ChainSpec const&, bool with_topology);
    void add_members(Members const& members, std::int64_t first);
    /// Adds orientation and coordinates of the body `k` of `bodies`.
    void add_state(SceneBodies const&, std::size_t k, Frame&) const;
    /// True if this rank has the next body.
    bool shows_next();

    Topology topology_;
    std::vector<Site> sites_;
    std::vector<Turning> turning_;  // rigid bodies, not point beads
    std::vector<SceneWindows::Run> runs_;
    std::size_t run_ = 0, next_body_ = 0, next_site_ = 0,
                next_turning_ = 0;  // counters during construction
};

}  // namespace catena
