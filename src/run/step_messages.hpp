// Number and size of the messages of a step, predicted from the partition alone. The communicator's
// counts should agree with it. OpenMM's messages are not included.
#pragma once

#include "chain/chain_group.hpp"
#include "integrate/joint_integrators.hpp"

namespace catena {

/// Cuts that the boundaries of ranks make in a group of chains, as one rank sees them.
struct Cut {
    std::int64_t shared_units = 0;  // units of shared chains whose data the ranks gather
    bool inboard = false,
         outboard = false;       // a chain continues on the preceding or the following rank
    std::int64_t ring_ends = 0;  // rings whose other end is on another rank
    GatherWay way;               // mode of the communicator's gathers
};
/// Cuts of a group on this rank.
Cut cut_of(ChainGroup const&, GatherWay const&);

/// Prediction for one group of chains.
class StepMessages {
  public:
    StepMessages(ChainGroup const&, Scene const&);
    /// Messages of a step with the numbers of sweeps that follow from the scene.
    Traffic a_step(int sweeps, Cut const& cut) const { return a_step(sweeps, cut, 1, sweeps_); }
    /// Messages of a step. `sweeps`, `parts` and `solved`: results of the functions of that name of
    /// Stepper.
    Traffic a_step(int sweeps, Cut const&, int parts, SweepsAStep const& solved) const;

  private:
    /// Messages of a step in absolute coordinates.
    Traffic absolute(int sweeps, int parts, Cut const&) const;
    /// Messages of a step in joint coordinates. `corrections`: those of jointed tips.
    Traffic joint(int corrections, Cut const&, SweepsAStep const&) const;

    Integrator integrator_;
    SweepsAStep sweeps_;
    std::int64_t directions_;  // directions per handle
    bool articulated_, absolute_, beads_, implicit_, linked_, joint_loads_, springs_,
        moving_meeting_, tips_, fixman_, at_once_;
    std::int64_t refinements_;
};

}  // namespace catena
