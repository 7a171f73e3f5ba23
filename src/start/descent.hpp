// Relaxation of chains along the forces on their beads. Steps have inertia, which is discarded
// where they lead uphill, and an upper limit of length.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "start/lone_forces.hpp"
#include "start/moving_chains.hpp"

namespace catena {

/// Minimiser FIRE (Bitzek et al., Phys. Rev. Lett. 97, 170201 (2006)) for the units of chains. Its
/// result depends on its arguments only.
class Descent {
  public:
    /// Conditions under which a descent ends.
    struct Limits {
        std::int64_t most;    // largest number of evaluations
        std::int64_t window;  // evaluations after which the energy is compared
        double fall;  // smallest fall of the energy in a window, kJ/mol, that continues the descent
                      // if no bead ...
        double large_force;  // ... feels a larger force than this, kJ/mol/nm
        double last_fall;    // smallest change of the energy in a window, kJ/mol, that continues it
                             // otherwise
    };
    /// `at`: positions of the scene's beads, nm, in the order of the forces' beads. They are
    /// updated.
    Descent(std::vector<MovingChain>& chains, SingleRankForces& forces, std::vector<Vec3>& at);

    /// Callback after each window: number of evaluations so far and energy in kJ/mol.
    using ProgressCallback = std::function<void(std::int64_t, double)>;
    /// Result of a descent.
    struct Ended {
        std::int64_t evaluations = 0;
        double energy = 0;     // potential energy, kJ/mol
        bool at_rest = false;  // the energy fell no further
    };
    /// Moves the chains until a condition of `limits` ends the descent.
    Ended run(Limits const&, ProgressCallback const&);

  private:
    /// One step: velocities from accelerations, motion, new forces, then mixing or a stop.
    void step();
    /// Computes accelerations from the forces, and returns the power of the forces along the
    /// velocities.
    double accelerate();
    /// Redirects velocities towards the forces.
    void mix();
    /// Sets velocities to zero and multiplies the step by `shorten`.
    void stop(double shorten);
    /// Moves the chains by step * velocity. Returns false if the links of some chain could not be
    /// closed.
    bool move();

    std::vector<MovingChain>& chains_;
    SingleRankForces& forces_;
    std::vector<Vec3>& at_;
    std::vector<std::vector<UnitMotion>> velocity_,
        acceleration_;          // per chain and unit: nm and rad per unit of time
    double step_, mixing_;      // length of a step; weight of the forces' direction in mix()
    int downhill_ = 0;          // consecutive downhill steps
    double largest_force_ = 0;  // largest force on a bead, kJ/mol/nm
};

}  // namespace catena
