// Fixman potential of chains of point beads on links, U_F = 1/2 kT log det T (src/dca/README.md,
// "Statistics of constrained chains"). With it, rigid links sample the ensemble of stiff springs in
// their place.
#pragma once

#include <vector>

#include "dynamics/bead_term.hpp"
#include "joints/joint_models.hpp"
#include "kinematics/link_geometry.hpp"

namespace catena {

/// Force and energy of the potential of one group of chains.
class FixmanPotential : public BeadTerm {
  public:
    /// Energy by bead from the last add_forces(), kJ/mol; only the sum has a meaning.
    virtual std::vector<double> energy() const = 0;
    void set_energy(PotentialEnergy& to) const final {
        to[terms::place_of_energy<terms::FixmanTerm>()] = energy();
    }
};

/// Computes both for unbranched chains from entries of T^-1 (ChainSolver::invert()).
class LinkFixman final : public FixmanPotential {
  public:
    /// `solver` is the solver of the group's links, on the host. All arguments must outlive this
    /// object.
    LinkFixman(ChainGroup const&, Scene const&, Executor const&, Communicator const&,
               ChainSolver& solver);
    void add_forces(ConfigurationView const&, View<3> force) override;
    /// The energy of a link is that of the bead on its outboard side; that of a tip's link is added
    /// to the last bead.
    std::vector<double> energy() const override;

  private:
    bool has_link(std::int64_t k) const {
        return is_rod(group_.joints.type[static_cast<std::size_t>(k)]);
    }
    /// Direction of the outboard link of bead k; zero if it has none.
    Vec3 outboard(ConfigurationView const&, std::int64_t k) const;

    ChainGroup const& group_;
    Executor const& executor_;
    Communicator const& communicator_;
    ChainSolver& solver_;
    double kt_;
    std::vector<HeldTip> tips_;
    /// Entries of T^-1 and its pivots, as InverseView.
    Field<1> pivot_, tip_pivot_, beside_;
    /// Weighted link directions, and the forces that rotate each link.
    Field<3> pull_, across_;
};

}  // namespace catena
