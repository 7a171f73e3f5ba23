// Energies of all beads if each rank computes the forces on its own beads only. Only files that see
// OpenMM's headers include this one.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "force/context.hpp"
#include "force/rank_forces.hpp"

namespace catena {

/// Computes energies in a Context of all beads, which rank 0 makes at the first call.
class WholeEnergies {
  public:
    /// Keeps references to what `plan` refers to.
    explicit WholeEnergies(RankPlan const& plan);
    /// Implements RankForces::find_energies() at the positions `own` of this rank's beads, nm, W.
    /// `home` has the meaning it has in ForceContext. Collective.
    void find(std::span<Vec3 const> own, ForceContext* home, std::span<double> of_group);

  private:
    OpenMmModel const& model_;
    OpenMmPlatform const& platform_;
    Communicator const& communicator_;
    std::optional<Vec3> box_;
    /// Particle of each bead, rank after rank, and bytes of each rank's positions.
    std::vector<std::int64_t> particle_, bytes_of_rank_;
    std::unique_ptr<ForceContext> context_;
};

}  // namespace catena
