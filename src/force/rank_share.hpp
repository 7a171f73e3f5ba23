// DomainShare: one rank's share of a split System, that is its own beads and all that acts on them.
// Only files that see OpenMM's headers include this one.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "force/context.hpp"
#include "force/energies.hpp"
#include "force/rank_forces.hpp"
#include "neighbours/ghost_lists.hpp"
#include "neighbours/pair_ranges.hpp"
#include "systems/subset.hpp"

namespace catena {

/// The rank's share under domain decomposition, on any path.
class DomainShare {
  public:
    /// `skin_of_reach`: skin of the lists of ghosts as a fraction of the forces' reach.
    DomainShare(RankPlan const& plan, double skin_of_reach);

    /// Own beads in the order of BeadSystem::by_rank.
    std::vector<std::int64_t> const& own() const { return own_; }
    /// Beads of other ranks that share a bonded term with own ones, ascending.
    std::vector<std::int64_t> const& partners() const { return partners_; }
    /// Returns the plan of this rank's lists of ghosts. `pieces`: BeadPieces::length.
    GhostLists::Plan lists(std::vector<std::uint8_t> pieces = {}) const;
    OpenMM::System const& system() const { return *model_.system; }
    /// Longest cutoff of the forces, nm; infinite if a force has none.
    double reach() const {
        return ends_ ? longest_reach(ranges_) : std::numeric_limits<double>::infinity();
    }
    std::vector<PairRange> const& ranges() const { return ranges_; }
    /// Width by which lists of ghosts exceed the reach, nm.
    double skin() const { return skin_; }
    /// True if a Context's particles can get other particles' parameters.
    bool exchanges() const { return exchanges_; }

    /// Returns the System's particles of these beads.
    std::vector<int> particles_of(std::span<std::int64_t const> beads) const;
    /// Returns the particles of own beads, then of `ghosts`, partners first. Those after the
    /// partners are exchangeable if exchanges().
    Subset subset_of(std::span<std::int64_t const> ghosts) const;
    /// Makes the Context of a subset; `home` has the meaning it has in ForceContext.
    std::unique_ptr<ForceContext> context_of(std::shared_ptr<OpenMM::System const> system,
                                             ForceContext* home = nullptr) const {
        return std::make_unique<ForceContext>(std::move(system), platform_, box_, home);
    }
    /// Implements RankForces::find_energies() at these positions of own beads. Collective.
    void find_energies(std::span<Vec3 const> own, ForceContext* home, std::span<double> of_group) {
        energies_.find(own, home, of_group);
    }
    /// Numbers of own beads in the scene, for messages.
    std::vector<std::int64_t> const& own_numbers() const { return own_numbers_; }
    std::optional<Vec3> const& box() const { return box_; }

  private:
    OpenMmModel const& model_;
    OpenMmPlatform const& platform_;
    BeadSystem const& beads_;
    std::optional<Vec3> box_;
    std::vector<std::int64_t> own_, own_numbers_;
    std::vector<int> particle_of_bead_;
    bool ends_;  // true if every force has a cutoff
    std::vector<PairRange> ranges_;
    double skin_;
    bool exchanges_;
    std::vector<std::int64_t> partners_;
    WholeEnergies energies_;
};

}  // namespace catena
