// Energies of all beads where ranks compute the forces on theirs. For files that see OpenMM's
// headers.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "force/context.hpp"
#include "force/rank_forces.hpp"

namespace catena {

class WholeEnergies {
  public:
    /// Keeps what `plan` refers to.
    explicit WholeEnergies(RankPlan const& plan);
    /// RankForces::find_energies at these positions of own beads, from a Context of all beads on
    /// rank 0; `home` as in ForceContext.
    void find(std::span<Vec3 const> own, ForceContext* home, std::span<double> of_group);

  private:
    OpenMmModel const& model_;
    OpenMmPlatform const& platform_;
    Communicator const& communicator_;
    std::optional<Vec3> box_;
    std::vector<std::int64_t> particle_, bytes_of_rank_;  // of beads, one rank's after the other's
    std::unique_ptr<ForceContext> context_;
};

}  // namespace catena
