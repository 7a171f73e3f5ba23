// The Fixman potential of chains of point beads on links, U_F = 1/2 kT log det T
// (src/dca/README.md, "Statistics of constrained chains"). Under it rigid links sample what stiff
// springs in their places would.
#pragma once

#include <vector>

#include "dca/solver.hpp"
#include "kinematics/link_geometry.hpp"

namespace catena {

class FixmanPotential {
  public:
    /// `solver`: of the group's links, on the host. All of them must outlive this.
    FixmanPotential(ChainGroup const&, Scene const&, Executor const&, Communicator const&,
                    ChainSolver& solver);
    /// Adds its force on each bead, at the configuration that matrices were assembled for last.
    /// Collective.
    void add_forces(ConfigurationView const&, View<3> force);
    /// Of the links on the inboard side of each bead (the tip's link belongs to the last bead), as
    /// add_forces() found it last.
    std::vector<double> energy() const;

  private:
    bool has_link(std::int64_t k) const {
        return group_.joint[static_cast<std::size_t>(k)] == JointType::link;
    }
    Vec3 outboard(ConfigurationView const&, std::int64_t k) const;

    ChainGroup const& group_;
    Executor const& executor_;
    Communicator const& communicator_;
    ChainSolver& solver_;
    double kt_;
    std::vector<HeldTip> tips_;
    Field<1> pivot_, tip_pivot_, beside_;
    Field<3> pull_, turn_;
};

}  // namespace catena
