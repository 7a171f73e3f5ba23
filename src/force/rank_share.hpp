// A rank's share of a System that is split: its own beads, and what acts on them from elsewhere.
// For files that see OpenMM's headers.
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

class SplitShare {
  public:
    /// `skin_of_reach`: the ghosts' lists are wider by this part of the forces' reach.
    SplitShare(RankPlan const& plan, double skin_of_reach);

    std::vector<std::int64_t> const& own() const { return own_; }
    /// Beads of other ranks that share a bonded term with own ones, ascending.
    std::vector<std::int64_t> const& partners() const { return partners_; }
    /// `pieces`: in which others are ghosts.
    GhostLists::Plan lists(std::vector<std::uint8_t> pieces = {}) const;
    OpenMM::System const& system() const { return *model_.system; }
    double reach() const {
        return ends_ ? longest_reach(ranges_) : std::numeric_limits<double>::infinity();
    }
    std::vector<PairRange> const& ranges() const { return ranges_; }
    double skin() const { return skin_; }
    /// Whether particles can be exchanged for others.
    bool exchanges() const { return exchanges_; }

    std::vector<int> particles_of(std::span<std::int64_t const> beads) const;
    /// Own beads, partners, and others, which are exchangeable where particles are.
    Subset subset_of(std::span<std::int64_t const> ghosts) const;
    /// The Context of a subset; `home` as in ForceContext.
    std::unique_ptr<ForceContext> context_of(std::shared_ptr<OpenMM::System const> system,
                                             ForceContext* home = nullptr) const {
        return std::make_unique<ForceContext>(std::move(system), platform_, box_, home);
    }
    /// RankForces::find_energies with these positions.
    void find_energies(std::span<Vec3 const> own, ForceContext* home, std::span<double> of_group) {
        energies_.find(own, home, of_group);
    }
    /// Of own beads in the scene, for messages.
    std::vector<std::int64_t> const& own_numbers() const { return own_numbers_; }
    std::optional<Vec3> const& box() const { return box_; }

  private:
    OpenMmModel const& model_;
    OpenMmPlatform const& platform_;
    BeadSystem const& beads_;
    std::optional<Vec3> box_;
    std::vector<std::int64_t> own_, own_numbers_;
    std::vector<int> particle_of_bead_;
    bool ends_;  // every force has a cutoff
    std::vector<PairRange> ranges_;
    double skin_;
    bool exchanges_;
    std::vector<std::int64_t> partners_;
    WholeEnergies energies_;
};

}  // namespace catena
