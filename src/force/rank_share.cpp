// One rank's share of a split System.
#include "force/rank_share.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "systems/force_ranges.hpp"

namespace catena {

namespace {

/// Returns all of 0 .. count - 1 except `beads`, ascending.
std::vector<std::int64_t> all_but(std::vector<std::int64_t> beads, std::int64_t count) {
    std::sort(beads.begin(), beads.end());
    std::vector<std::int64_t> all(static_cast<std::size_t>(count)), rest;
    std::iota(all.begin(), all.end(), std::int64_t{0});
    std::set_difference(all.begin(), all.end(), beads.begin(), beads.end(),
                        std::back_inserter(rest));
    return rest;
}

}  // namespace

DomainShare::DomainShare(RankPlan const& plan, double skin_of_reach)
    : model_(plan.model),
      platform_(plan.platform),
      beads_(plan.beads),
      box_(plan.box),
      own_(plan.beads.beads_of(plan.communicator.rank())),
      particle_of_bead_(particles_of_beads(plan.model.bead_of_particle)),
      ends_(std::isfinite(reach_of(*plan.model.system))),
      ranges_(ends_ ? pair_ranges(*plan.model.system, plan.model.bead_of_particle)
                    : std::vector<PairRange>{}),
      skin_(skin_of_reach * std::max(longest_reach(ranges_), plan.longest_reach)),
      exchanges_(can_exchange_particles(*plan.model.system)),
      energies_(plan) {
    for (std::int64_t const bead : own_) own_numbers_.push_back(beads_.name(bead));
    if (own_.empty()) return;
    if (!ends_) {
        partners_ = all_but(own_, beads_.size());
        return;
    }
    for (int const p : bonded_partners(*model_.system, particles_of(own_)))
        partners_.push_back(model_.bead_of_particle[p]);
    std::sort(partners_.begin(), partners_.end());
}

GhostLists::Plan DomainShare::lists(std::vector<std::uint8_t> pieces) const {
    return {beads_.first_of_rank, beads_.by_rank,    partners_,    ranges_, skin_, box_,
            beads_.threads,       std::move(pieces), beads_.number};
}

std::vector<int> DomainShare::particles_of(std::span<std::int64_t const> beads) const {
    std::vector<int> particles;
    for (std::int64_t const bead : beads) particles.push_back(particle_of_bead_[bead]);
    return particles;
}

Subset DomainShare::subset_of(std::span<std::int64_t const> ghosts) const {
    Subset subset{particles_of(own_), static_cast<int>(own_.size()), 0};
    auto const particles = particles_of(ghosts);
    subset.particles.insert(subset.particles.end(), particles.begin(), particles.end());
    subset.fixed = exchanges_ ? static_cast<int>(own_.size() + partners_.size())
                              : static_cast<int>(subset.particles.size());
    return subset;
}

}  // namespace catena
