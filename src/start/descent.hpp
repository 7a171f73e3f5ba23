// Moves chains down the forces on their beads: steps with inertia, which is lost where they lead
// uphill, and with a cap.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "start/lone_forces.hpp"
#include "start/moving_chains.hpp"

namespace catena {

/// Bitzek et al., Phys. Rev. Lett. 97, 170201 (2006): FIRE, on units of chains. A function of its
/// arguments alone.
class Descent {
  public:
    struct Limits {
        std::int64_t most;    // evaluations
        std::int64_t window;  // evaluations in which the energy must fall ...
        double fall;  // ... by this much, kJ/mol: else it ends, where no bead feels more than ...
        double large_force;  // ... this, kJ/mol/nm; where one does ...
        double last_fall;    // ... it ends where the energy changes by less than this
    };
    /// `at`: where the scene's beads stand, in the order of the forces' beads.
    Descent(std::vector<MovingChain>& chains, LoneForces& forces, std::vector<Vec3>& at);

    /// Called after each window with the number of evaluations so far and the energy.
    using Tell = std::function<void(std::int64_t, double)>;
    struct Ended {
        std::int64_t evaluations = 0;
        double energy = 0;
        bool at_rest = false;  // the energy fell no further
    };
    Ended run(Limits const&, Tell const&);

  private:
    void step();
    /// Forces become accelerations. The power is of the velocities.
    double accelerate();
    void mix();
    void stop(double shorten);
    bool move();

    std::vector<MovingChain>& chains_;
    LoneForces& forces_;
    std::vector<Vec3>& at_;
    std::vector<std::vector<UnitMotion>> velocity_, acceleration_;  // by chain and unit
    double step_, mixing_;
    int downhill_ = 0;  // steps
    double largest_force_ = 0;
};

}  // namespace catena
