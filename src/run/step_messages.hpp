// What a step costs in messages, told from the partition alone: the sizes that the communicator
// then counts. OpenMM's are not among them.
#pragma once

#include "chain/chain_group.hpp"
#include "integrate/joint_integrators.hpp"

namespace catena {

/// What the ranks' ends cut of a group of chains, as one rank sees it.
struct Cut {
    std::int64_t shared_units = 0;           // of chains that several ranks share
    bool inboard = false, outboard = false;  // a chain goes on there on another rank
    std::int64_t ring_ends = 0;              // rings that have their other end on another rank
    GatherWay way;
};
Cut cut_of(ChainGroup const&, GatherWay const&);

class StepMessages {
  public:
    StepMessages(ChainGroup const&, Scene const&);
    /// As far as the scene tells.
    Traffic a_step(int sweeps, Cut const& cut) const { return a_step(sweeps, cut, 1, sweeps_); }
    /// `sweeps`, `parts`, `solved`: Stepper's.
    Traffic a_step(int sweeps, Cut const&, int parts, SweepsAStep const& solved) const;

  private:
    Traffic absolute(int sweeps, int parts, Cut const&) const;
    Traffic joint(int corrections, Cut const&, SweepsAStep const&) const;

    Integrator integrator_;
    SweepsAStep sweeps_;
    std::int64_t directions_;
    bool articulated_, absolute_, beads_, implicit_, linked_, joint_loads_, springs_,
        moving_meeting_, tips_, fixman_, at_once_;
    std::int64_t refinements_;
};

}  // namespace catena
