// Fixman potential of branched chains of point beads (src/dca/README.md, "Branched chains").
#pragma once

#include <vector>

#include "dynamics/fixman.hpp"

namespace catena {

/// Computes force and energy in a sweep from the ends of each chain to its first bead and one back.
/// The work of a chain is sequential.
class BranchedFixman final : public FixmanPotential {
  public:
    /// The arguments must outlive this object.
    BranchedFixman(ChainGroup const&, Scene const&, Executor const&);
    void add_forces(ConfigurationView const&, View<3> force) override;
    std::vector<double> energy() const override { return energy_; }

  private:
    bool has_link(std::int64_t k) const {
        return is_rod(group_.joints.type[static_cast<std::size_t>(k)]);
    }
    /// Computes what the outboard side of each link holds, and the energy.
    void sweep_inwards(dca::Piece const&, ConstView<3> direction);
    /// Computes how the inboard side of each link yields, and adds the forces.
    void sweep_outwards(dca::Piece const&, ConstView<3> direction, View<3> force);
    /// Adds the force of link k on its beads; `yield` is the acceleration of its inboard end under
    /// a unit force along the link, without the link.
    void add_force(std::int64_t k, Vec3 const& yield, ConstView<3> direction, View<3> force);

    ChainGroup const& group_;
    Executor const& executor_;
    double kt_;
    /// Beads outboard of bead k: entries [first_child_[k], first_child_[k + 1]) of child_.
    std::vector<std::int64_t> first_child_, child_;
    /// Inertia of each bead and of what its outboard links hold.
    std::vector<Sym3> inertia_;
    /// Acceleration of the outboard end of each link under a unit force along it, without the link.
    std::vector<Vec3> held_;
    /// Components along the link of held_ and of the inboard end's acceleration.
    std::vector<double> beyond_, before_, energy_;
};

}  // namespace catena
